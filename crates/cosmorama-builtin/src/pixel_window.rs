//! The weighting window around a pixel's centre: exp(−2r²), Greene and Heckbert's Gaussian.

use cosmorama::camera::Footprint;
use glam::DVec3;

/// Standard deviation of the window in pixels.
const SIGMA: f64 = 0.5;

/// Returns the standard deviation of a quantity within the window, given the quantity's gradient per radian.
pub(crate) fn spread(pixel: &Footprint, gradient: DVec3) -> f64 {
    SIGMA * pitch(pixel, gradient)
}

/// Returns the change of a quantity from pixel to pixel, in both directions together, given its gradient per radian.
pub(crate) fn pitch(pixel: &Footprint, gradient: DVec3) -> f64 {
    let (x, y) = (gradient.dot(pixel.jacobian.dx), gradient.dot(pixel.jacobian.dy));
    // hypot() cares for overflow, at ten times the price.
    (x * x + y * y).sqrt()
}

/// Returns the fraction of a window of this spread on the near side of an edge, `distance` beyond its centre.
pub(crate) fn part_within(distance: f64, spread: f64) -> f64 {
    // Further out the window holds less than 1e-6.
    const END: f64 = 5.0;
    if distance > END * spread {
        1.0
    } else if distance < -END * spread {
        0.0
    } else if spread > 0.0 {
        normal(distance / spread)
    } else {
        // A window without width, right on the edge.
        0.5
    }
}

/// Returns the fraction of a window that a line covers, given the distance of the line's middle.
pub(crate) fn part_on_line(distance: f64, half_width: f64, spread: f64) -> f64 {
    part_within(half_width - distance, spread) - part_within(-half_width - distance, spread)
}

/// Returns the places of side² samples around a pixel's centre, as dense as the window is high, so that all have equal
/// weight. No two share a column or a row: an edge along the pixels gets as many steps as there are samples.
pub(crate) fn sample_places(side: usize) -> Vec<(f64, f64)> {
    let n = side as f64;
    let place = |coarse: usize, fine: usize| SIGMA * quantile((coarse as f64 + (fine as f64 + 0.5) / n) / n);
    // A grid turned a little.
    (0..side * side).map(|k| (k % side, k / side)).map(|(a, b)| (place(a, b), place(b, side - 1 - a))).collect()
}

/// Returns the integral of the standard normal distribution (Abramowitz & Stegun 26.2.17; to 1e-7).
fn normal(x: f64) -> f64 {
    let t = (1.0 + 0.231_641_9 * x.abs()).recip();
    let series =
        t * (0.319_381_530 + t * (-0.356_563_782 + t * (1.781_477_937 + t * (-1.821_255_978 + t * 1.330_274_429))));
    let beyond = (-x * x / 2.0).exp() * series * 0.398_942_280_401;
    if x > 0.0 { 1.0 - beyond } else { beyond }
}

/// Returns the inverse of [`normal`].
fn quantile(part: f64) -> f64 {
    let (mut low, mut high) = (-8.0, 8.0);
    for _ in 0..50 {
        let middle = (low + high) / 2.0;
        if normal(middle) < part {
            low = middle;
        } else {
            high = middle;
        }
    }
    (low + high) / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_normal_distribution_has_its_known_values() {
        for (x, expected) in [(0.0, 0.5), (1.0, 0.841_344_746), (-1.0, 0.158_655_254), (2.5, 0.993_790_335)] {
            assert!((normal(x) - expected).abs() < 1e-7, "{x}");
            assert!((quantile(expected) - x).abs() < 1e-5, "{x}");
        }
    }

    #[test]
    fn samples_have_the_middle_and_width_of_the_window() {
        let places = sample_places(8);
        let mean = |of: &dyn Fn(&(f64, f64)) -> f64| places.iter().map(of).sum::<f64>() / places.len() as f64;
        assert!(mean(&|(x, _)| *x).abs() < 1e-9 && mean(&|(_, y)| *y).abs() < 1e-9);
        assert!((mean(&|(x, _)| x * x) - 0.25).abs() < 0.02 && mean(&|(x, y)| x * y).abs() < 0.02);
        let mut columns: Vec<f64> = places.iter().map(|(x, _)| *x).collect();
        columns.sort_by(f64::total_cmp);
        assert!(columns.windows(2).all(|pair| pair[1] > pair[0]));
    }

    #[test]
    fn a_line_covers_what_its_edges_leave() {
        assert!((part_on_line(0.0, 10.0, 1.0) - 1.0).abs() < 1e-6);
        assert!((part_on_line(1.0, 1.0, 0.1) - 0.5).abs() < 1e-6);
        assert_eq!(part_on_line(3.0, 1.0, 0.1), 0.0);
        assert_eq!([part_on_line(0.5, 1.0, 0.0), part_on_line(1.5, 1.0, 0.0)], [1.0, 0.0]);
    }
}
