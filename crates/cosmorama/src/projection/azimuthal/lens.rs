use std::f64::consts::PI;

/// A lens with rotational symmetry: φ(r) rises strictly, and φ(0) = 0.
pub trait Lens {
    /// Returns the angle φ from the axis, in radians, at radius r ≥ 0, and its derivative φ′(r); NaN where the lens has
    /// no image.
    fn angle(&self, radius: f64) -> (f64, f64);

    /// Returns sine and cosine of the angle at radius r ≥ 0, NaN where the lens has no image. A lens whose angle is an
    /// arc function of the radius can compute them without the angle.
    fn sin_cos(&self, radius: f64) -> (f64, f64) {
        let (angle, _) = self.angle(radius);
        if angle > PI { (f64::NAN, f64::NAN) } else { angle.sin_cos() }
    }

    /// Returns the radius at which the angle φ (radians, 0 to π) is seen; `None` beyond the reach of the formula.
    fn radius(&self, angle: f64) -> Option<f64>;

    /// Returns the greatest angle from the axis, in radians, that has an image.
    fn reach(&self) -> f64 {
        PI
    }

    /// Returns whether φ′ grows without bound towards the rim. There the derivative at a point says nothing about a
    /// texel's extent.
    fn has_steep_rim(&self) -> bool {
        false
    }
}

/// Reason why coefficients do not make a lens.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum LensError {
    /// A coefficient is not finite, or outside the range of the formula.
    #[error("{what} is {found}; it must be {expected}")]
    Parameter {
        /// Name of the coefficient.
        what: &'static str,
        /// Given value.
        found: f64,
        /// Permitted values, in words.
        expected: &'static str,
    },
    /// The formula does not rise at the axis.
    #[error("the radius does not rise with the angle even at the axis: the first coefficients cannot be right")]
    NoImage,
    /// The formula reaches a radius that no image has, not far from the axis.
    #[error("the radius is {radius:e} only {}° from the axis: the coefficients cannot be right", (degrees * 1e3).round() / 1e3)]
    Endless {
        /// Angle from the axis, in degrees.
        degrees: f64,
        /// Radius there, in the lens's unit.
        radius: f64,
    },
}

impl LensError {
    /// Returns an error unless `holds`.
    pub(crate) fn unless(holds: bool, what: &'static str, found: f64, expected: &'static str) -> Result<(), Self> {
        if holds { Ok(()) } else { Err(Self::Parameter { what, found, expected }) }
    }
}
