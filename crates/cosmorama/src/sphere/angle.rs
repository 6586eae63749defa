use std::ops::{Add, Mul, Neg, Sub};

/// An angle. Its unit is named where it is constructed and where it is read.
///
/// ```
/// use cosmorama::sphere::Angle;
/// let right_angle = Angle::from_degrees(90.0);
/// assert!((right_angle.radians() - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct Angle(f64);

impl Angle {
    /// No turn at all.
    pub const ZERO: Self = Self(0.0);
    /// Half a turn, 180°.
    pub const HALF_TURN: Self = Self(std::f64::consts::PI);
    /// A full turn, 360°.
    pub const TURN: Self = Self(std::f64::consts::TAU);

    /// Returns an angle of so many radians.
    pub const fn from_radians(radians: f64) -> Self {
        Self(radians)
    }

    /// Returns an angle of so many degrees.
    pub const fn from_degrees(degrees: f64) -> Self {
        Self(degrees.to_radians())
    }

    /// Returns the angle in radians.
    pub const fn radians(self) -> f64 {
        self.0
    }

    /// Returns the angle in degrees.
    pub const fn degrees(self) -> f64 {
        self.0.to_degrees()
    }

    /// Returns sine and cosine.
    pub fn sin_cos(self) -> (f64, f64) {
        self.0.sin_cos()
    }

    /// Returns the tangent.
    pub fn tan(self) -> f64 {
        self.0.tan()
    }
}

impl Add for Angle {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl Sub for Angle {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl Neg for Angle {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Mul<f64> for Angle {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self(self.0 * factor)
    }
}
