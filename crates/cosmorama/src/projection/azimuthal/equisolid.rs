use super::Lens;
use super::arc_sine::{arc_sine, sine, twice};

/// The equisolid fisheye, r = 2 sin(φ/2) focal lengths: areas are proportional to solid angles (Miyamoto 1964).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Equisolid;

impl Lens for Equisolid {
    fn angle(&self, radius: f64) -> (f64, f64) {
        let (half, slope) = arc_sine(radius / 2.0);
        (2.0 * half, slope)
    }

    fn sin_cos(&self, radius: f64) -> (f64, f64) {
        twice(sine(radius / 2.0))
    }

    fn radius(&self, angle: f64) -> Option<f64> {
        Some(2.0 * (angle / 2.0).sin())
    }

    fn has_steep_rim(&self) -> bool {
        true
    }
}
