//! The light that surfaces send to the eye: averages of the world over footprints.

mod beam;
mod chrome;
mod glass;
mod maps;
mod sky;
mod surroundings;

pub(crate) use beam::Beam;
pub use chrome::{Chrome, Highlight};
pub use maps::LightMaps;
pub use sky::Sky;
pub(crate) use surroundings::Detail;
pub use surroundings::Surroundings;
