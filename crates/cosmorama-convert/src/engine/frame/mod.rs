//! One frame: its files are read, their light gathered, and its pictures made.

mod behind;
mod blur;
mod decisions;
pub(crate) mod files;
mod fill;
pub(crate) mod light;
pub(crate) mod pictures;
mod strips;
