use std::f64::consts::PI;

use crate::projection::azimuthal::{Lens, LensError};
use crate::projection::monotone::{inverse, rises_until};

/// A calibrated lens whose formula gives the radius as a function of the angle.
pub trait RadiusFormula {
    /// Returns the radius, in focal lengths, at the angle φ (radians, 0 to π) from the axis, and its derivative. It may
    /// be called wherever the formula can be evaluated.
    fn formula(&self, angle: f64) -> (f64, f64);
}

/// Lens with a formula r(φ), up to the angle where the formula stops rising.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ByAngle<F> {
    pub(super) formula: F,
    /// Angle and radius at which the image ends: at 180°, or where the formula stops rising.
    rim: (f64, f64),
}

impl<F: RadiusFormula> ByAngle<F> {
    /// Creates the lens with a formula.
    pub(crate) fn new(formula: F) -> Result<Self, LensError> {
        let angle = rises_until(|angle| formula.formula(angle), PI).ok_or(LensError::NoImage)?;
        let (radius, _) = formula.formula(angle);
        Ok(Self { formula, rim: (angle, radius) })
    }
}

impl<F: RadiusFormula> Lens for ByAngle<F> {
    fn angle(&self, radius: f64) -> (f64, f64) {
        if radius.is_nan() || radius > self.rim.1 {
            return (f64::NAN, f64::NAN);
        }
        let angle = inverse(|angle| self.formula.formula(angle), radius, 0.0, self.rim.0);
        (angle, self.formula.formula(angle).1.recip())
    }

    fn radius(&self, angle: f64) -> Option<f64> {
        (angle <= self.rim.0).then(|| self.formula.formula(angle).0)
    }

    fn reach(&self) -> f64 {
        self.rim.0
    }

    fn has_steep_rim(&self) -> bool {
        self.rim.0 < PI
    }
}
