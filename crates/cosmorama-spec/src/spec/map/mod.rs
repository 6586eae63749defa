//! Text forms of maps of the world and of st maps.

mod st_map;
pub(super) mod world_map;

pub use st_map::{StMapBase, StMapSpec};
