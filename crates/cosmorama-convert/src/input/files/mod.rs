//! Names of files: patterns, frames, and folders given in their place.

pub(crate) mod access;
pub(crate) mod decoded_picture;
pub(crate) mod folder;
pub(crate) mod frames;
pub(crate) mod view_files;
