//! Lenses whose angle is an arc sine of the radius. Their slope is infinite at the rim.

/// Tolerance for rounding: a radius this far beyond the rim counts as on it.
const ROUNDING: f64 = 1e-9;

/// The last number below 1. At the rim itself there is no derivative.
const BELOW_ONE: f64 = 1.0 - f64::EPSILON / 2.0;

fn on_the_rim(x: f64) -> f64 {
    if (1.0..=1.0 + ROUNDING).contains(&x) { BELOW_ONE } else { x }
}

/// Returns asin x and its derivative for 0 ≤ x ≤ 1, NaN beyond.
pub(crate) fn arc_sine(x: f64) -> (f64, f64) {
    let x = on_the_rim(x);
    (x.asin(), ((1.0 - x) * (1.0 + x)).sqrt().recip())
}

/// Returns sine and cosine of asin x for 0 ≤ x ≤ 1; the cosine is NaN beyond.
pub(crate) fn sine(x: f64) -> (f64, f64) {
    let x = on_the_rim(x);
    (x, ((1.0 - x) * (1.0 + x)).sqrt())
}

/// Returns sine and cosine of twice the angle that is given by its sine and cosine.
pub(crate) fn twice((sin, cos): (f64, f64)) -> (f64, f64) {
    (2.0 * sin * cos, (cos - sin) * (cos + sin))
}
