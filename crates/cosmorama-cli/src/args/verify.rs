use std::path::PathBuf;

use clap::{Args, ValueHint};
use cosmorama_convert::Name;
use cosmorama_spec::Size;

use super::convert::{FramesAsked, LimitArgs};
use super::{ProgressStyle, with_examples};
use crate::parse::file;
use crate::parse::number::every;

/// Example commands in its help.
pub(super) const EXAMPLES: [&str; 5] = [
    "cosmorama verify 'dome_####.png'",
    "cosmorama verify 'dome_####.png' --frames 1-50000 --size 4096 --json",
    "cosmorama verify 'dome_####.exr' --sheet sheet.png --every 100",
    "cosmorama verify film.mp4",
    "cosmorama verify film.mp4 --frames 00:01:00-00:01:10",
];

/// Find frames of a sequence or a video that are missing, damaged, unlike the others, black or frozen.
///
/// Every frame is read to its end. Told are frames without a file, files that are no whole picture, pictures of another size, of other
/// channels or another depth, those made by other settings, black ones, those that equal the frame before, and flashes: single frames far from both neighbours.
/// With a fault the exit code is 1, and the last line lists all frames to make again. The frames of each face, eye or level are a
/// sequence by themselves.
#[derive(Debug, Args)]
#[command(help_template = with_examples(&EXAMPLES))]
pub(crate) struct VerifyArgs {
    /// Names of the frames, with ####, @@@@ or %04d where their numbers stand, or a video
    #[arg(value_hint = ValueHint::FilePath, value_parser = file::name())]
    pub(crate) pattern: Name,
    /// Frames that there should be: 1-10 or 1-3,5,7-20:2, of a video 00:01:00-00:01:10, too [default: first to last]
    #[arg(long, value_name = "LIST", value_parser = FramesAsked::parse, allow_hyphen_values = true)]
    pub(crate) frames: Option<FramesAsked>,
    /// Size that they should have [default: that of most]
    #[arg(long, value_name = "WxH|N", allow_hyphen_values = true)]
    pub(crate) size: Option<Size>,
    /// Write a contact sheet: small pictures, row by row
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) sheet: Option<PathBuf>,
    /// Show every Nth frame on the sheet
    #[arg(long, value_name = "N", default_value = "1", value_parser = every, requires = "sheet", allow_negative_numbers = true)]
    pub(crate) every: usize,
    /// Replace an existing sheet
    #[arg(short = 'y', long, requires = "sheet")]
    pub(crate) overwrite: bool,
    /// Fail where the folder of the sheet does not exist
    #[arg(long, requires = "sheet")]
    pub(crate) no_mkdir: bool,
    #[command(flatten)]
    pub(crate) limits: LimitArgs,
    /// How to tell what is going on, on standard error
    #[arg(long, value_enum, value_name = "STYLE", default_value_t = ProgressStyle::Auto, help_heading = "Run")]
    pub(crate) progress: ProgressStyle,
    /// Print the same as JSON
    #[arg(long, help_heading = "Run")]
    pub(crate) json: bool,
}
