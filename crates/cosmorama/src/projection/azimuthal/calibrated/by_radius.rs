use std::f64::consts::PI;

use crate::projection::azimuthal::{Lens, LensError};
use crate::projection::monotone::{inverse, rises_until};

/// A calibrated lens whose formula gives the angle as a function of the radius.
pub trait AngleFormula {
    /// Returns the angle from the axis, in radians, at radius r ≥ 0, and its derivative. It may be called wherever the
    /// formula can be evaluated.
    fn formula(&self, radius: f64) -> (f64, f64);
}

/// Lens with a formula φ(r), up to the radius where the formula stops rising.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ByRadius<F> {
    pub(super) formula: F,
    /// Radius and angle at which the image ends: at 180°, or where the formula stops rising.
    rim: (f64, f64),
}

impl<F: AngleFormula> ByRadius<F> {
    /// Creates the lens with a formula.
    pub(crate) fn new(formula: F) -> Result<Self, LensError> {
        let (_, slope) = formula.formula(0.0);
        if !(slope > 0.0 && slope.is_finite()) {
            return Err(LensError::NoImage);
        }
        // Far enough for a lens that is four times as long at its rim as on its axis.
        let far = 4.0 * PI / slope;
        let up_to_half_turn = |radius: f64| Some(formula.formula(radius)).filter(|(angle, _)| *angle <= PI);
        let rising = |radius: f64| up_to_half_turn(radius).unwrap_or((f64::NAN, f64::NAN));
        let radius = rises_until(rising, far).ok_or(LensError::NoImage)?;
        let (angle, _) = formula.formula(radius);
        Ok(Self { formula, rim: (radius, angle) })
    }
}

impl<F: AngleFormula> Lens for ByRadius<F> {
    fn angle(&self, radius: f64) -> (f64, f64) {
        if radius <= self.rim.0 { self.formula.formula(radius) } else { (f64::NAN, f64::NAN) }
    }

    fn radius(&self, angle: f64) -> Option<f64> {
        let inverse = || inverse(|radius| self.formula.formula(radius), angle, 0.0, self.rim.0);
        // 180° may be missed by rounding.
        if angle <= self.rim.1 { Some(inverse()) } else { (angle <= self.reach()).then_some(self.rim.0) }
    }

    fn reach(&self) -> f64 {
        // A difference to 180° this small is rounding.
        if self.rim.1 > PI - 1e-9 { PI } else { self.rim.1 }
    }
}
