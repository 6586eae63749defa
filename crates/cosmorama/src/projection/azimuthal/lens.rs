use std::f64::consts::PI;

/// A lens with an axis of symmetry: φ(r), strictly rising, φ(0) = 0.
pub trait Lens {
    /// The angle φ from the axis, in radians, at radius r ≥ 0, and its derivative φ′(r); NaN where the lens has no image.
    fn angle(&self, radius: f64) -> (f64, f64);

    /// Sine and cosine of the angle at radius r ≥ 0, NaN where the lens has no image. An angle that is an arc function of the
    /// radius need not be taken for it.
    fn sin_cos(&self, radius: f64) -> (f64, f64) {
        let (angle, _) = self.angle(radius);
        if angle > PI { (f64::NAN, f64::NAN) } else { angle.sin_cos() }
    }

    /// The radius at which the angle φ (radians, 0 to π) is seen; `None` beyond the lens formula's reach.
    fn radius(&self, angle: f64) -> Option<f64>;

    /// The greatest angle from the axis, in radians, that has an image.
    fn reach(&self) -> f64 {
        PI
    }

    /// Whether φ′ grows without bound towards the rim: there the derivative at a point says nothing of a texel.
    fn has_steep_rim(&self) -> bool {
        false
    }
}

/// Reason why coefficients do not make a lens.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum LensError {
    /// A coefficient that is no number, or outside what the formula is made for.
    #[error("{what} is {found}; it must be {expected}")]
    Parameter {
        /// Which one.
        what: &'static str,
        /// What was given.
        found: f64,
        /// What it may be.
        expected: &'static str,
    },
    /// The picture of the axis does not spread out around it.
    #[error("the radius does not rise with the angle even at the axis: the first coefficients cannot be right")]
    NoImage,
}

impl LensError {
    /// Returns an error unless `holds`.
    pub(crate) fn unless(holds: bool, what: &'static str, found: f64, expected: &'static str) -> Result<(), Self> {
        if holds { Ok(()) } else { Err(Self::Parameter { what, found, expected }) }
    }
}
