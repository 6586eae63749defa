//! Pictures that share one image: faces in a layout, or two lenses.

pub(crate) mod packed;
pub(crate) mod piece;
pub(crate) mod place;
pub(crate) mod size;
