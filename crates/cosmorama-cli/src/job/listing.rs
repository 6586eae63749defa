//! Worlds of many views, view by view.

use anyhow::Result;

use super::{Input, MemoryBudget, pto, world_file};

/// A view as a world file or a Hugin project lists it.
pub(crate) struct Listed {
    /// The file or pattern, as it is written.
    pub(crate) image: String,
    /// The list's name and line.
    pub(crate) place: String,
    /// What is said of its projection, as it is written.
    pub(crate) spec: Option<String>,
    /// What was found: a view, or several that share an image or a pattern.
    pub(crate) input: Input,
}

/// The views of a world file or of a Hugin project; `None` where an input is neither.
pub(crate) fn listed(name: &str, memory: MemoryBudget, warnings: &mut Vec<String>) -> Result<Option<Vec<Listed>>> {
    if world_file::is_world_file(name) {
        return world_file::listed(name, None, memory, warnings).map(Some);
    }
    if pto::is_project(name) {
        return pto::listed(name, memory, warnings).map(Some);
    }
    Ok(None)
}
