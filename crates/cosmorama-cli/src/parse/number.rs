use cosmorama::motion::Ramp;
use cosmorama::sphere::Angle;
use cosmorama_spec::{parse_degrees, parse_ramp};

/// Parses an angle in degrees.
pub(crate) fn degrees(text: &str) -> Result<f64, String> {
    parse_degrees(text)
        .map(|angle| angle.degrees())
        .ok_or_else(|| "expected one angle in degrees, without a unit, as in 30 or -12.5".to_owned())
}

/// Parses an angle between faces, in degrees.
pub(crate) fn crease(text: &str) -> Result<Angle, String> {
    let angle = parse_degrees(text).filter(|angle| (0.0..=180.0).contains(&angle.degrees()));
    angle.ok_or_else(|| "expected an angle in degrees from 0 to 180, as in 40".to_owned())
}

/// Parses an angle in degrees, or one that changes, as `--yaw` takes it.
pub(crate) fn ramp(text: &str) -> Result<Ramp, String> {
    parse_ramp(text).ok_or_else(|| {
        "expected one angle in degrees, without a unit, as in 30 or -12.5, or two, as in 0..360".to_owned()
    })
}

/// Parses a field of view that changes.
pub(crate) fn zoom(text: &str) -> Result<Ramp, String> {
    let is_view = |ramp: &Ramp| [ramp.from, ramp.to].iter().all(|fov| *fov > 0.0 && *fov <= 360.0);
    parse_ramp(text).filter(|ramp| text.contains("..") && is_view(ramp)).ok_or_else(|| {
        "expected two angles, as in 60..30; one that stays belongs into --to, as in --to perspective:fov=60".to_owned()
    })
}

/// Parses the distance of frames.
pub(crate) fn every(text: &str) -> Result<usize, String> {
    text.parse().ok().filter(|frames| *frames > 0).ok_or_else(|| "expected a number of frames, 1 at least".to_owned())
}

/// Parses a distance: a number not less than zero.
pub(crate) fn not_negative(text: &str) -> Result<f64, String> {
    finite(text).ok().filter(|number| *number >= 0.0).ok_or_else(|| "expected a number, 0 or more".to_owned())
}

/// Parses a rate: a number more than zero.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    finite(text).ok().filter(|number| *number > 0.0).ok_or_else(|| "expected a number more than 0".to_owned())
}

/// Parses a factor: a number more than zero that single precision holds.
pub(crate) fn factor(text: &str) -> Result<f32, String> {
    let is_factor = |number: &f32| number.is_finite() && *number > 0.0;
    text.parse().ok().filter(is_factor).ok_or_else(|| "expected a number more than 0".to_owned())
}

/// Parses a distance: a number not less than zero.
pub(crate) fn distance(text: &str) -> Result<f64, String> {
    finite(text).ok().filter(|number| *number >= 0.0).ok_or_else(|| "expected a number not less than 0".to_owned())
}

/// Parses a number, such as decibels; neither infinity nor "not a number".
pub(crate) fn finite(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|number: &f64| number.is_finite())
        .ok_or_else(|| "expected a number without a unit".to_owned())
}
