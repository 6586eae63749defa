use crate::projection::azimuthal::{Lens, LensError};

/// The field-of-view model (Devernay & Faugeras 2001): r = atan(2 tan φ tan(ω/2))/ω focal lengths, continued past 90°.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldOfViewLens {
    omega: f64,
    /// 2 tan(ω/2).
    factor: f64,
}

impl FieldOfViewLens {
    /// Returns the lens with this ω, 0 < ω < π radians.
    ///
    /// # Errors
    /// When ω is out of its range.
    pub fn from_omega(omega: f64) -> Result<Self, LensError> {
        let inside = omega > 1e-6 && omega < std::f64::consts::PI;
        LensError::unless(inside, "omega", omega, "more than 0 and less than 3.14159 radians")?;
        Ok(Self { omega, factor: 2.0 * (omega / 2.0).tan() })
    }

    /// Returns ω in radians.
    pub fn omega(&self) -> f64 {
        self.omega
    }
}

impl Lens for FieldOfViewLens {
    fn angle(&self, radius: f64) -> (f64, f64) {
        use std::f64::consts::PI;
        let turned = radius * self.omega;
        if turned.is_nan() || turned > PI + 1e-12 {
            return (f64::NAN, f64::NAN);
        }
        let (sin, cos) = turned.min(PI).sin_cos();
        let cos_factor = self.factor * cos;
        (sin.atan2(cos_factor), self.omega * self.factor / (sin * sin + cos_factor * cos_factor))
    }

    fn radius(&self, angle: f64) -> Option<f64> {
        let (sin, cos) = angle.sin_cos();
        Some((self.factor * sin).atan2(cos) / self.omega)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_formula_of_the_paper() {
        let lens = FieldOfViewLens::from_omega(0.95).expect("a lens");
        let angle = 0.8f64;
        let theirs = (2.0 * angle.tan() * (0.95f64 / 2.0).tan()).atan() / 0.95;
        assert!((lens.radius(angle).expect("seen") - theirs).abs() < 1e-15);
        assert!((lens.angle(theirs).0 - angle).abs() < 1e-15);
        assert!(FieldOfViewLens::from_omega(0.0).is_err() && FieldOfViewLens::from_omega(4.0).is_err());
    }
}
