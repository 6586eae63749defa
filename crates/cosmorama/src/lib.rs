//! Cosmorama: world projections, resampled with the elliptical weighted average (EWA) filter.

pub mod compare;
pub mod explain;
pub mod projection;
pub mod raster;
pub mod resample;
pub mod sphere;
pub mod world;
