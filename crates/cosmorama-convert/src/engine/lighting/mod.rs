//! What keeps light, and what it is averaged to.

pub(crate) mod balance;
pub(crate) mod light_maps;
