use std::f64::consts::FRAC_PI_2;

use super::{Parallel, Parallels};
use crate::projection::cylindrical::Latitude;

/// The sinusoidal map: x = λ cos φ, y = φ, in radians. Areas are proportional to solid angles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sinusoidal;

/// Least width of a parallel; at the pole itself, which is a point, it would be 0.
const NARROWEST: f64 = 1e-12;

impl Parallels for Sinusoidal {
    fn place(&self, latitude: Latitude) -> (f64, f64) {
        (latitude.sin.atan2(latitude.cos), latitude.cos)
    }

    fn at(&self, height: f64) -> Option<Parallel> {
        (height.abs() <= FRAC_PI_2 + NARROWEST).then(|| {
            let (sin, cos) = height.sin_cos();
            let cos = cos.max(NARROWEST);
            Parallel { latitude: Latitude { sin, cos }, width: cos, latitude_slope: 1.0, width_slope: -sin }
        })
    }
}
