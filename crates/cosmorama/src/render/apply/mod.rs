//! Application of plans to light: weighted sums of texels, clamped and written to each mirror image.

pub(crate) mod driver;
pub(crate) mod fixed;
pub(crate) mod float;
pub(crate) mod lane_shapes;
pub(crate) mod output_region;
pub(crate) mod prefetch;
pub(crate) mod tap_lists;
pub(crate) mod texels;
pub(crate) mod tile_writer;
pub(crate) mod view_texels;
#[cfg(target_arch = "x86_64")]
pub(crate) mod x86;
