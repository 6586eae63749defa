//! An input by its name: a world file, a Hugin project, or pictures.

use std::path::Path;

use cosmorama_io::FrameList;
use cosmorama_spec::Spec;

use crate::diagnostic::{Diagnostic, Result};
use crate::input::lists::{hugin, world_file};
use crate::input::pictures::refuse_spec;
use crate::input::{Input, Listed};
use crate::source::{Access, DecodedPicture, Files, MemoryBudget, Name, ViewFiles};

impl Input {
    /// Finds and probes the files of an input.
    pub(crate) fn find(
        pattern: &Name,
        from: Option<&Spec>,
        wanted: Option<&FrameList>,
        access: Access,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<Self> {
        pattern.check()?;
        if world_file::is_world_file(pattern) {
            refuse_spec(pattern, from, "views")?;
            return world_file::find(pattern, wanted, access, warnings);
        }
        Self::of_pictures(pattern, from, wanted, access, warnings)
    }

    /// Returns whether an input has a frame marker, or lists views that may have one.
    pub(crate) fn may_be_sequence(pattern: &Name) -> bool {
        world_file::is_world_file(pattern) || ViewFiles::new(Path::new(pattern)).has_frames()
    }
}

/// Lists the views of a world file or of a Hugin project; `None` if an input is neither.
pub fn listed(
    name: &Name,
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
