//! Texels weighed under a footprint: by regions of views, by kernels on the screen, by areas.

mod polygon;
mod region;
mod screen_kernel;

pub(super) use polygon::{area_in_square, columns_at};
pub(super) use region::{FARTHEST, Region, Seen, Weighing, reached};
pub(super) use screen_kernel::ScreenKernel;
