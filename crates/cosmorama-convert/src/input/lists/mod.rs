//! Files that list views: world files and Hugin projects, with their masks.

pub(crate) mod hugin;
pub(crate) mod listing;
pub(crate) mod mask;
pub(crate) mod world_file;
