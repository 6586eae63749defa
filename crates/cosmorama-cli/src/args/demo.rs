use std::path::{Path, PathBuf};

use clap::{Args, ValueHint};

use super::convert::LimitArgs;
use super::with_examples;

/// Example commands in its help.
pub(super) const EXAMPLES: [&str; 2] = ["cosmorama demo", "cosmorama demo /tmp/demo -y --threads 1"];

/// Render an embedded world onto cube faces and make an Omnimax frame of them.
#[derive(Debug, Args)]
#[command(help_template = with_examples(&EXAMPLES))]
pub(crate) struct DemoArgs {
    /// Where to write
    #[arg(default_value = OWN_FOLDER, value_hint = ValueHint::DirPath)]
    pub(crate) dir: PathBuf,
    /// Replace existing files; in cosmorama-demo, its own folder, it always does
    #[arg(short = 'y', long)]
    pub(crate) overwrite: bool,
    #[command(flatten)]
    pub(crate) limits: LimitArgs,
}

/// Folder whose content was left by a demo.
const OWN_FOLDER: &str = "cosmorama-demo";

impl DemoArgs {
    /// Returns whether existing files may be replaced.
    pub(crate) fn may_replace(&self) -> bool {
        self.overwrite || self.dir == Path::new(OWN_FOLDER)
    }
}
