use crate::raster::Rgba;

/// Samples that interpolate one between them.
pub(super) const REACH: usize = 6;

/// Samples before the place that is interpolated.
pub(super) const BEFORE: i64 = 2;

/// Returns the weights by which six samples make one at the part `t` of the way from the third to the fourth: the polynomial
/// of degree five through them (Lagrange).
pub(super) fn six(t: f64) -> [f64; REACH] {
    let [a, b, c, d, e, f] = [t + 2.0, t + 1.0, t, t - 1.0, t - 2.0, t - 3.0];
    [
        b * c * d * e * f / -120.0,
        a * c * d * e * f / 24.0,
        a * b * d * e * f / -12.0,
        a * b * c * e * f / 12.0,
        a * b * c * d * f / -24.0,
        a * b * c * d * e / 120.0,
    ]
}

/// Returns the weights of the cubic through the inner four samples, as [`six`] does.
pub(super) fn four(t: f64) -> [f64; 4] {
    let [b, c, d, e] = [t + 1.0, t, t - 1.0, t - 2.0];
    [c * d * e / -6.0, b * d * e / 2.0, b * c * e / -2.0, b * c * d / 6.0]
}

/// Weights of neighbouring samples of a row, by which each is blurred along it.
#[derive(Clone, Debug)]
pub(super) struct Taps {
    /// Sample of the first weight, counted from the one that is blurred.
    pub(super) first: i64,
    pub(super) weights: Vec<f32>,
}

impl Taps {
    /// Returns the taps that add what lies at some offsets, each with a weight; weights are made to add to one. Samples are
    /// interpolated at each.
    pub(super) fn at(offsets: &[(f64, f64)]) -> Self {
        let least = offsets.iter().map(|(offset, _)| *offset).fold(f64::INFINITY, f64::min).floor() as i64;
        let most = offsets.iter().map(|(offset, _)| *offset).fold(f64::NEG_INFINITY, f64::max).floor() as i64;
        let first = least - BEFORE;
        let mut sums = vec![0.0; (most - least) as usize + REACH];
        for (offset, weight) in offsets {
            let floor = offset.floor();
            let at = (floor as i64 - least) as usize;
            for (sum, part) in sums[at..].iter_mut().zip(six(offset - floor)) {
                *sum += weight * part;
            }
        }
        let total: f64 = sums.iter().sum();
        Self { first, weights: sums.iter().map(|sum| (sum / total) as f32).collect() }
    }

    /// Returns the last sample that has a weight, counted from the one that is blurred.
    pub(super) fn last(&self) -> i64 {
        self.first + self.weights.len() as i64 - 1
    }
}

/// Samples that are blurred together.
const BLOCK: usize = 16;

/// Blurs a row: each sample of `into` is the sum of as many of `from` as there are weights, from its own place on.
#[inline(always)]
pub(super) fn blur(weights: &[f32], from: &[Rgba], into: &mut [Rgba]) {
    let from: &[f32] = bytemuck::cast_slice(from);
    let into: &mut [f32] = bytemuck::cast_slice_mut(into);
    for (block, into) in into.chunks_mut(4 * BLOCK).enumerate() {
        let from = &from[4 * BLOCK * block..];
        let mut sums = [0.0f32; 4 * BLOCK];
        if into.len() == sums.len() {
            for (tap, weight) in weights.iter().enumerate() {
                let samples: &[f32; 4 * BLOCK] =
                    from[4 * tap..].first_chunk().expect("as many more samples as weights");
                sums.iter_mut().zip(samples).for_each(|(sum, sample)| *sum += weight * sample);
            }
        } else {
            for (tap, weight) in weights.iter().enumerate() {
                sums.iter_mut().zip(&from[4 * tap..][..into.len()]).for_each(|(sum, sample)| *sum += weight * sample);
            }
        }
        into.copy_from_slice(&sums[..into.len()]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_interpolated_exactly() {
        let value = |x: f64| 3.0 - x + 0.5 * x * x - 0.25 * x * x * x;
        for t in [0.0, 0.25, 0.7] {
            let by_six: f64 = six(t).iter().enumerate().map(|(k, part)| part * value(k as f64 - 2.0)).sum();
            let by_four: f64 = four(t).iter().enumerate().map(|(k, part)| part * value(k as f64 - 1.0)).sum();
            assert!(
                (by_six - value(t)).abs() < 1e-12 && (by_four - value(t)).abs() < 1e-12,
                "{t}: {by_six}, {by_four}"
            );
            let fifth = |x: f64| x.powi(5);
            let by_six: f64 = six(t).iter().enumerate().map(|(k, part)| part * fifth(k as f64 - 2.0)).sum();
            assert!((by_six - fifth(t)).abs() < 1e-12);
        }
    }

    #[test]
    fn a_row_is_blurred_by_what_lies_at_the_offsets() {
        let taps = Taps::at(&[(-1.5, 1.0), (0.25, 2.0), (3.0, 1.0)]);
        // A cubic, which interpolation keeps.
        let value = |x: f64| 1.0 + 0.5 * x - 0.02 * x * x + 0.001 * x * x * x;
        let from: Vec<Rgba> = (0..taps.weights.len() + 20)
            .map(|k| Rgba::opaque(value((k as i64 + taps.first) as f64) as f32, 0.0, 1.0))
            .collect();
        let mut into = vec![Rgba::TRANSPARENT; 21];
        blur(&taps.weights, &from, &mut into);
        for (k, pixel) in into.iter().enumerate() {
            let at = |offset: f64| value(k as f64 + offset);
            let expected = (at(-1.5) + 2.0 * at(0.25) + at(3.0)) / 4.0;
            assert!(
                (f64::from(pixel.0[0]) - expected).abs() < 1e-5 && (pixel.0[2] - 1.0).abs() < 1e-6,
                "{k}: {pixel:?}"
            );
        }
    }
}
