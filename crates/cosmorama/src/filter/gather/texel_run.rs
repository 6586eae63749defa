//! Texels that a kernel reaches, as runs of a row.

use glam::DVec2;

use crate::camera::PixelPoint;
use crate::world::Source;

/// Columns and rows of texels, both ends included; columns may run past a panorama's edges.
pub(crate) struct TexelBox {
    pub(crate) left: i64,
    pub(crate) right: i64,
    pub(crate) top: i64,
    pub(crate) bottom: i64,
}

impl TexelBox {
    /// Returns the box of all texels whose centres are within `reach` of a point.
    pub(crate) fn around(centre: PixelPoint, reach: DVec2) -> Self {
        Self {
            left: ceil(centre.x - reach.x - 0.5),
            right: floor(centre.x + reach.x - 0.5),
            top: ceil(centre.y - reach.y - 0.5),
            bottom: floor(centre.y + reach.y - 0.5),
        }
    }
}

/// A run of texels in one row: its first column in the image, that column without wrapping at the image's edge, and its
/// length.
pub(crate) struct Run {
    pub(crate) column: usize,
    pub(crate) unrolled: i64,
    pub(crate) length: usize,
}

impl Run {
    /// Returns the run of the columns `left..end`, counted without wrapping, in the turn of a panorama that starts at
    /// column `turn`. It is empty if there are none.
    pub(crate) fn within(left: i64, end: i64, turn: i64) -> Self {
        Self { column: (left - turn) as usize, unrolled: left, length: (end - left).max(0) as usize }
    }
}

/// Returns the runs of the columns `left..end` of a panorama: one, or where they cross its edge, one for each turn.
pub(crate) fn runs_around(source: &Source, period: i64, left: i64, end: i64) -> impl Iterator<Item = Run> + use<> {
    // No texel is visited twice.
    let (end, width) = (end.min(left + period), (source.view.width() as i64).min(period));
    let turns = if left < end { left.div_euclid(period)..(end - 1).div_euclid(period) + 1 } else { 0..0 };
    turns.map(move |k| Run::within(left.max(k * period), end.min(k * period + width), k * period))
}

/// Bound on places in texels, farther than any texel lies, since degenerate geometry can put a kernel anywhere. Two
/// such places can be added and subtracted without overflow.
const FARTHEST: f64 = (1_u64 << 52) as f64;

/// Returns the largest integer not greater than a number. Without SSE4.1 `f64::floor` is a function call, and every row
/// of texels needs it.
pub(crate) fn floor(value: f64) -> i64 {
    let value = value.clamp(-FARTHEST, FARTHEST);
    let truncated = value as i64;
    truncated - i64::from(value < truncated as f64)
}

/// Returns the smallest integer not less than a number.
pub(crate) fn ceil(value: f64) -> i64 {
    let value = value.clamp(-FARTHEST, FARTHEST);
    let truncated = value as i64;
    truncated + i64::from(value > truncated as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_beyond_all_images_are_far_away_and_no_more() {
        for far in [f64::MAX, f64::INFINITY, 9.3e18] {
            assert!(floor(far) == ceil(far) && floor(far) - floor(-far) + 1 > 1 << 52, "{far}");
            assert!(floor(-far) == ceil(-far) && ceil(-far) < 0, "{far}");
        }
        assert_eq!([floor(-0.5), ceil(-0.5), floor(2.0), ceil(2.5)], [-1, 0, 2, 3]);
    }
}
