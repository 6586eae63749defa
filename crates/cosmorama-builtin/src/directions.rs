use cosmorama::camera::Footprint;
use cosmorama::sphere::Direction;

use crate::{Average, Radiance};

/// A world whose colour is its direction: x, y and z from −1…1 become red, green and blue from 0…1. It is nearly linear
/// within a pixel, so a pixel has the colour of its centre.
#[derive(Clone, Copy, Debug, Default)]
pub struct Directions;

impl Radiance for Directions {
    fn radiance(&self, direction: Direction) -> [f32; 3] {
        direction.vector().to_array().map(|component| (component / 2.0 + 0.5) as f32)
    }

    fn average(&self, pixel: &Footprint) -> Average {
        Average::Known(self.radiance(pixel.direction))
    }
}
