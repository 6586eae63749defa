use super::by_angle::{ByAngle, RadiusFormula};
use crate::projection::azimuthal::{LensError, ratio};

/// The unified camera model and its extension: r = sin φ/(α √(β sin² φ + cos² φ) + (1 − α) cos φ) focal lengths (Mei &
/// Rives 2007 with α = ξ/(1 + ξ) and β = 1; Khomutenko, Garcia & Martinet 2016).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnifiedFormula {
    alpha: f64,
    beta: f64,
}

/// Lens with the unified formula.
pub type Unified = ByAngle<UnifiedFormula>;

impl Unified {
    /// Returns the lens with these parameters, 0 ≤ α ≤ 1 and β > 0; β = 1 is the plain unified model.
    ///
    /// # Errors
    /// When a parameter is out of its range.
    pub fn from_parameters(alpha: f64, beta: f64) -> Result<Self, LensError> {
        LensError::unless((0.0..=1.0).contains(&alpha), "alpha", alpha, "from 0 to 1")?;
        LensError::unless(beta > 0.0 && beta.is_finite(), "beta", beta, "more than 0")?;
        Self::new(UnifiedFormula { alpha, beta })
    }

    /// Returns α and β.
    pub fn parameters(&self) -> [f64; 2] {
        [self.formula.alpha, self.formula.beta]
    }
}

impl RadiusFormula for UnifiedFormula {
    fn formula(&self, angle: f64) -> (f64, f64) {
        let (sin, cos) = angle.sin_cos();
        let root = (self.beta * sin * sin + cos * cos).sqrt();
        let depth = self.alpha * root + (1.0 - self.alpha) * cos;
        let slope = self.alpha * (self.beta - 1.0) * sin * cos / root - (1.0 - self.alpha) * sin;
        ratio((sin, cos), (depth, slope))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::projection::azimuthal::Lens;

    #[test]
    fn known_lenses_are_special_cases() {
        let radius = |alpha, angle| Unified::from_parameters(alpha, 1.0).expect("a lens").radius(angle).expect("seen");
        for angle in [0.1f64, 0.5, 1.5] {
            assert!((radius(0.0, angle) - angle.tan()).abs() < 1e-12, "a pinhole");
            assert!((radius(0.5, angle) - 2.0 * (angle / 2.0).tan()).abs() < 1e-12, "stereographic");
            assert!((radius(1.0, angle) - angle.sin()).abs() < 1e-12, "orthographic");
        }
        assert!(Unified::from_parameters(1.1, 1.0).is_err() && Unified::from_parameters(0.5, 0.0).is_err());
    }
}
