use glam::DVec2;

use super::weighing::{FARTHEST, Region, ScreenKernel, Seen};
use crate::filter::{Ellipse, Kernel};

/// EWA in integers, which the paper mentions ("with proper checking, by using integer variables throughout"): Q, its
/// differences and the weights are integers (Greene & Heckbert 1986).
///
/// Places are rounded to 2⁻¹⁶ texel, and Q has as many bits of fraction as its greatest value in the box leaves of 62.
/// Where none is left, the view's texels are not averaged, and the middle is looked up. The sums of light stay floats, since
/// light has any range.
pub(super) struct EwaInteger {
    weights: Vec<i32>,
    kernel: ScreenKernel,
}

/// Bits of a fraction of a texel.
const PLACE_BITS: u32 = 16;

/// Bits that Q may have.
const MOST_BITS: i32 = 62;

/// Most bits of Q's fraction.
const FINEST: i32 = 40;

/// Bits of a weight of one.
const WEIGHT_BITS: u32 = 15;

impl EwaInteger {
    pub(super) fn new(kernel: ScreenKernel) -> Self {
        let rounded = |q| (kernel.entry(q) * f64::from(1 << WEIGHT_BITS)).round() as i32;
        Self { weights: (0..kernel.length()).map(rounded).collect(), kernel }
    }
}

impl Region for EwaInteger {
    fn texels(&self, seen: &Seen, mut visit: impl FnMut([i64; 2], f64)) {
        let ellipse = Ellipse::new(seen.jacobian, 1.0);
        let half = ellipse.half_extent(self.kernel.radius().powi(2)).min(DVec2::splat(FARTHEST));
        let within = seen.texels_within(half);
        if within.columns.is_empty() || within.rows.is_empty() {
            return;
        }
        let first = *within.columns.start();
        // Nothing in the box is farther from the middle than this, along either axis.
        let reach = half.max_element() + 2.0;
        let coefficients = [ellipse.a, ellipse.b, ellipse.c].map(|at| at * self.kernel.entries_per_unit());
        let sum: f64 = coefficients.iter().map(|coefficient| coefficient.abs()).sum();
        let greatest = sum * (2.0 * reach + 1.0) * (reach + 1.0);
        let bits = (MOST_BITS - greatest.log2().ceil() as i32).min(FINEST);
        if bits < 0 {
            return;
        }
        // Offsets are whole numbers of 2⁻¹⁶ texel and fit 36 bits, coefficients 53: sums of three products fit 128.
        let scale = f64::from(bits).exp2();
        let [a, b, c] = coefficients.map(|coefficient| (coefficient * scale).round() as i128);
        let whole = 1i128 << PLACE_BITS;
        let fixed = |at: f64| (at * f64::from(1 << PLACE_BITS)).round() as i128;
        let end = (self.weights.len() as i64) << bits;
        for j in within.rows {
            let offset = seen.offset([first, j]);
            let (u, v) = (fixed(offset.x), fixed(offset.y));
            // Set up in twice the width; along the row, all fits by the choice of `bits`.
            let start = ((c * v + b * u) * v + a * u * u) >> (2 * PLACE_BITS);
            let step = (a * (2 * u + whole) + b * v) >> PLACE_BITS;
            let (mut q, mut dq, ddq) = (start as i64, step as i64, 2 * a as i64);
            for i in within.columns.clone() {
                if q < end {
                    visit([i, j], f64::from(self.weights[(q.max(0) >> bits) as usize]));
                }
                q += dq;
                dq += ddq;
            }
        }
    }

    fn kernel(&self) -> Option<Kernel> {
        Some(self.kernel.kernel())
    }
}
