use std::path::{Path, PathBuf};

use clap::{Args, ValueHint};

use super::convert::LimitArgs;
use super::with_examples;

/// Example commands in its help.
pub(super) const EXAMPLES: [&str; 3] =
    ["cosmorama demo", "cosmorama demo /tmp/demo -y --threads 1", "cosmorama demo --animation 48"];

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
    /// Make so many frames of an animation, too: a camera that turns, with motion blur, seen through an eyepiece
    ///
    /// They go into DIR/animation, with a video where ffmpeg is installed.
    #[arg(long, value_name = "N", value_parser = frames, allow_hyphen_values = true)]
    pub(crate) animation: Option<u64>,
    #[command(flatten)]
    pub(crate) limits: LimitArgs,
}

/// Folder whose content was left by a demo.
const OWN_FOLDER: &str = "cosmorama-demo";

/// Reads a number of frames.
fn frames(text: &str) -> Result<u64, String> {
    match text.parse() {
        Ok(count @ 1..=9999) => Ok(count),
        _ => Err("expected a number of frames from 1 to 9999".to_owned()),
    }
}

impl DemoArgs {
    /// Returns whether existing files may be replaced.
    pub(crate) fn may_replace(&self) -> bool {
        self.overwrite || self.dir == Path::new(OWN_FOLDER)
    }
}
