//! Arguments of the verbs that remake what is printed in papers.

mod figures;
mod plates;

use std::path::PathBuf;

use clap::{Args, ValueHint};

pub(super) use figures::EXAMPLES as FIGURES_EXAMPLES;
pub(crate) use figures::FiguresArgs;
pub(super) use plates::EXAMPLES as PLATES_EXAMPLES;
pub(crate) use plates::PlatesArgs;

use super::ProgressStyle;
use super::convert::LimitArgs;

/// Folder of a paper's pictures, with progress and limits.
#[derive(Clone, Debug, Args)]
pub(crate) struct PaperArgs {
    /// Where to write
    #[arg(value_hint = ValueHint::DirPath)]
    pub(crate) dir: PathBuf,
    /// Replace existing files
    #[arg(short = 'y', long)]
    pub(crate) overwrite: bool,
    /// How to tell what is going on, on standard error
    #[arg(long, value_enum, value_name = "STYLE", default_value_t = ProgressStyle::Auto, hide_short_help = true, help_heading = "Run")]
    pub(crate) progress: ProgressStyle,
    #[command(flatten)]
    pub(crate) limits: LimitArgs,
}
