//! Files of the faces of a cube, named by any tool's convention.

mod images;
mod pattern;
mod set;

pub use cosmorama::layout::{FacePlacement, Naming};
pub use images::FaceImages;
pub use pattern::{FacePattern, LetterCase};
pub use set::{FaceFile, FaceSet};
