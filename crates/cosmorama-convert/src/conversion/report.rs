use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::budget::peak_bytes;
use crate::diagnostic::Diagnostic;
use crate::engine::{CpuSeconds, Stages};
use crate::output::{Outputs, Remade};

/// What a conversion has done.
#[derive(Clone, Debug)]
pub struct Report {
    /// Files that were read.
    pub inputs: Vec<PathBuf>,
    /// Files that were made.
    pub outputs: Vec<PathBuf>,
    /// Frames that were made.
    pub frames: usize,
    /// Outputs that were complete already.
    pub skipped: usize,
    /// Outputs that were there in another state, and that were made again.
    pub remade: Vec<Remade>,
    /// Time from the check to the end.
    pub wall: Duration,
    /// Time on processors by stage, all threads added.
    pub cpu_seconds: CpuSeconds,
    /// The most memory that this process has held, where the system tells it.
    pub peak_memory_bytes: Option<u64>,
    /// What should be known.
    pub diagnostics: Vec<Diagnostic>,
}

impl Report {
    pub(crate) fn new(
        inputs: BTreeSet<PathBuf>,
        outputs: &Outputs,
        wall: Duration,
        stages: &Stages,
        diagnostics: Vec<Diagnostic>,
    ) -> Self {
        Self {
            inputs: inputs.into_iter().collect(),
            outputs: outputs.paths().map(Path::to_owned).collect(),
            frames: outputs.frames.len(),
            skipped: outputs.skipped,
            remade: outputs.remade.clone(),
            wall,
            cpu_seconds: stages.cpu_seconds(),
            peak_memory_bytes: peak_bytes(),
            diagnostics,
        }
    }
}
