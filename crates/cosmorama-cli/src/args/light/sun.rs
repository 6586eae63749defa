use std::path::PathBuf;

use clap::builder::NonEmptyStringValueParser;
use clap::{Args, ValueHint};
use cosmorama_convert::{Conversion, GeometrySettings};
use cosmorama_io::FrameList;
use cosmorama_spec::{Missing, Spec, TransferName};

use crate::args::convert::{LimitArgs, frame_list};
use crate::args::parse::listed;
use crate::args::with_examples;

/// Commands that the help of `light sun` shows.
pub(super) const SUN_EXAMPLES: [&str; 3] = [
    "cosmorama light sun sky.hdr",
    "cosmorama light sun sky.hdr --remove sky-without-sun.exr --json",
    "cosmorama light sun 'faces/{face}.exr' --json",
];

/// Find the suns and lamps of a world: direction, size, colour and light.
///
/// A sun is all connected texels over 16 times as bright as the mean, if one of them is over 100 times as bright. Its irradiance is what
/// falls on a surface that faces it, above the light behind it.
#[derive(Clone, Debug, Args)]
#[command(help_template = with_examples(&SUN_EXAMPLES))]
pub(crate) struct SunArgs {
    /// An image or a pattern, as convert takes it; - is standard input
    #[arg(value_hint = ValueHint::FilePath, value_parser = NonEmptyStringValueParser::new())]
    pub(crate) input: String,
    /// Write the picture without its suns: the light around them goes on behind
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = "Light")]
    pub(crate) remove: Option<PathBuf>,
    /// The input's projection [default: found]
    #[arg(long, value_name = "SPEC", value_parser = listed::spec(), hide_possible_values = true, help_heading = "Geometry")]
    pub(crate) from: Option<Spec>,
    /// How integer code values relate to light: auto (default), srgb, linear, …
    #[arg(long, value_name = "T", default_value = "auto", value_parser = listed::transfer(), hide_possible_values = true, hide_default_value = true, help_heading = "Light")]
    pub(crate) transfer: TransferName,
    /// Which frame of several
    #[arg(long, value_name = "N", value_parser = frame_list, allow_hyphen_values = true, help_heading = "Frames and files")]
    pub(crate) frames: Option<FrameList>,
    /// Replace an existing output
    #[arg(short = 'y', long, help_heading = "Frames and files")]
    pub(crate) overwrite: bool,
    /// Fail where the folder of the output does not exist
    #[arg(long, hide_short_help = true, help_heading = "Frames and files")]
    pub(crate) no_mkdir: bool,
    #[command(flatten)]
    pub(crate) limits: LimitArgs,
    /// Print a machine-readable report on standard output
    #[arg(long, help_heading = "Run")]
    pub(crate) json: bool,
}

impl From<SunArgs> for Conversion {
    fn from(args: SunArgs) -> Self {
        Self {
            input: args.input,
            geometry: GeometrySettings { from: args.from, ..GeometrySettings::default() },
            transfer: args.transfer,
            // A part of a sky may have a sun, too.
            missing: Missing::Fill(cosmorama::raster::Rgba::TRANSPARENT),
            frames: args.frames,
            limits: args.limits.into(),
            ..Self::default()
        }
    }
}
