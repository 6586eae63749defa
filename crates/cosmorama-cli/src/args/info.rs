use clap::{Args, ValueHint};
use cosmorama_convert::Name;

use super::with_examples;
use crate::parse::file;

/// Example commands in its help.
pub(super) const EXAMPLES: [&str; 3] = [
    "cosmorama info panorama.exr",
    "cosmorama info 'faces/{face}.png'",
    "cosmorama info '{face}/{face}_####.exr' --json",
];

/// Tell what a file or a face set is.
#[derive(Debug, Args)]
#[command(help_template = with_examples(&EXAMPLES))]
pub(crate) struct InfoArgs {
    /// An image, a pattern or builtin:NAME; - is standard input
    ///
    /// A pattern has {face} or %c where faces' names stand, and ####, @@@@ or %04d where frame numbers do. A world file (.toml)
    /// or a Hugin project (.pto) is read, too.
    #[arg(value_hint = ValueHint::FilePath, value_parser = file::name())]
    pub(crate) input: Name,
    /// Decode every frame of a pattern and every picture of a world, to find damaged ones
    ///
    /// Without it, a single picture is decoded, if that takes up to 1 GiB. Of others headers alone may be read, which the report says.
    #[arg(long)]
    pub(crate) check: bool,
    /// Print the same as JSON
    #[arg(long)]
    pub(crate) json: bool,
}
