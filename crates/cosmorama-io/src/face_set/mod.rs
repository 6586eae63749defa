//! The faces of a cube as other tools name them.

mod naming;
mod pattern;
mod placement;
mod set;

pub use naming::Naming;
pub use pattern::{FacePattern, LetterCase};
pub use placement::FacePlacement;
pub use set::{FaceFile, FaceSet};
