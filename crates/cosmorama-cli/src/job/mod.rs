//! Jobs: arguments resolved, everything checked before work starts.

mod builtin;
mod calibration;
mod canvas;
mod coverage;
mod detect;
mod evidence;
mod eye;
mod face_file;
mod face_shape;
mod face_view;
mod files;
mod folder;
mod frames;
mod given_faces;
mod gpano;
mod guess;
mod halves;
mod in_flight;
mod input;
mod light;
mod listing;
mod machine;
mod mask;
mod memory;
mod mirror_image;
mod nominal;
mod other_end;
mod outputs;
mod oval;
mod packed;
mod picture;
mod piece;
mod pto;
mod remade;
mod size;
mod st_map;
mod st_pixels;
mod stretched;
mod target;
mod thin_alpha;
mod world_file;

pub(crate) use builtin::{Builtin, BuiltinJob};
pub(crate) use coverage::{Coverage, nominal_worlds};
pub(crate) use detect::{Likely, likely};
pub(crate) use evidence::{damage_of, light_of};
pub(crate) use face_view::face_placement;
pub(crate) use files::Files;
pub(crate) use folder::is_one_file;
pub(crate) use frames::existing as existing_frames;
pub(crate) use given_faces::{Continuity, FacePixels, GivenFaces};
pub(crate) use in_flight::InFlight;
pub(crate) use input::{Input, InputView};
pub(crate) use light::{InputTransfer, Light};
pub(crate) use listing::{Listed, listed};
pub(crate) use machine::peak_bytes;
pub(crate) use memory::MemoryBudget;
pub(crate) use outputs::{FrameOutputs, Outputs, check_apart, files_read, real_path, refuse_existing};
pub(crate) use picture::{Picture, Place};
pub(crate) use remade::Remade;
pub(crate) use st_map::settled;
pub(crate) use st_pixels::st_pixels;
pub(crate) use target::{Sheet, Target, TargetView};
pub(crate) use thin_alpha::ThinAlpha;

use anyhow::Result;
use cosmorama::filter::Filter;
use cosmorama::raster::{Channels, Depth, Rgba};
use cosmorama::render::Resampler;
use cosmorama::world::World;
use cosmorama_io::{Compression, Format, WriteOptions};
use cosmorama_spec::{CompressionLevel, Missing};

use crate::args::ConvertArgs;
use crate::args::convert::GeometryArgs;
use crate::failure::{usage, warn};

/// A conversion, ready to run.
pub(crate) struct ConvertJob {
    /// Where light comes from.
    pub(crate) input: Input,
    /// Its geometry: one world, or one for each eye.
    pub(crate) worlds: Vec<World>,
    /// Where it goes.
    pub(crate) target: Target,
    /// How.
    pub(crate) filter: Filter,
    /// How code values relate to light on both sides, and what the outputs hold.
    pub(crate) light: Light,
    /// The outputs to be made, frame by frame.
    pub(crate) outputs: Outputs,
    /// What no view covers, where that is to be filled.
    pub(crate) coverage: Coverage,
    /// What becomes of directions without light.
    missing: Missing,
    /// What may be used.
    pub(crate) memory: MemoryBudget,
    /// What should be known.
    pub(crate) warnings: Vec<String>,
}

impl ConvertJob {
    /// Resolves arguments and checks everything that can be checked without decoding a pixel.
    pub(crate) fn resolve(args: &ConvertArgs) -> Result<Self> {
        let mut warnings = Vec::new();
        let job = Self::noting(args, &mut warnings);
        // A job that cannot be done may have been guessed wrongly.
        job.as_ref().map_or(&warnings, |job| &job.warnings).iter().for_each(|warning| warn(warning));
        job
    }

