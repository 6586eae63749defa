use std::path::PathBuf;

use clap::{ArgGroup, Args, ValueHint};
use cosmorama_convert::Name;
use cosmorama_io::FrameList;
use cosmorama_spec::Size;

use super::convert::{CameraArgs, GeometryArgs, LimitArgs, ShutterArgs, frame_list};
use super::{SEE_MORE, projections, with_examples};
use crate::parse::file;
use crate::parse::number::{not_negative, positive};

/// Example commands in its help.
pub(super) const EXAMPLES: [&str; 4] = [
    "cosmorama explain 'faces/{face}.png' --to omnimax --output diagrams",
    "cosmorama explain --from cube --to omnimax --size 1966x1436",
    "cosmorama explain --from cube --input-size 1024x960 --to omnimax --size 4k",
    "cosmorama explain --template sky --to cube:half=up",
];

/// Tell what a conversion will do before it does it, in text and diagrams.
#[derive(Clone, Debug, Args)]
#[command(help_template = with_examples(&EXAMPLES))]
#[command(after_help = SEE_MORE, after_long_help = projections())]
#[command(group(ArgGroup::new("folders").args(["output", "template"]).multiple(true)))]
pub(crate) struct ExplainArgs {
    /// The input, if there is one: an image or a pattern; - is standard input
    #[arg(value_hint = ValueHint::FilePath, value_parser = file::name())]
    pub(crate) input: Option<Name>,
    /// Size of an input, or of its faces, that does not exist yet
    ///
    /// Unless given, it is parity with the output at the centre.
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
    #[command(flatten)]
    pub(crate) camera: CameraArgs,
    #[command(flatten)]
    pub(crate) shutter: ShutterArgs,
    /// Which frames of a moving camera or a show: 5, 1-10 or 1-3,5,7-20:2 [default: all]
    #[arg(long, value_name = "LIST", value_parser = frame_list, allow_hyphen_values = true, hide_short_help = true, help_heading = "Geometry")]
    pub(crate) frames: Option<FrameList>,
    /// Tell what goes wrong if the camera leaves the world's place by up to so many metres
    ///
    /// With --nearest: the greatest error in pixels, over all frames, of things that are nearer than the distance that a world
    /// is made for.
    #[arg(long, value_name = "M", value_parser = not_negative, allow_hyphen_values = true, requires = "nearest", hide_short_help = true, help_heading = "Geometry")]
    pub(crate) travel: Option<f64>,
    /// Distance of the nearest thing in the world, for --travel
    #[arg(long, value_name = "M", value_parser = positive, allow_hyphen_values = true, requires = "travel", hide_short_help = true, help_heading = "Geometry")]
    pub(crate) nearest: Option<f64>,
    /// Write layers for painters into this folder: grid, horizon, overlaps and safe areas of each picture of --to
    ///
    /// PNG files with alpha, to be laid over a picture in a paint program. Unless --size is given, faces and other pictures
    /// are 1024 pixels wide.
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub(crate) template: Option<PathBuf>,
    /// Write diagrams (SVG and PNG) into this folder
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub(crate) output: Option<PathBuf>,
    /// Replace existing diagrams and templates
    #[arg(short = 'y', long, requires = "folders")]
    pub(crate) overwrite: bool,
    #[command(flatten)]
    pub(crate) limits: LimitArgs,
    /// Print the figures as JSON
    #[arg(long)]
    pub(crate) json: bool,
}
