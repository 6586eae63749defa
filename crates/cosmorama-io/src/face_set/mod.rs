//! The faces of a cube as other tools name them.

mod naming;
mod pattern;
mod set;

pub use cosmorama::world::FacePlacement;
pub use naming::Naming;
pub use pattern::{FacePattern, LetterCase};
pub use set::{FaceFile, FaceSet};
