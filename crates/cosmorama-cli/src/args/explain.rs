use std::path::PathBuf;

use clap::{Args, ValueHint};
use cosmorama_spec::Size;

use super::convert::LimitArgs;
use super::geometry::GeometryArgs;

/// Tell what a conversion will do before it does it, in text and diagrams.
#[derive(Clone, Debug, Args)]
#[command(before_help = "Examples:
  cosmorama explain 'faces/{face}.png' --to omnimax --output diagrams
  cosmorama explain --from cube --to omnimax --size 1966x1436
  cosmorama explain --from cube --input-size 1024x960 --to omnimax --size 1966x1436")]
#[command(after_help = cosmorama_spec::help())]
pub(crate) struct ExplainArgs {
    /// The input, if there is one already: an image or a pattern; - is standard input
    #[arg(value_hint = ValueHint::FilePath)]
    pub(crate) input: Option<String>,
    /// Size of an input (or of its faces) that does not exist yet [default: parity with the output at the centre]
    #[arg(
        long,
        value_name = "WxH|N",
        allow_hyphen_values = true,
        conflicts_with = "input",
        requires = "from",
        help_heading = "Geometry"
    )]
    pub(crate) input_size: Option<Size>,
    #[command(flatten)]
    pub(crate) geometry: GeometryArgs,
    /// Write diagrams (SVG and PNG) into this folder
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub(crate) output: Option<PathBuf>,
    /// Replace existing diagrams
    #[arg(short = 'y', long, requires = "output")]
    pub(crate) overwrite: bool,
    #[command(flatten)]
    pub(crate) limits: LimitArgs,
    /// Print the figures as JSON
    #[arg(long)]
    pub(crate) json: bool,
}
