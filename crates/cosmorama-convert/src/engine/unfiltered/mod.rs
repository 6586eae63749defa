//! Outputs without a filter: worlds by formula, maps of directions, and st maps.

pub(crate) mod formula;
pub(crate) mod st_map;

use std::path::Path;

use cosmorama_io::pending::Unfinished;

use crate::engine::Stages;
use crate::job::ConvertJob;
use crate::target::TargetView;

/// A file to make, and what is needed for it.
pub(crate) struct OutputFile<'a> {
    pub(crate) job: &'a ConvertJob,
    /// Number of the frame, if it has one.
    pub(crate) frame: Option<u64>,
    /// Place of the frame among all that are made, from 0.
    pub(crate) place: usize,
    /// Target's views in the frame.
    pub(crate) views: &'a [TargetView],
    pub(crate) stages: &'a Stages,
    /// Target's views at the moments of the frame's exposure, each with its part of the light.
    pub(crate) exposure: &'a [(Vec<TargetView>, f32)],
    /// Registry of files in progress.
    pub(crate) unfinished: &'a Unfinished,
    /// Index among the target's files.
    pub(crate) index: usize,
    /// Path of the file.
    pub(crate) path: &'a Path,
}
