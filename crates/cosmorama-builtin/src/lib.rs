//! Procedural worlds for cosmorama: radiance by direction, given by formula.
//!
//! A world here is infinitely sharp: [`Radiance`] is a point sample, and [`render`] averages many of
//! them per pixel, in linear light, into an image of any projection.

mod demo;
mod radiance;
mod render;

pub use demo::DemoWorld;
pub use radiance::Radiance;
pub use render::{Supersampling, render};
