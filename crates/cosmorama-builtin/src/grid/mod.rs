//! The grid by which projectors are aligned on a dome.

mod labels;
mod lines;
mod strokes;

use cosmorama::sphere::{Direction, DirectionJacobian};
use cosmorama::world::Footprint;
use glam::DVec3;

use crate::compass::Compass;
use crate::{Average, Radiance};
use strokes::Strokes;

/// Lines of azimuth and elevation on black: strong ones every 10°, weak ones every 5°, the horizon yellow, the line to the
/// front red, degrees beside them, marks at the zenith and the nadir. Azimuth is 0 at the front and grows to the right.
///
/// Lines have their width in degrees, but are never thinner than a pixel; where they would crowd, they fade, and so do
/// letters too small to read.
#[derive(Clone, Debug)]
pub struct Grid {
    labels: Strokes,
}

impl Grid {
    /// The grid, its letters laid out.
    pub fn new() -> Self {
        Self { labels: Strokes::new(labels::all()) }
    }

    fn light(&self, pixel: &Footprint) -> [f32; 3] {
        let mut light = DVec3::ZERO;
        let mut draw = |colour: DVec3, part: f64| light = light.lerp(colour, part);
        let compass = Compass::of(pixel.direction);
        lines::draw(pixel, &compass, &mut draw);
        lines::draw_marks(pixel, &mut draw);
        self.labels.draw(pixel, &compass, &mut draw);
        light.as_vec3().to_array()
    }
}

impl Default for Grid {
    fn default() -> Self {
        Self::new()
    }
}

impl Radiance for Grid {
    fn radiance(&self, direction: Direction) -> [f32; 3] {
        self.light(&Footprint { direction, jacobian: DirectionJacobian { dx: DVec3::ZERO, dy: DVec3::ZERO } })
    }

    fn average(&self, pixel: &Footprint) -> Average {
        Average::Known(self.light(pixel))
    }
}
