/// Returns the value below which the fraction `q` of all values lies, interpolated between neighbours in rank. It
/// reorders the values. `None` if there are none.
pub(super) fn quantile(values: &mut [f32], q: f64) -> Option<f64> {
    let rank = q * values.len().checked_sub(1)? as f64;
    let (_, lower, above) = values.select_nth_unstable_by(rank as usize, f32::total_cmp);
    let lower = f64::from(*lower);
    let upper = above.iter().copied().min_by(f32::total_cmp).map_or(lower, f64::from);
    Some(lower + (upper - lower) * rank.fract())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolates_between_ranks() {
        assert_eq!(quantile(&mut [3.0, 1.0, 2.0, 4.0], 0.5), Some(2.5));
        assert_eq!(quantile(&mut [3.0, 1.0, 2.0], 1.0), Some(3.0));
        assert_eq!(quantile(&mut [], 0.5), None);
    }
}
