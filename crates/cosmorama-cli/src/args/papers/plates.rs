use clap::Args;
use cosmorama_spec::Size;

use super::PaperArgs;
use crate::args::with_examples;

/// Example commands in its help.
pub(in crate::args) const EXAMPLES: [&str; 2] = ["cosmorama plates plates", "cosmorama plates small -y --size 192"];

/// Make the seven plates and two figures of N. Greene's "Applications of world projections" (1986) anew, of worlds and
/// a model by formula.
#[derive(Debug, Args)]
#[command(help_template = with_examples(&EXAMPLES))]
pub(crate) struct PlatesArgs {
    /// Edge of the world's faces in pixels, as in 512 or 4k [default: 768]
    ///
    /// It is made even. The plates' sizes go with it: their frames are 4/3 of it wide.
    #[arg(long, value_name = "N", value_parser = edge, default_value_t = 768, hide_default_value = true, allow_hyphen_values = true)]
    pub(crate) size: usize,
    #[command(flatten)]
    pub(crate) paper: PaperArgs,
}

/// Reads the edge of a face.
fn edge(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(Size { width: edge @ 32..=8192, height: None }) => Ok(edge),
        _ => Err("expected a number of pixels from 32 to 8192, as in 512 or 4k".to_owned()),
    }
}
