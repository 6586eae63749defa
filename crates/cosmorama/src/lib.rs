#![doc = include_str!("../README.md")]

pub mod arrange;
pub mod camera;
pub mod circle;
pub mod compare;
pub mod explain;
pub mod filter;
pub mod laboratory;
pub mod layout;
pub mod lighting;
pub mod motion;
pub mod prelude;
pub mod projection;
pub mod raster;
pub mod render;
pub mod sphere;
pub mod world;
