use std::path::PathBuf;

use clap::{Args, ValueHint};
use cosmorama_convert::{Conversion, Name};
use cosmorama_spec::Missing;

use super::world::WorldArgs;
use crate::args::with_examples;
use crate::parse::file;

/// Commands that the help of `light sun` shows.
pub(super) const SUN_EXAMPLES: [&str; 4] = [
    "cosmorama light sun sky.hdr",
    "cosmorama light sun sky.hdr --remove sky-without-sun.exr --json",
    "cosmorama light sun 'faces/{face}.exr' --json",
    "cosmorama light sun 'sky.####.exr' --remove 'left.####.exr'",
];

/// Find the suns and lamps of a world: direction, size, colour and light.
///
/// A sun is all connected texels over 16 times as bright as the mean, if one of them is over 100 times as bright. Its irradiance is what
/// falls on a surface that faces it, above the light behind it.
#[derive(Clone, Debug, Args)]
#[command(help_template = with_examples(&SUN_EXAMPLES))]
pub(crate) struct SunArgs {
    /// An image or a pattern, as convert takes it; - is standard input
    #[arg(value_hint = ValueHint::FilePath, value_parser = file::name())]
    pub(crate) input: Name,
    /// Write the picture without its suns: the light around them goes on behind; #### stands for the number of a frame
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = "Light")]
    pub(crate) remove: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) world: WorldArgs,
}

impl From<SunArgs> for Conversion {
    fn from(args: SunArgs) -> Self {
        // A part of a sky may have a sun, too.
        args.world.conversion(args.input, Missing::Fill(cosmorama::raster::Rgba::TRANSPARENT))
    }
}
