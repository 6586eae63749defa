//! Worlds of many views, view by view.

use crate::budget::MemoryBudget;
use crate::diagnostic::{Diagnostic, Result};
use crate::input::lists::{hugin, world_file};
use crate::input::{Access, Files, Input};

/// A view as a world file or a Hugin project lists it.
pub struct Listed {
    /// The file or pattern, as it is written.
    pub image: String,
    /// The list's name and line.
    pub place: String,
    /// What is said of its projection, as it is written.
    pub spec: Option<String>,
    /// What was found: a view, or several that share an image or a pattern.
    pub input: Input,
}

/// The views of a world file or of a Hugin project; `None` where an input is neither.
pub fn listed(
    name: &str,
    files: &dyn Files,
    memory: MemoryBudget,
    warnings: &mut Vec<Diagnostic>,
) -> Result<Option<Vec<Listed>>> {
    let access = Access { files, memory };
    if world_file::is_world_file(name) {
        return world_file::listed(name, None, access, warnings).map(Some);
    }
    if hugin::is_project(name) {
        return hugin::listed(name, access, warnings).map(Some);
    }
    Ok(None)
}
