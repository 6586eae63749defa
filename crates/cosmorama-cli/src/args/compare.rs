use std::path::PathBuf;

use clap::{Args, ValueEnum, ValueHint};
use cosmorama_spec::{MemorySize, TransferName};

use super::with_examples;
use crate::parse::listed;
use crate::parse::number::{distance, factor, finite};

/// Example commands in its help.
pub(super) const EXAMPLES: [&str; 3] = [
    "cosmorama compare dome.png reference.png",
    "cosmorama compare dome.png reference.png --region omnimax --diff diff.png",
    "cosmorama compare a.exr b.exr --min-psnr 36 --max-shift 0.01",
];

/// Compare two pictures: PSNR, largest difference, sub-pixel shift.
#[derive(Clone, Debug, Args)]
#[command(help_template = with_examples(&EXAMPLES))]
pub(crate) struct CompareArgs {
    /// A picture; - is standard input
    #[arg(value_hint = ValueHint::FilePath)]
    pub(crate) first: PathBuf,
    /// The picture that it should be like
    #[arg(value_hint = ValueHint::FilePath)]
    pub(crate) second: PathBuf,
    /// Which pixels count
    ///
    /// All pixels, or only those inside the circle of a fisheye (disc) or an Omnimax frame. Pixels that the rim cuts do not count.
    #[arg(long, value_enum, value_name = "REGION", default_value_t = Region::All)]
    pub(crate) region: Region,
    /// Write a picture of the absolute difference
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) diff: Option<PathBuf>,
    /// Replace an existing difference picture
    #[arg(short = 'y', long, requires = "diff")]
    pub(crate) overwrite: bool,
    /// Fail where the folder of the difference picture does not exist
    #[arg(long, requires = "diff")]
    pub(crate) no_mkdir: bool,
    /// How much brighter than life the difference is drawn
    #[arg(long, value_name = "FACTOR", default_value_t = 10.0, value_parser = factor, allow_negative_numbers = true, requires = "diff")]
    pub(crate) gain: f32,
    /// Fail (exit code 1) if the PSNR of linear light is less
    #[arg(long, value_name = "DB", value_parser = finite, allow_negative_numbers = true)]
    pub(crate) min_psnr: Option<f64>,
    /// Fail (exit code 1) if the pictures are further apart
    #[arg(long, value_name = "PX", value_parser = distance, allow_negative_numbers = true)]
    pub(crate) max_shift: Option<f64>,
    /// auto (default), srgb, linear, bt1886, pq, hlg, gamma:G
    ///
    /// How integer code values relate to light.
    #[arg(long, value_name = "T", default_value = "auto", value_parser = listed::transfer(), hide_possible_values = true, hide_default_value = true)]
    pub(crate) transfer: TransferName,
    /// Memory that a picture may take: 500M, 8G or 50% [default: 75% of free]
    #[arg(long, value_name = "SIZE", allow_hyphen_values = true)]
    pub(crate) memory: Option<MemorySize>,
    /// Print the figures as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

/// Pixels that count in a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Region {
    /// Inside the circle that touches the shorter sides.
    Disc,
    /// Inside an Omnimax frame, `framing=fit`.
    Omnimax,
    /// All.
    All,
}
