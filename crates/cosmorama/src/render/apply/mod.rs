//! Plans applied to light: weighted sums, clamped, written where each symmetry shows them.

pub(crate) mod fixed;
pub(crate) mod float;
pub(crate) mod output_region;
pub(crate) mod pack;
pub(crate) mod prefetch;
pub(crate) mod tap_lists;
pub(crate) mod tile_writer;
#[cfg(target_arch = "x86_64")]
pub(crate) mod x86;
