use super::by_angle::{ByAngle, RadiusFormula};
use crate::projection::azimuthal::{LensError, finite};

/// Hugin's lens correction, that of the Panorama Tools. A point at radius r of an ideal lens is seen at r (a r³ + b r²
/// + c r + d) with d = 1 − a − b − c, where r is in Hugin's own unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HuginFormula {
    ideal: HuginIdeal,
    /// Coefficients a, b and c.
    k: [f64; 3],
    /// Focal length in Hugin's unit of radius, half the image's shorter side.
    unit: f64,
}

/// Ideal lens to which Hugin's correction applies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HuginIdeal {
    /// r = tan φ.
    Rectilinear,
    /// r = φ.
    Equidistant,
    /// r = 2 sin(φ/2).
    Equisolid,
    /// r = 2 tan(φ/2).
    Stereographic,
    /// r = sin φ.
    Orthographic,
}

/// Lens with Hugin's correction; its unit of radius is the focal length.
pub type Hugin = ByAngle<HuginFormula>;

impl Hugin {
    /// Returns the lens with Hugin's a, b and c, and a focal length in halves of the image's shorter side.
    ///
    /// # Errors
    /// When a coefficient is not finite, or the radius does not rise at the axis.
    pub fn from_abc(ideal: HuginIdeal, k: [f64; 3], unit: f64) -> Result<Self, LensError> {
        finite("a coefficient of Hugin's", &k)?;
        LensError::unless(unit > 0.0 && unit.is_finite(), "the focal length", unit, "more than 0")?;
        Self::new(HuginFormula { ideal, k, unit })
    }
}

impl HuginIdeal {
    /// Returns the radius in focal lengths at an angle, and its derivative.
    fn radius(self, angle: f64) -> (f64, f64) {
        let (half_sin, half_cos) = (angle / 2.0).sin_cos();
        match self {
            Self::Rectilinear => (angle.tan(), angle.cos().powi(-2)),
            Self::Equidistant => (angle, 1.0),
            Self::Equisolid => (2.0 * half_sin, half_cos),
            Self::Stereographic => (2.0 * half_sin / half_cos, half_cos.powi(-2)),
            Self::Orthographic => angle.sin_cos(),
        }
    }
}

impl RadiusFormula for HuginFormula {
    fn formula(&self, angle: f64) -> (f64, f64) {
        let (radius, slope) = self.ideal.radius(angle);
        let ([a, b, c], r) = (self.k, radius * self.unit);
        let scale = 1.0 - a - b - c + r * (c + r * (b + r * a));
        let scale_slope = self.unit * (c + r * (2.0 * b + r * 3.0 * a));
        (radius * scale, slope * (scale + radius * scale_slope))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::projection::azimuthal::Lens;

    #[test]
    fn the_correction_is_the_polynomial_of_the_ideal_radius() {
        let (k, unit) = ([0.01, -0.03, 0.005], 1.5);
        let lens = Hugin::from_abc(HuginIdeal::Rectilinear, k, unit).expect("a lens");
        let r = unit * 0.4f64.tan();
        let expected = r * (k[0] * r.powi(3) + k[1] * r * r + k[2] * r + 1.0 - k.iter().sum::<f64>()) / unit;
        assert!((lens.radius(0.4).expect("seen") - expected).abs() < 1e-15);
        // The correction leaves a point at half the shorter side where it is.
        let edge = (1.0 / unit).atan();
        assert!((lens.radius(edge).expect("seen") * unit - 1.0).abs() < 1e-14);
    }
}
