//! The faces of a cube in files of their own.

mod cube;
pub(crate) mod face_file;
pub(crate) mod face_shape;
