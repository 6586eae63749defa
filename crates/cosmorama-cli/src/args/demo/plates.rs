use std::path::PathBuf;

use clap::{Args, ValueHint};

use crate::args::convert::LimitArgs;
use crate::args::{ProgressStyle, with_examples};

/// Example commands in its help.
pub(in crate::args) const EXAMPLES: [&str; 2] = ["cosmorama plates plates", "cosmorama plates small -y --size 192"];

/// Make the seven plates and two figures of N. Greene's "Applications of world projections" (1986) anew, of worlds and
/// a model by formula.
#[derive(Debug, Args)]
#[command(help_template = with_examples(&EXAMPLES))]
pub(crate) struct PlatesArgs {
    /// Where to write
    #[arg(value_hint = ValueHint::DirPath)]
    pub(crate) dir: PathBuf,
    /// Edge of the world's faces, in pixels; the plates' sizes go with it [default: 768]
    #[arg(long, value_name = "N", value_parser = edge, default_value_t = 768, hide_default_value = true, allow_hyphen_values = true)]
    pub(crate) size: usize,
    /// Replace existing files
    #[arg(short = 'y', long)]
    pub(crate) overwrite: bool,
    /// Progress on standard error
    #[arg(
        long,
        value_enum,
        value_name = "STYLE",
        default_value = "auto",
        hide_default_value = true,
        hide_possible_values = true,
        help_heading = "Run"
    )]
    pub(crate) progress: ProgressStyle,
    #[command(flatten)]
    pub(crate) limits: LimitArgs,
}

/// Reads the edge of a face.
fn edge(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(edge @ 32..=8192) => Ok(edge),
        _ => Err("expected a number of pixels from 32 to 8192".to_owned()),
    }
}