    fn noting(args: &ConvertArgs, warnings: &mut Vec<String>) -> Result<Self> {
        let memory = MemoryBudget::new(args.limits.memory);
        let geometry = &settled(&args.geometry, Some(&args.input), memory, warnings)?;
        // Mistakes in the command itself come first: they do not depend on any file.
        let format = Target::check_names(&args.output, geometry)?;
        check_file_options(args, format)?;
        let mut input = Input::find(&args.input, geometry.from.as_ref(), args.frames.as_ref(), memory, warnings)?;
        let mut target = Target::resolve(&args.output, geometry, Some(input.pixels_per_radian()))?;
        if args.mips {
            target = target.with_mips(&args.output, geometry)?;
        }
        warnings.extend(input.turned());
        warnings.extend(input.complaints());
        warnings.extend(told_of_shape(geometry, &target));
        input.fit_eyes(target.is_stereo(), warnings);
        let filter = filter(geometry, warnings);
        let mut light = Light::resolve(args, &input, &target, warnings)?;
        if args.st_map {
            // Numbers, not light.
            light.depth = args.depth.map_or(Depth::Float, Depth::from);
            light.channels = Channels::Rgb;
        }
        memory.check_outputs(&target)?;
        let outputs = Outputs::plan(args, &input, &target, &light, memory)?;
        warnings.extend(outputs.warning());
        let nominal = nominal_worlds(&input, memory)?;
        let (coverage, worlds) = Coverage::check(&mut input, nominal, &target, &filter, args.missing, warnings)?;
        memory.check_frame(&input, &target)?;
        let levels = target.views.iter().map(|view| {
            let world = &worlds[view.world(worlds.len())];
            Resampler { world, target: &view.view, filter }.level_bytes() as u64
        });
        let levels = levels.max().unwrap_or(0);
        let memory = memory.beside_levels(levels, &input, &target)?;
        let (missing, warnings) = (args.missing, std::mem::take(warnings));
        Ok(Self { input, worlds, target, filter, light, outputs, coverage, missing, memory, warnings })
    }

    /// The conversion to one of the target's views.
    pub(crate) fn resampler<'a>(&'a self, target: &'a TargetView) -> Resampler<'a> {
        Resampler { world: self.world(target), target: &target.view, filter: self.filter }
    }

    /// What a target shows.
    pub(crate) fn world(&self, target: &TargetView) -> &World {
        &self.worlds[target.world(self.worlds.len())]
    }

    /// What pixels without light get; `None` where they are an error.
    pub(crate) fn fill_for_missing(&self) -> Option<Rgba> {
        match self.missing {
            Missing::Error => None,
            Missing::Fill(colour) => Some(colour),
        }
    }
}

/// What has no effect is a mistake: another format was meant, or another option.
fn check_file_options(args: &ConvertArgs, format: Format) -> Result<()> {
    if args.quality.is_some() && format != Format::Jpeg {
        let output = &args.output;
        return Err(usage(format!(
            "--quality is for JPEG, but {output} is {format}; leave it out, or name the output .jpg"
        )));
    }
    if args.compression.is_some() && (!format.has_compression() || args.st_map) {
        let what = if args.st_map { "an st map".to_owned() } else { format.to_string() };
        return Err(usage(format!(
            "--compression is for pictures in PNG, TIFF and OpenEXR, but {} is {what}; leave it out{}",
            args.output,
            if format == Format::Jpeg { ", or choose a --quality" } else { "" }
        )));
    }
    if args.transfer.fixed().is_some() && args.in_transfer.is_some() && args.out_transfer.is_some() {
        return Err(usage(
            "--transfer has no effect beside --in-transfer and --out-transfer; leave it or one of them out",
        ));
    }
    Ok(())
}

/// How outputs are written. Frames come by the thousand, and are read again: as PNG they are written for speed, unless
/// something else is asked for.
pub(crate) fn write_options(args: &ConvertArgs, format: Format, outputs: &Outputs, light: &Light) -> WriteOptions {
    let default = WriteOptions::default();
    let usual = if format == Format::Png && outputs.is_sequence() { Compression::Fast } else { default.compression };
    WriteOptions {
        quality: args.quality.unwrap_or(default.quality),
        compression: args.compression.map_or(usual, compression),
        metadata: light.metadata.clone(),
    }
}

fn compression(level: CompressionLevel) -> Compression {
    match level {
        CompressionLevel::None => Compression::None,
        CompressionLevel::Fast => Compression::Fast,
        CompressionLevel::Balanced => Compression::Balanced,
        CompressionLevel::High => Compression::High,
    }
}

/// What should be known of an output's shape.
fn told_of_shape(geometry: &GeometryArgs, target: &Target) -> Option<String> {
    stretched::warning(geometry, target).or_else(|| gpano::warning(geometry, target))
}

/// The filter that was asked for.
pub(crate) fn filter(geometry: &GeometryArgs, warnings: &mut Vec<String>) -> Filter {
    use cosmorama::filter::{FilterKind, Kernel};
    let (kind, kernel) = (geometry.filter.0, geometry.kernel.kernel);
    let is_weighed = !matches!(kind, FilterKind::Point | FilterKind::Bilinear);
    if !is_weighed && (kernel != Kernel::ADAPTIVE || geometry.anti_ringing.is_some()) {
        warnings.push("--kernel and --anti-ringing have no effect on --filter point and bilinear".to_owned());
    }
    Filter { kind, kernel, anti_ringing: geometry.anti_ringing.unwrap_or(geometry.kernel.anti_ringing) }
}
