use std::fmt;

use cosmorama::motion::Ramp;
use cosmorama::sphere::Angle;

use crate::number::decimal;

/// Parses an angle in degrees, with or without a degree sign.
pub fn parse_degrees(text: &str) -> Option<Angle> {
    let degrees: f64 = text.trim_end_matches('°').parse().ok()?;
    degrees.is_finite().then(|| Angle::from_degrees(degrees))
}

/// Parses an angle in degrees, or one that changes, as `0..360`.
///
/// ```
/// use cosmorama_spec::parse_ramp;
/// let turn = parse_ramp("-90..270").expect("a ramp");
/// assert_eq!([turn.from, turn.to], [-90.0, 270.0]);
/// assert!(!parse_ramp("30").expect("an angle").moves() && parse_ramp("0..").is_none());
/// ```
pub fn parse_ramp(text: &str) -> Option<Ramp> {
    let Some((from, to)) = text.split_once("..") else {
        return Some(Ramp::constant(parse_degrees(text)?.degrees()));
    };
    // Exact degrees, so that whole turns are whole.
    let degrees = |text: &str| {
        parse_degrees(text)?;
        text.trim_end_matches('°').parse().ok()
    };
    Some(Ramp { from: degrees(from)?, to: degrees(to)? })
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
