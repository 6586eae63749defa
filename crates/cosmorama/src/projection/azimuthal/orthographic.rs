use std::f64::consts::FRAC_PI_2;

use super::Lens;
use super::arc_sine::{arc_sine, sine};

/// The orthographic fisheye, r = sin φ focal lengths. Directions beyond 90° from the axis have no image.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Orthographic;

impl Lens for Orthographic {
    fn angle(&self, radius: f64) -> (f64, f64) {
        arc_sine(radius)
    }

    fn sin_cos(&self, radius: f64) -> (f64, f64) {
        sine(radius)
    }

    fn radius(&self, angle: f64) -> Option<f64> {
        (angle <= FRAC_PI_2).then(|| angle.sin())
    }

    fn reach(&self) -> f64 {
        FRAC_PI_2
    }

    fn has_steep_rim(&self) -> bool {
        true
    }
}
