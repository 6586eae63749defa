use std::path::Path;

use super::SpatialTags;
use crate::VideoError;

pub(super) fn read(_path: &Path) -> Result<Option<SpatialTags>, VideoError> {
    todo!()
}

pub(super) fn write(_path: &Path, _tags: &SpatialTags) -> Result<(), VideoError> {
    todo!()
}
