use clap::{Args, ValueHint};

/// Tell what a file or a face set is.
#[derive(Debug, Args)]
#[command(before_help = "Examples:
  cosmorama info panorama.exr
  cosmorama info 'faces/{face}.png'
  cosmorama info '{face}/{face}_####.exr' --json")]
pub(crate) struct InfoArgs {
    /// An image, or a pattern with {face} or %c (faces) and ####, @@@@ or %04d (frames), a world
    /// file (.toml), a Hugin project (.pto) or builtin:NAME; - is standard input
    #[arg(value_hint = ValueHint::FilePath)]
    pub(crate) input: String,
    /// Print the same as JSON
    #[arg(long)]
    pub(crate) json: bool,
}
