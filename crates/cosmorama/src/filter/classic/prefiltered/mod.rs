//! Filters that prepare a picture once, so that a pixel costs the same at any size: squares, rectangles, splines.

mod mipmap;
mod repeated_integration;
mod summed_area;

pub use mipmap::MipChoice;
pub(super) use mipmap::PreparedMipMap;
pub(super) use repeated_integration::{PreparedIntegrals, bits_of};
pub(super) use summed_area::PreparedSummedArea;
