use std::io::Write;
use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context, Result};
use cosmorama::camera::{CameraModel, EquirectCamera};
use cosmorama::lighting::{ColourTable, LightFigures};
use cosmorama::raster::{Channels, Depth, EncodedImage, Image, Rgba, Transfer};
use cosmorama::sphere::Direction;
use cosmorama_builtin::picture;
use cosmorama_convert::{Conversion, WorldLight, WorldTable, check_apart, threads};
use cosmorama_io::pending::Pending;
use cosmorama_io::{Format, Metadata, WriteOptions, write};
use cosmorama_spec::{DepthName, colour_table_csv, colour_table_of_csv, colour_table_of_stops};
use serde_json::json;

use super::add_figures;
use crate::args::TableArgs;
use crate::console::Console;
use crate::failure::usage;
use crate::pipe::KeptStreams;
use crate::verbs::{check_depth, prepare_output};

/// Colours of a table and columns of a panorama, unless given.
const COLOURS: usize = 64;
const COLUMNS: usize = 512;

/// Bytes of a table in CSV at most.
const LARGEST_CSV: u64 = 1 << 21;

/// Makes a table of colours of a world, or a world of a table.
pub(super) fn run(mut args: TableArgs, console: &mut Console) -> Result<ExitCode> {
    let form = Form::of(&args)?;
    let mut kept = KeptStreams::default();
    let source = match own_table(&args)? {
        Some(table) => Source::Table(table),
        None => {
            args.input = kept.input(&args.input)?;
            let conversion: Conversion = args.clone().into();
            let checked = conversion.files(kept.files()).check_light();
            console.tell_all(&checked);
            let light = checked.result?;
            check_apart(&args.output, light.files())?;
            Source::World(Box::new(light))
        }
    };
    let _folders = prepare_output(&args.output, args.world.file, console)?;
    let is_world = matches!(source, Source::World(_));
    let (table, light) = source.table(&args, console)?;
    let overflowed = match form {
        Form::Csv => {
            let mut file = Pending::create(&args.output, &console.unfinished)?;
            let written = file.writer().write_all(colour_table_csv(&table).as_bytes());
            written.with_context(|| format!("cannot write {}", args.output.display()))?;
            file.finish()?;
            0
        }
        Form::Picture(format) => {
            let pool = threads(args.world.limits.threads)?;
            let image = if is_world { strip(&table) } else { pool.install(|| panorama(&table, args.size))? };
            write_picture(&args, format, &image, console)?
        }
    };
    if args.world.json {
        console.print(&report(&args, (&table, light), overflowed)?)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Source of a table.
enum Source {
    Table(ColourTable),
    World(Box<WorldLight>),
}

impl Source {
    /// Returns the table and, of a world, figures of its light.
    fn table(self, args: &TableArgs, console: &Console) -> Result<(ColourTable, Option<LightFigures>)> {
        match self {
            Self::Table(table) => Ok((table, None)),
            Self::World(light) => {
                let axes = (args.by.into(), args.frame());
                let (WorldTable { table, light }, diagnostics) =
                    light.colour_table(axes, args.size.unwrap_or(COLOURS))?;
                diagnostics.iter().for_each(|diagnostic| console.warn(diagnostic));
                Ok((table, Some(light)))
            }
        }
    }
}

/// Reads the table that the input is, if it is one.
fn own_table(args: &TableArgs) -> Result<Option<ColourTable>> {
    if let Some(stops) = args.input.strip_prefix("stops:") {
        let table = colour_table_of_stops(stops, (args.by.into(), args.frame()));
        return table.map(Some).map_err(|error| usage(format!("stops: {error}")));
    }
    let path = Path::new(&args.input);
    if path.extension().is_none_or(|extension| !extension.eq_ignore_ascii_case("csv")) {
        return Ok(None);
    }
    let size = std::fs::metadata(path).with_context(|| format!("{} cannot be read", args.input))?.len();
    if size > LARGEST_CSV {
        return Err(anyhow::anyhow!("{}: {size} bytes, but a table of colours has {LARGEST_CSV} at most", args.input));
    }
    let text = std::fs::read_to_string(path).with_context(|| format!("{} cannot be read", args.input))?;
    check_apart(&args.output, &[cosmorama_convert::real_path(path)].into())?;
    let table = colour_table_of_csv(&text, args.frame());
    table.map(Some).map_err(|error| anyhow::anyhow!("{}: {error}", args.input))
}

/// Form of the output.
enum Form {
    Csv,
    Picture(Format),
}

impl Form {
    fn of(args: &TableArgs) -> Result<Self> {
        let path = &args.output;
        let extension = path.extension().unwrap_or_default().to_string_lossy().into_owned();
        if extension.eq_ignore_ascii_case("csv") {
            return match args.depth {
                Some(_) => Err(usage("--depth is for pictures; a table in CSV has numbers")),
                None => Ok(Self::Csv),
            };
        }
        let format = Format::of_extension(&extension).filter(|format| !format.is_cube_map());
        let Some(format) = format else {
            return Err(usage(format!(
                "{}: a table is written as CSV or as a picture; name it .csv, .exr, .hdr, .png or .tif",
                path.display()
            )));
        };
        if let Some(DepthName(depth)) = args.depth {
            check_depth(path, format, depth, format.depths())?;
        }
        Ok(Self::Picture(format))
    }
}

/// Returns a picture of one row: the least angle on the left.
fn strip(table: &ColourTable) -> Image<Rgba> {
    let stops = table.stops();
    Image::from_fn(stops.len(), 1, |i, _| pixel(stops[i].1))
}

/// Returns a panorama in which each direction has the colour of the table.
fn panorama(table: &ColourTable, columns: Option<usize>) -> Result<Image<Rgba>> {
    let columns = columns.unwrap_or(COLUMNS);
    let view = CameraModel::from(EquirectCamera::default()).view(columns, columns.div_ceil(2))?;
    Ok(picture(&|direction: Direction| table.at(direction).map(|light| light as f32), &view))
}

fn pixel([red, green, blue]: [f64; 3]) -> Rgba {
    Rgba::opaque(red as f32, green as f32, blue as f32)
}

/// Writes a picture. Returns how many samples its type cannot hold.
fn write_picture(args: &TableArgs, format: Format, image: &Image<Rgba>, console: &Console) -> Result<usize> {
    let deepest = format.depths().last().copied().unwrap_or(Depth::Eight);
    let depth = args.depth.map_or(deepest, Depth::from);
    let transfer = if depth.is_float() { Transfer::Linear } else { Transfer::Srgb };
    let encoded = EncodedImage::encode(image, Channels::Rgb, depth, &transfer);
    let metadata = Metadata { transfer: Some(transfer), ..Metadata::default() };
    let options = WriteOptions { unfinished: console.unfinished.clone(), ..WriteOptions::with_metadata(metadata) };
    write(&args.output, &encoded, &options)?;
    let most = depth.most();
    let overflowed = image.pixels().iter().flat_map(|pixel| &pixel.0[..3]).filter(|light| **light > most).count();
    if overflowed > 0 {
        console.warning(format_args!(
            "{}: {overflowed} samples are brighter than --depth {} holds; OpenEXR in floats holds them",
            args.output.display(),
            DepthName(depth)
        ));
    }
    Ok(overflowed)
}

/// Returns the report for programs.
fn report(args: &TableArgs, (table, light): (&ColourTable, Option<LightFigures>), overflowed: usize) -> Result<String> {
    let peak = table.stops().iter().flat_map(|(_, colour)| colour).copied().fold(0.0, f64::max);
    let mut json = json!({
        "output": args.output.display().to_string(),
        "colours": table.stops().len(),
        "energy_out": table.mean(),
        "peak_out": peak,
        "overflowed_samples": overflowed,
    });
    if let Some(light) = light {
        add_figures(&mut json, light);
    }
    Ok(serde_json::to_string_pretty(&json)? + "\n")
}
