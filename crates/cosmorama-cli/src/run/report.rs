use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::Result;
use serde::Serialize;

use super::stages::{CpuSeconds, Stages};
use crate::job::{Outputs, Remade, peak_bytes};
use crate::stream;

/// What `--json` prints after a conversion.
#[derive(Debug, Serialize)]
pub(super) struct Report {
    inputs: Vec<PathBuf>,
    outputs: Vec<PathBuf>,
    /// Frames that were made.
    frames: usize,
    /// Outputs that were complete already.
    skipped: usize,
    /// Outputs that `--resume` found in another state, and that were made again.
    remade: Vec<Remade>,
    wall_seconds: f64,
    cpu_seconds: CpuSeconds,
    peak_memory_bytes: Option<u64>,
    warnings: Vec<String>,
}

impl Report {
    pub(super) fn new(
        inputs: BTreeSet<PathBuf>,
        outputs: &Outputs,
        wall: Duration,
        stages: &Stages,
        warnings: Vec<String>,
    ) -> Self {
        Self {
            inputs: inputs.into_iter().collect(),
            outputs: outputs.paths().map(Path::to_owned).collect(),
            frames: outputs.frames.len(),
            skipped: outputs.skipped,
            remade: outputs.remade.clone(),
            wall_seconds: wall.as_secs_f64(),
            cpu_seconds: stages.cpu_seconds(),
            peak_memory_bytes: peak_bytes(),
            warnings,
        }
    }

    pub(super) fn to_json(&self) -> Result<String> {
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }
}

impl Report {
    /// What people want to know, on standard error.
    pub(super) fn tell(&self) {
        let what = match (&self.outputs[..], self.frames) {
            ([], _) => "nothing to do".to_owned(),
            ([one], _) => stream::told(&one.to_string_lossy()),
            (many, 1) => format!("{} files", many.len()),
            (many, frames) => format!("{} files of {frames} frames", many.len()),
        };
        let skipped = if self.skipped == 0 { String::new() } else { format!(", {} kept", self.skipped) };
        let (seconds, stages) = (self.wall_seconds, self.cpu_seconds.describe());
        stream::say(format_args!("{what}{skipped} in {seconds:.2} s ({stages})"));
    }
}
