//! Views of worlds that list them, one by one.

use crate::diagnostic::{Diagnostic, Result};
use crate::input::Input;
use crate::input::lists::{hugin, world_file};
use crate::source::{Access, DecodedPicture, Files, MemoryBudget};

/// A view as a world file or a Hugin project lists it.
pub struct Listed {
    /// File or pattern, as written.
    pub image: String,
    /// Name of the list, and line.
    pub place: String,
    /// Projection, as written.
    pub spec: Option<String>,
    /// Findings: a view, or several that share an image or a pattern.
    pub input: Input,
}

/// Lists the views of a world file or of a Hugin project; `None` if an input is neither.
pub fn listed(
    name: &str,
    files: &dyn Files,
    memory: MemoryBudget,
    warnings: &mut Vec<Diagnostic>,
) -> Result<Option<Vec<Listed>>> {
    let access = Access { files, memory, decoded: &DecodedPicture::default() };
    if world_file::is_world_file(name) {
        return world_file::listed(name, None, access, warnings).map(Some);
    }
    if hugin::is_project(name) {
        return hugin::listed(name, access, warnings).map(Some);
    }
    Ok(None)
}
