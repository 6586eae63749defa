//! Lenses whose angle is an arc sine: their slope is infinite at the rim.

/// A radius that rounding moved past the rim by this much is on it.
const ROUNDING: f64 = 1e-9;

/// The last number below 1: at the rim itself there is no derivative.
const BELOW_ONE: f64 = 1.0 - f64::EPSILON / 2.0;

/// asin x and its derivative for 0 ≤ x ≤ 1, NaN beyond.
pub(super) fn arc_sine(x: f64) -> (f64, f64) {
    let x = if (1.0..=1.0 + ROUNDING).contains(&x) { BELOW_ONE } else { x };
    (x.asin(), ((1.0 - x) * (1.0 + x)).sqrt().recip())
}
