use cosmorama::sphere::Angle;

/// An angle in degrees.
pub fn parse_degrees(text: &str) -> Option<Angle> {
    let degrees: f64 = text.trim_end_matches('°').parse().ok()?;
    degrees.is_finite().then(|| Angle::from_degrees(degrees))
}
