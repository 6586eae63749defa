#![doc = include_str!("../README.md")]

pub mod arrange;
pub mod circle;
pub mod compare;
pub mod explain;
pub mod projection;
pub mod raster;
pub mod resample;
pub mod sphere;
pub mod world;
