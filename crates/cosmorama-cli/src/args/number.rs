use crate::spec::parse_degrees;

/// An angle in degrees, as `--yaw` takes it.
pub(super) fn degrees(text: &str) -> Result<f64, String> {
    parse_degrees(text).map(|angle| angle.degrees()).ok_or_else(|| "expected an angle in degrees".to_owned())
}

/// A number of decibels, pixels or whatever the option says; neither infinity nor "not a number".
pub(super) fn finite(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|number: &f64| number.is_finite()).ok_or_else(|| "expected a number".to_owned())
}
