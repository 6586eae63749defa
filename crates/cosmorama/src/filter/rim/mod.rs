//! Where a field of view or a world ends under a kernel.

pub(crate) mod clamp_set;
pub(crate) mod field_edge;
pub(crate) mod rim_extrapolation;
#[cfg(test)]
pub(crate) mod simd_levels;
pub(crate) mod visible_texels;
