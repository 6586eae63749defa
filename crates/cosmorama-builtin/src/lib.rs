//! Procedural worlds for cosmorama: radiance by direction, given by formula.
//!
//! A world here is infinitely sharp: [`Radiance`] is a point sample. [`picture()`] makes a view's picture of it, each pixel
//! the weighted mean of what it sees, by formula where the world has one. [`BuiltinWorld`] is the list of worlds that users
//! can name. A [`DirectionMap`] says where each pixel of a view looks.
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
pub use demo::DemoWorld;
pub use direction_map::{DirectionMap, DirectionPixel};
pub use directions::Directions;
pub use grid::Grid;
pub use picture::picture;
pub use radiance::{Average, Radiance};
pub use zone_plate::ZonePlate;
