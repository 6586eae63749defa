//! The faces of a cube in files of their own.

pub(crate) mod face_file;
pub(crate) mod face_shape;
