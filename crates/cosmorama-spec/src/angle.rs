use std::fmt;

use cosmorama::sphere::Angle;

use crate::number::decimal;

/// Parses an angle in degrees, with or without a degree sign.
pub fn parse_degrees(text: &str) -> Option<Angle> {
    let degrees: f64 = text.trim_end_matches('°').parse().ok()?;
    degrees.is_finite().then(|| Angle::from_degrees(degrees))
}

/// An angle that prints as the shortest number of degrees which [`parse_degrees`] turns into the same angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Degrees(pub Angle);

impl fmt::Display for Degrees {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(angle) = *self;
        write!(f, "{}", decimal(angle.degrees(), |degrees| Angle::from_degrees(degrees) == angle))
    }
}
