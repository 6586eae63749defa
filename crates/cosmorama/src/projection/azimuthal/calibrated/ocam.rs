use super::by_radius::{AngleFormula, ByRadius};
use crate::projection::azimuthal::{LensError, finite};

/// Scaramuzza's polynomial (OCamCalib). The ray through the point at ρ pixels from the centre has the component ρ
/// across the axis and f(ρ) = a0 + a1 ρ + a2 ρ² + … along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OcamFormula([f64; OCAM_COEFFICIENTS]);

/// Largest number of coefficients of a calibration.
pub const OCAM_COEFFICIENTS: usize = 8;

/// Lens with OCamCalib's polynomial.
pub type Ocam = ByRadius<OcamFormula>;

impl Ocam {
    /// Returns the lens with the coefficients a0, a1, a2 and so on; unused ones are 0.
    ///
    /// OCamCalib's a0 is negative, because its axis points away from the scene; MATLAB's is positive. Both are
    /// accepted.
    ///
    /// # Errors
    /// When a coefficient is not finite, or a0 is 0.
    pub fn from_coefficients(a: [f64; OCAM_COEFFICIENTS]) -> Result<Self, LensError> {
        finite("a coefficient of OCamCalib", &a)?;
        LensError::unless(a[0] != 0.0, "a0 of OCamCalib", a[0], "another number than 0")?;
        let ahead = a[0].signum();
        Self::new(OcamFormula(a.map(|a| a * ahead)))
    }

    /// Returns the coefficients a0, a1, a2 and so on, with a0 positive.
    pub fn coefficients(&self) -> [f64; OCAM_COEFFICIENTS] {
        self.formula.0
    }
}

impl AngleFormula for OcamFormula {
    fn formula(&self, radius: f64) -> (f64, f64) {
        let (mut depth, mut slope) = (0.0, 0.0);
        for coefficient in self.0.iter().rev() {
            slope = slope * radius + depth;
            depth = depth * radius + coefficient;
        }
        // φ = atan2(ρ, f): φ′ = (f − ρ f′)/(ρ² + f²).
        (radius.atan2(depth), (depth - radius * slope) / (radius * radius + depth * depth))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::projection::azimuthal::Lens;

    #[test]
    fn a_pinhole_is_a_constant() {
        for sign in [-1.0, 1.0] {
            let mut a = [0.0; OCAM_COEFFICIENTS];
            a[0] = 300.0 * sign;
            let lens = Ocam::from_coefficients(a).expect("a lens");
            let (angle, slope) = lens.angle(300.0);
            assert!((angle.to_degrees() - 45.0).abs() < 1e-12 && (slope - 1.0 / 600.0).abs() < 1e-15);
        }
    }

    #[test]
    fn a_lens_that_sees_more_than_half_the_world() {
        // f = −250 + ρ²/500: the axis's right angle is at ρ = √125000, where f = 0.
        let mut a = [0.0; OCAM_COEFFICIENTS];
        (a[0], a[2]) = (-250.0, 1.0 / 500.0);
        let lens = Ocam::from_coefficients(a).expect("a lens");
        let right_angle = lens.radius(std::f64::consts::FRAC_PI_2).expect("seen");
        assert!((right_angle - 125_000f64.sqrt()).abs() < 1e-9, "{right_angle}");
        assert!(lens.reach() > 2.0);
    }
}
