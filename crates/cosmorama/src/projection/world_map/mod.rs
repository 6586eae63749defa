//! Maps of the whole world that are neither cylinders nor ovals with straight parallels.

pub(crate) mod hammer;
pub(crate) mod octahedral;
