use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::diagnostic::Diagnostic;
use crate::engine::{CpuSeconds, InterpolationReport, LightReport, Stages};
use crate::job::{Outputs, Remade};
use crate::source::peak_bytes;

/// Results of a conversion.
#[derive(Clone, Debug)]
pub struct Report {
    /// Files that were read.
    pub inputs: Vec<PathBuf>,
    /// Files that were made.
    pub outputs: Vec<PathBuf>,
    /// Frames that were made.
    pub frames: usize,
    /// Outputs that were already complete.
    pub skipped: usize,
    /// Outputs that existed in another state, and were made again.
    pub remade: Vec<Remade>,
    /// Time from the check to the end.
    pub wall: Duration,
    /// Processor time by stage, summed over all threads.
    pub cpu_seconds: CpuSeconds,
    /// Most memory that this process has held, where the system reports it.
    pub peak_memory_bytes: Option<u64>,
    /// Memory that was expected to be needed, at most.
    pub estimated_memory_bytes: u64,
    /// Memory that ffmpeg's codecs were expected to hold beside it.
    pub codec_memory_bytes: u64,
    /// Figures of maps of light, by frame; empty for pictures.
    pub light: Vec<LightReport>,
    /// Differences of interpolated maps from computed ones, where that is asked for.
    pub interpolated: Vec<InterpolationReport>,
    /// Diagnostics of the conversion.
    pub diagnostics: Vec<Diagnostic>,
}

/// Frames beyond those that were known at the beginning, with their files, and frames of those that were left out.
#[derive(Debug, Default)]
pub(crate) struct Further {
    pub(super) frames: usize,
    pub(super) files: Vec<PathBuf>,
    pub(super) left_out: LeftOut,
}

/// Frames that were not made, since those of the input are damaged, with the names of their files.
#[derive(Debug, Default)]
pub(crate) struct LeftOut {
    pub(super) frames: usize,
    pub(super) files: BTreeSet<PathBuf>,
}

impl Report {
    pub(crate) fn new(
        inputs: BTreeSet<PathBuf>,
        (outputs, further): (&Outputs, Further),
        wall: Duration,
        stages: &Stages,
        diagnostics: Vec<Diagnostic>,
    ) -> Self {
        let known = outputs.paths().filter(|path| !further.left_out.files.contains(*path));
        Self {
            inputs: inputs.into_iter().collect(),
            outputs: known.map(Path::to_owned).chain(further.files).collect(),
            frames: (outputs.frames.len() + further.frames).saturating_sub(further.left_out.frames),
            skipped: outputs.skipped,
            remade: outputs.resumed.remade.clone(),
            wall,
            cpu_seconds: stages.cpu_seconds(),
            peak_memory_bytes: peak_bytes(),
            estimated_memory_bytes: 0,
            codec_memory_bytes: 0,
            light: Vec::new(),
            interpolated: Vec::new(),
            diagnostics,
        }
    }
}
