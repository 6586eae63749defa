use std::path::PathBuf;

use clap::{Args, ValueHint};

use super::convert::LimitArgs;

/// Render an embedded world onto cube faces and make an Omnimax frame of them.
///
/// Files that an earlier demo left in the folder are replaced; no other file is touched.
#[derive(Debug, Args)]
#[command(before_help = "Examples:
  cosmorama demo
  cosmorama demo /tmp/demo --threads 1")]
pub(crate) struct DemoArgs {
    /// Where to write
    #[arg(default_value = "cosmorama-demo", value_hint = ValueHint::DirPath)]
    pub(crate) dir: PathBuf,
    #[command(flatten)]
    pub(crate) limits: LimitArgs,
}
