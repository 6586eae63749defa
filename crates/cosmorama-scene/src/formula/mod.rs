//! Things by formula: models that need no file.

mod lizard;
mod reflection_cone;
mod tube;
