use std::f64::consts::PI;

use super::Lens;

/// The stereographic fisheye, r = 2 tan(φ/2) focal lengths. It preserves angles, and the direction straight behind is
/// at infinity (J. P. Snyder, *Map Projections: A Working Manual*, USGS Professional Paper 1395, 1987, chapter 21, on
/// the sphere).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stereographic;

impl Lens for Stereographic {
    fn angle(&self, radius: f64) -> (f64, f64) {
        let half = radius / 2.0;
        (2.0 * half.atan(), (1.0 + half * half).recip())
    }

    fn sin_cos(&self, radius: f64) -> (f64, f64) {
        // 2t/(1 + t²) and (1 − t²)/(1 + t²) of half the angle's tangent t, for any t up to infinity.
        let half = radius / 2.0;
        (2.0 / (half.recip() + half), 2.0 / (1.0 + half * half) - 1.0)
    }

    fn radius(&self, angle: f64) -> Option<f64> {
        (angle < PI).then(|| 2.0 * (angle / 2.0).tan())
    }
}
