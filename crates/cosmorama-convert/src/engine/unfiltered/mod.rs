//! Outputs without a filter: worlds by formula, maps of directions, and st maps.

pub(crate) mod formula;
pub(crate) mod st_map;
