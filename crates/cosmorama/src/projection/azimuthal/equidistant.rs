use super::Lens;

/// The equidistant fisheye: the radius is the angle in radians, r = φ. Domemasters use it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Equidistant;

impl Lens for Equidistant {
    fn angle(&self, radius: f64) -> (f64, f64) {
        (radius, 1.0)
    }

    fn radius(&self, angle: f64) -> Option<f64> {
        Some(angle)
    }
}
