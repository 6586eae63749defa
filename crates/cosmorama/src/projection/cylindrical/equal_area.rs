use super::{Latitude, Profile};

/// Lambert's equal-area cylinder, y = sin φ: areas are proportional to solid angles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EqualArea;

impl Profile for EqualArea {
    fn height(&self, latitude: Latitude) -> Option<f64> {
        Some(latitude.sin)
    }

    fn latitude(&self, height: f64) -> Option<(Latitude, f64)> {
        // Rounding must not lose the pole itself, where the derivative is infinite.
        let sin = height.clamp(-1.0, 1.0);
        let cos = ((1.0 - sin) * (1.0 + sin)).sqrt();
        (height.abs() <= 1.0 + 1e-12).then(|| (Latitude { sin, cos }, cos.max(1e-9).recip()))
    }

    fn has_steep_poles(&self) -> bool {
        true
    }
}
