/// Number of neighbouring floats on each side among which a decimal is searched; rounding changes a number by less.
const NEIGHBOURS: usize = 8;

/// Returns the shortest decimal near a number that passes a test; the number itself if none does.
///
/// Units in text and in values differ by a factor, so that a typed number returns with a rounding error: 7 % as
/// 7.000000000000001.
pub(crate) fn decimal(near: f64, is_exact: impl Fn(f64) -> bool) -> f64 {
    let rounded = (0..=15).filter_map(|places| format!("{near:.places$}").parse().ok());
    let above = std::iter::successors(Some(near), |number| Some(number.next_up())).take(NEIGHBOURS);
    let below = std::iter::successors(Some(near), |number| Some(number.next_down())).take(NEIGHBOURS);
    let found = rounded.chain(above).chain(below).find(|number: &f64| is_exact(*number)).unwrap_or(near);
    // Prevents "-0".
    found + 0.0
}
