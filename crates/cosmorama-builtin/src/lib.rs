//! Procedural worlds for cosmorama: radiance by direction, given by formula.
//!
//! These worlds have unlimited detail: [`Radiance`] is a point sample. [`picture()`] renders a view of a world. Each
//! pixel is a weighted mean, by formula if the world has one. [`BuiltinWorld`] lists the worlds that users can name. A
//! [`DirectionMap`] holds the direction of each pixel of a view.
#![forbid(unsafe_code)]

mod builtin_world;
mod checker;
mod compass;
mod demo;
mod direction_map;
mod directions;
mod grid;
mod picture;
mod pixel_window;
mod radiance;
mod zone_plate;

pub use builtin_world::BuiltinWorld;
pub use checker::Checker;
pub use demo::{DemoScenery, DemoSky, DemoWorld, Eyepiece, PaintedSky};
pub use direction_map::{DirectionMap, DirectionPixel};
pub use directions::Directions;
pub use grid::Grid;
pub use picture::picture;
pub use radiance::{Average, Radiance};
pub use zone_plate::ZonePlate;
