use std::f64::consts::FRAC_PI_2;

use super::{Latitude, Profile};

/// The equirectangular panorama: y is the latitude in radians.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Equirectangular;

impl Profile for Equirectangular {
    fn height(&self, latitude: Latitude) -> Option<f64> {
        Some(latitude.sin.atan2(latitude.cos))
    }

    fn latitude(&self, height: f64) -> Option<(Latitude, f64)> {
        // Half a pixel row beyond a pole belongs to no direction, but rounding must not lose the pole itself.
        (height.abs() <= FRAC_PI_2 + 1e-12).then(|| {
            let (sin, cos) = height.sin_cos();
            (Latitude { sin, cos }, 1.0)
        })
    }

    fn second_derivative(&self, _: f64) -> Option<f64> {
        Some(0.0)
    }
}
