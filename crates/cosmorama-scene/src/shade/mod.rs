//! The light that surfaces send to the eye: averages of the world over footprints.

mod albedo_table;
mod beam;
mod facets;
mod glass;
mod maps;
mod proxy;
mod rough;
mod sky;
mod surface;
mod surroundings;

pub(crate) use beam::Beam;
pub use maps::LightMaps;
pub use proxy::{Proxy, Walls};
pub use sky::Sky;
pub(crate) use surface::{Gloss, Surface};
pub(crate) use surroundings::Detail;
pub use surroundings::Surroundings;
