use super::{Latitude, Profile};

/// Mercator's map: y = ln tan(π/4 + φ/2). It preserves angles; the poles are at infinity (J. P. Snyder, *Map
/// Projections: A Working Manual*, USGS Professional Paper 1395, 1987, equations 7-1 and 7-2).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mercator;

impl Profile for Mercator {
    fn height(&self, latitude: Latitude) -> Option<f64> {
        // ln tan(π/4 + φ/2) = asinh tan φ, which is exact near the equator.
        (latitude.cos > 0.0).then(|| (latitude.sin / latitude.cos).asinh())
    }

    fn latitude(&self, height: f64) -> Option<(Latitude, f64)> {
        // Beyond 355, where the cosine is less than 1e-154, squares of it are lost.
        let cos = height.cosh().recip();
        (height.abs() < 355.0).then(|| (Latitude { sin: height.tanh(), cos }, cos))
    }
}
