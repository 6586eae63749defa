use std::path::Path;
use std::process::ExitCode;

use anyhow::Result;
use cosmorama::lighting::{BrdfChannels, BrdfModel};
use cosmorama::raster::{Channels, Depth, EncodedImage, Image, Rgba, Transfer};
use cosmorama_convert::threads;
use cosmorama_io::{Format, Metadata, WriteOptions, write_flat};
use cosmorama_spec::DepthName;
use serde_json::json;

use crate::args::BrdfArgs;
use crate::console::Console;
use crate::failure::usage;
use crate::verbs::{check_depth, prepare_output};

/// Makes a table of what surfaces reflect of a white world.
pub(super) fn run(args: &BrdfArgs, console: &Console) -> Result<ExitCode> {
    let samples = samples(&args.output, args.depth.map(Depth::from))?;
    let _folders = prepare_output(&args.output, args.file, console)?;
    let (table, cut) = write(args, samples, console)?;
    if args.json {
        console.print(&report(args, &table, cut)?)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Writes the table. Returns it, and how many cells its sample type cannot hold.
fn write(args: &BrdfArgs, (depth, channels): (Depth, Channels), console: &Console) -> Result<(Image<Rgba>, usize)> {
    let path = &args.output;
    let kind = if args.multiscatter { BrdfChannels::Multiscatter } else { BrdfChannels::ScaleBias };
    let pool = threads(args.threads)?;
    let table = pool.install(|| BrdfModel::from(args.lobe).table(args.size, kind));
    let table = table.map_err(|error| usage(format!("--lobe {}, --multiscatter: {error}", args.lobe.name())))?;
    let encoded = pool.install(|| EncodedImage::encode(&table, channels, depth, &Transfer::Linear));
    let metadata = Metadata { transfer: Some(Transfer::Linear), ..Metadata::default() };
    let options = WriteOptions { unfinished: console.unfinished.clone(), ..WriteOptions::with_metadata(metadata) };
    write_flat(path, &encoded, &options)?;
    let cut = overflowed(&table, depth);
    if cut > 0 {
        console.warning(format_args!(
            "{}: {cut} cells are more than 1, the most that --depth {} holds; .exr and .ktx2 hold them",
            path.display(),
            DepthName(depth)
        ));
    }
    Ok((table, cut))
}

/// Writes a table of microfacets, as deploy wants it.
pub(super) fn write_usual(path: &Path, is_multiscatter: bool, threads: Option<usize>, console: &Console) -> Result<()> {
    let args = BrdfArgs::usual(path.to_owned(), is_multiscatter, threads);
    write(&args, samples(path, None)?, console).map(drop)
}

/// Returns the sample type and the channels of a table in a file.
fn samples(path: &Path, depth: Option<Depth>) -> Result<(Depth, Channels)> {
    let format = path.extension().and_then(|extension| Format::of_extension(&extension.to_string_lossy()));
    let (usual, held, channels): (_, &[Depth], _) = match format {
        Some(Format::Exr) => (Depth::Float, &[Depth::Half, Depth::Float], Channels::Rgb),
        Some(Format::Ktx2) => (Depth::Half, &[Depth::Half, Depth::Float], Channels::Rgba),
        Some(Format::Png) => (Depth::Sixteen, &[Depth::Eight, Depth::Sixteen], Channels::Rgb),
        Some(Format::Tiff) => (Depth::Float, &[Depth::Eight, Depth::Sixteen, Depth::Half, Depth::Float], Channels::Rgb),
        _ => {
            return Err(usage(format!(
                "{}: a table is written as OpenEXR, KTX 2, PNG or TIFF; name it .exr, .ktx2, .png or .tif",
                path.display()
            )));
        }
    };
    let depth = depth.unwrap_or(usual);
    check_depth(path, "such a table", depth, held)?;
    Ok((depth, channels))
}

/// Counts the cells that a sample type cannot hold.
fn overflowed(table: &Image<Rgba>, depth: Depth) -> usize {
    let most = |cell: &Rgba| cell.0[0].max(cell.0[1]);
    table.pixels().iter().filter(|cell| most(cell) > depth.most()).count()
}

/// Returns the report for programs.
fn report(args: &BrdfArgs, table: &Image<Rgba>, overflowed: usize) -> Result<String> {
    let largest = table.pixels().iter().flat_map(|cell| [cell.0[0], cell.0[1]]).fold(0.0, f32::max);
    let json = json!({
        "output": args.output.display().to_string(),
        "size": args.size,
        "lobe": args.lobe.name(),
        "multiscatter": args.multiscatter,
        "largest": largest,
        "overflowed_samples": overflowed,
    });
    Ok(serde_json::to_string_pretty(&json)? + "\n")
}
