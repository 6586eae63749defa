//! Things by formula: models that need no file, and the plates that show them.

mod lizard;
mod plates;
mod reflection_cone;
mod tube;

pub use plates::{Plate, Plates};
