//! Filters that prepare a picture once, so that a pixel costs the same at any size: squares, rectangles, splines.

mod mipmap;
mod repeated_integration;
mod summed_area;

pub(super) use mipmap::MipMap;
pub use repeated_integration::IntegrationOrder;
pub(super) use repeated_integration::RepeatedIntegration;
pub(super) use summed_area::SummedArea;
