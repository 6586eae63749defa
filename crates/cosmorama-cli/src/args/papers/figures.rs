use clap::Args;

use super::PaperArgs;
use crate::args::with_examples;

/// Example commands in its help.
pub(in crate::args) const EXAMPLES: [&str; 2] = ["cosmorama figures figures", "cosmorama figures /tmp/figures -y"];

/// Remake the figures of the papers from our own pictures.
///
/// Figures 3 to 9 of Greene & Heckbert's Omnimax paper (1986), and figure 2 of Greene's World Projections (1986), as SVG and PNG:
/// the unfolded cube, which face gives which pixel, the frame, aliasing, footprints, the paraboloid Q, the kernel, a reflection
/// cone in Mercator's projection and on a cube. docs/filters.md shows them.
#[derive(Debug, Args)]
#[command(help_template = with_examples(&EXAMPLES))]
pub(crate) struct FiguresArgs {
    #[command(flatten)]
    pub(crate) paper: PaperArgs,
}
