//! The faces of a cube as other tools name them.

mod images;
mod pattern;
mod set;

pub use cosmorama::layout::{FacePlacement, Naming};
pub use images::FaceImages;
pub use pattern::{FacePattern, LetterCase};
pub use set::{FaceFile, FaceSet};
