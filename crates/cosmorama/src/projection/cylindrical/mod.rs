//! Cylinders around the vertical axis: x is the longitude, y a function of the latitude.

mod equirectangular;

pub use equirectangular::Equirectangular;
