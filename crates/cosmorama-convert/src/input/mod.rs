//! Inputs: files found and probed, their views, and lists of views.

mod builtin;
pub(crate) mod faces;
mod find;
pub(crate) mod folder;
pub(crate) mod lists;
pub(crate) mod packed;
mod planned_input;
pub(crate) mod spec_files;

pub use builtin::Builtin;
pub use find::{Input, InputView};
pub use folder::{face_set, is_one_file};
pub use lists::listing::{Listed, listed};

pub(crate) use faces::face_file::Face;
pub(crate) use faces::face_shape::FacePicture;
pub(crate) use find::SAME_FOR_BOTH;
