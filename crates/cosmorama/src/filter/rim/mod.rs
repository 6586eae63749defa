//! Edges of fields of view and of worlds under a kernel.

pub(crate) mod clamp_set;
pub(crate) mod field_edge;
pub(crate) mod rim_extrapolation;
#[cfg(test)]
pub(crate) mod simd_levels;
pub(crate) mod visible_texels;
