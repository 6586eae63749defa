//! Image models of maps: panoramas, cylinders, octahedra, ovals.

pub(crate) mod cylinder;
pub(crate) mod equirect;
pub(crate) mod octahedral;
pub(crate) mod world_map;
