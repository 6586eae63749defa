use cosmorama_spec::parse_degrees;

/// Parses an angle in degrees, as `--yaw` takes it.
pub(crate) fn degrees(text: &str) -> Result<f64, String> {
    parse_degrees(text)
        .map(|angle| angle.degrees())
        .ok_or_else(|| "expected one angle in degrees, without a unit, as in 30 or -12.5".to_owned())
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
