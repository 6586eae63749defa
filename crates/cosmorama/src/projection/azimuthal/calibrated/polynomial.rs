use super::by_radius::{AngleFormula, ByRadius};
use crate::projection::azimuthal::{LensError, finite};

/// Blender's polynomial fisheye: φ = −(k0 + k1 r + k2 r² + k3 r³ + k4 r⁴) radians, r in millimetres on the sensor (Cycles,
/// `fisheye_lens_polynomial_to_direction`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PolynomialFormula {
    /// −k0.
    offset: f64,
    /// Radius within which the offset fades to zero.
    fade: f64,
    /// −k1 to −k4.
    k: [f64; 4],
}

/// Lens with Blender's polynomial.
pub type Polynomial = ByRadius<PolynomialFormula>;

impl Polynomial {
    /// Returns the lens with Blender's coefficients k0 to k4.
    ///
    /// A k0 other than 0 leaves a hole of that angle around the axis, or folds the picture over. Both show only at
    /// radii up to 2 |k0/k1|, about a hundredth of a pixel. There the constant fades to zero, so that each direction
    /// keeps one image.
    ///
    /// # Errors
    /// When the angle does not rise at the axis; Blender's k1 is negative.
    pub fn from_blender(k: [f64; 5]) -> Result<Self, LensError> {
        finite("a coefficient of the polynomial", &k)?;
        let [offset, slope, ..] = k.map(|k| -k);
        let fade = 2.0 * (offset / slope).abs();
        LensError::unless(slope > 0.0, "k1 of the polynomial", k[1], "less than 0, as Blender has it")?;
        Self::new(PolynomialFormula { offset, fade, k: [-k[1], -k[2], -k[3], -k[4]] })
    }

    /// Returns Blender's coefficients k0 to k4.
    pub fn to_blender(&self) -> [f64; 5] {
        let PolynomialFormula { offset, k: [k1, k2, k3, k4], .. } = self.formula;
        [offset, k1, k2, k3, k4].map(|k| 0.0 - k)
    }
}

impl AngleFormula for PolynomialFormula {
    fn formula(&self, radius: f64) -> (f64, f64) {
        let [k1, k2, k3, k4] = self.k;
        let angle = radius * (k1 + radius * (k2 + radius * (k3 + radius * k4)));
        let slope = k1 + radius * (2.0 * k2 + radius * (3.0 * k3 + radius * 4.0 * k4));
        if self.offset == 0.0 {
            return (angle, slope);
        }
        // offset·r/√(r² + fade²).
        let length = radius.hypot(self.fade);
        let faded = self.offset * radius / length;
        (angle + faded, slope + self.offset * (self.fade / length).powi(2) / length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::projection::azimuthal::Lens;

    /// Coefficients with which Blender's panoramic camera starts.
    const BLENDER: [f64; 5] = [
        -1.173_514_371_296_757_7e-5,
        -0.019_988_736_953_434_998,
        -3.352_532_296_570_917_5e-6,
        3.099_275_275_886_036e-6,
        -2.606_464_645_485_452_4e-8,
    ];

    #[test]
    fn blender_s_own_lens() {
        let lens = Polynomial::from_blender(BLENDER).expect("a lens");
        for radius in [0.1f64, 1.0, 5.0, 18.0] {
            let [k0, k1, k2, k3, k4] = BLENDER;
            let theirs = -(k0 + k1 * radius + k2 * radius.powi(2) + k3 * radius.powi(3) + k4 * radius.powi(4));
            let (ours, _) = lens.angle(radius);
            assert!((ours - theirs).abs() < 1e-9, "{radius}: {ours}, {theirs}");
            let back = lens.radius(ours).expect("seen");
            assert!((back - radius).abs() < 1e-12, "{radius}: {back}");
        }
        assert_eq!(lens.angle(0.0).0, 0.0);
        // The lens shows everything, including the direction straight behind.
        assert_eq!(lens.reach(), std::f64::consts::PI);
        let rim = lens.radius(lens.reach()).expect("seen");
        assert!((lens.angle(rim).0 - lens.reach()).abs() < 1e-9, "{rim}");
    }

    #[test]
    fn a_polynomial_ends_where_it_turns_back() {
        // φ = r − r³/3 turns back at r = 1, where it is 2/3.
        let lens = Polynomial::from_blender([0.0, -1.0, 0.0, 1.0 / 3.0, 0.0]).expect("a lens");
        assert!((lens.reach() - 2.0 / 3.0).abs() < 1e-12);
        assert!(lens.radius(0.67).is_none() && lens.angle(1.01).0.is_nan());
        assert!(Polynomial::from_blender([0.0, 1.0, 0.0, 0.0, 0.0]).is_err());
        assert!(Polynomial::from_blender([0.0, f64::NAN, 0.0, 0.0, 0.0]).is_err());
    }
}
