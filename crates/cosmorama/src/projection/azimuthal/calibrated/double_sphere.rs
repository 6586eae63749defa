use super::by_angle::{ByAngle, RadiusFormula};
use crate::projection::azimuthal::{LensError, ratio};

/// The double sphere camera model (Usenko, Demmel & Cremers 2018): with z = ξ + cos φ, the radius is
/// sin φ/(α √(sin² φ + z²) + (1 − α) z) focal lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubleSphereFormula {
    xi: f64,
    alpha: f64,
}

/// Lens with the double sphere formula.
pub type DoubleSphere = ByAngle<DoubleSphereFormula>;

impl DoubleSphere {
    /// Returns the lens with these parameters, −1 < ξ < 1 and 0 ≤ α ≤ 1.
    ///
    /// As in the paper, the radius is in focal lengths times 1 + ξ.
    ///
    /// # Errors
    /// When a parameter is out of its range.
    pub fn from_parameters(xi: f64, alpha: f64) -> Result<Self, LensError> {
        LensError::unless(xi > -1.0 && xi < 1.0, "xi", xi, "between -1 and 1")?;
        LensError::unless((0.0..=1.0).contains(&alpha), "alpha", alpha, "from 0 to 1")?;
        Self::new(DoubleSphereFormula { xi, alpha })
    }

    /// Returns ξ and α.
    pub fn parameters(&self) -> [f64; 2] {
        [self.formula.xi, self.formula.alpha]
    }
}

impl RadiusFormula for DoubleSphereFormula {
    fn formula(&self, angle: f64) -> (f64, f64) {
        let (sin, cos) = angle.sin_cos();
        let z = self.xi + cos;
        let root = sin.hypot(z);
        let depth = self.alpha * root + (1.0 - self.alpha) * z;
        let slope = -self.alpha * self.xi * sin / root - (1.0 - self.alpha) * sin;
        ratio((sin, cos), (depth, slope))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::projection::azimuthal::{Lens, Unified};

    #[test]
    fn one_sphere_is_the_unified_model() {
        let double = DoubleSphere::from_parameters(0.0, 0.6).expect("a lens");
        let unified = Unified::from_parameters(0.6, 1.0).expect("a lens");
        for angle in [0.1, 0.7, 1.4, 1.9] {
            let (a, b) = (double.radius(angle).expect("seen"), unified.radius(angle).expect("seen"));
            assert!((a - b).abs() < 1e-12, "{angle}: {a}, {b}");
        }
    }

    #[test]
    fn a_camera_of_the_paper() {
        // Table 3 of the paper has ξ = −0.179 and α = 0.591 for a lens of 195°.
        let lens = DoubleSphere::from_parameters(-0.179, 0.591).expect("a lens");
        assert!(lens.reach().to_degrees() > 97.5, "{}", lens.reach().to_degrees());
    }
}
