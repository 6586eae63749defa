use super::{Latitude, Profile};

/// The central cylinder: y = tan φ. Vertical lines stay straight; the poles are at infinity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Central;

/// Greatest height with a direction; beyond it squares overflow.
const HIGHEST: f64 = 1e150;

impl Profile for Central {
    fn height(&self, latitude: Latitude) -> Option<f64> {
        (latitude.cos > 0.0).then(|| latitude.sin / latitude.cos)
    }

    fn latitude(&self, height: f64) -> Option<(Latitude, f64)> {
        let cos = (1.0 + height * height).sqrt().recip();
        (height.abs() < HIGHEST).then_some((Latitude { sin: height * cos, cos }, cos * cos))
    }
}
