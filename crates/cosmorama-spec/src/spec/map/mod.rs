//! Maps of the world and st maps as they are typed.

mod st_map;
pub(super) mod world_map;

pub use st_map::{StMapBase, StMapSpec};
