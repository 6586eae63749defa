use std::f64::consts::PI;

use crate::raster::Rgba;

/// Samples that interpolate one between them.
pub(super) const REACH: usize = 8;

/// Samples before the place that is interpolated.
pub(super) const BEFORE: i64 = REACH as i64 / 2 - 1;

/// Shape of the window. Waves of up to a quarter of a cycle a sample are off by a thousandth of their height.
const WINDOW: f64 = 6.0;

/// Weights of the seventh difference of as many samples; their magnitudes add to one. Of a jump between the middle two it is
/// [`OF_JUMP`]. Interpolation half way between them takes any such jump for a slope, and is off by half of it. Of waves of a tenth
/// of a cycle a sample, which interpolation follows, the difference is 1/3700.
pub(super) const DIFFERENCE: Weights =
    [1.0 / 128.0, -7.0 / 128.0, 21.0 / 128.0, -35.0 / 128.0, 35.0 / 128.0, -21.0 / 128.0, 7.0 / 128.0, -1.0 / 128.0];

/// Part of a jump between the middle two samples that their seventh difference is.
pub(super) const OF_JUMP: f32 = 20.0 / 128.0;

/// Parts of a sample for which weights are kept. Between them weights are interpolated, and are off by 10⁻⁵.
const PHASES: usize = 256;

/// Weights of the samples around a place.
pub(super) type Weights = [f32; REACH];

/// Returns the weights by which samples make one at the part `t` of the way from the middle two's first to their second: a
/// sinc under a Kaiser window (J. F. Kaiser & R. W. Schafer, *On the use of the I0-sinh window for spectrum analysis*, 1980).
fn sinc(t: f64) -> [f64; REACH] {
    let half = REACH as f64 / 2.0;
    let weight = |k: usize| {
        let x = k as f64 + 1.0 - half - t;
        let window = bessel(WINDOW * (1.0 - (x / half).powi(2)).max(0.0).sqrt());
        if x == 0.0 { window } else { window * (PI * x).sin() / (PI * x) }
    };
    let weights: [f64; REACH] = std::array::from_fn(weight);
    let sum: f64 = weights.iter().sum();
    weights.map(|weight| weight / sum)
}

/// Returns the modified Bessel function of order zero, for arguments up to ten or so.
fn bessel(x: f64) -> f64 {
    let term = |term: &mut f64, k: i32| {
        *term *= (x / 2.0 / f64::from(k)).powi(2);
        Some(*term)
    };
    1.0 + (1..40).scan(1.0, term).sum::<f64>()
}

/// Weights of samples for places between them.
#[derive(Clone, Debug)]
pub(super) struct Interpolation {
    phases: Vec<Weights>,
}

impl Interpolation {
    pub(super) fn new() -> Self {
        let phase = |k: usize| sinc(k as f64 / PHASES as f64).map(|weight| weight as f32);
        Self { phases: (0..=PHASES).map(phase).collect() }
    }

    /// Returns the weights for the part `t` of the way from one sample to the next.
    #[inline(always)]
    pub(super) fn at(&self, t: f64) -> Weights {
        let at = t * PHASES as f64;
        let phase = (at as usize).min(PHASES - 1);
        let (part, [a, b]) = ((at - phase as f64) as f32, [&self.phases[phase], &self.phases[phase + 1]]);
        std::array::from_fn(|k| a[k] + (b[k] - a[k]) * part)
    }
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
            for (sum, part) in sums[at..].iter_mut().zip(sinc(offset - floor)) {
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
    use std::f64::consts::TAU;

    use super::*;

    /// Returns the sum of as many samples of a function as there are weights, the middle two at 0 and 1.
    fn sum(weights: &Weights, sample: impl Fn(f64) -> f64) -> f64 {
        weights.iter().enumerate().map(|(k, weight)| f64::from(*weight) * sample(k as f64 - BEFORE as f64)).sum()
    }

    #[test]
    fn waves_are_interpolated_to_a_thousandth() {
        let interpolation = Interpolation::new();
        for (cycles, most) in [(0.02, 3e-4), (0.1, 1e-3), (0.2, 1e-3), (0.25, 1e-3)] {
            for (t, start) in [(0.0, 0.0), (0.1234, 0.3), (0.5, 0.0), (0.5, 0.25), (0.999, 0.1)] {
                let wave = |x: f64| (TAU * (cycles * x + start)).sin();
                let off = (sum(&interpolation.at(t), wave) - wave(t)).abs();
                assert!(off < most, "{cycles} cycles at {t}: {off}");
            }
        }
    }

    #[test]
    fn the_seventh_difference_tells_jumps_from_waves() {
        let jump = |x: f64| f64::from(x > 0.5);
        assert!((sum(&DIFFERENCE, jump) - f64::from(OF_JUMP)).abs() < 1e-6);
        for (cycles, most) in [(0.05, 3e-6), (0.1, 3e-4), (0.2, 0.025)] {
            for start in [0.0, 0.1, 0.25, 0.3] {
                let wave = |x: f64| (TAU * (cycles * x + start)).sin();
                assert!(sum(&DIFFERENCE, wave).abs() < most, "{cycles} cycles from {start}");
            }
        }
        // Neither a slope nor a bend is taken for a jump.
        assert!(sum(&DIFFERENCE, |x| 3.0 + x + x * x).abs() < 1e-5);
    }

    #[test]
    fn a_row_is_blurred_by_what_lies_at_the_offsets() {
        let taps = Taps::at(&[(-1.5, 1.0), (0.25, 2.0), (3.0, 1.0)]);
        let value = |x: f64| 1.0 + 0.3 * (0.2 * x).sin();
        let from: Vec<Rgba> = (0..taps.weights.len() + 20)
            .map(|k| Rgba::opaque(value((k as i64 + taps.first) as f64) as f32, 0.0, 1.0))
            .collect();
        let mut into = vec![Rgba::TRANSPARENT; 21];
        blur(&taps.weights, &from, &mut into);
        for (k, pixel) in into.iter().enumerate() {
            let at = |offset: f64| value(k as f64 + offset);
            let expected = (at(-1.5) + 2.0 * at(0.25) + at(3.0)) / 4.0;
            assert!(
                (f64::from(pixel.0[0]) - expected).abs() < 2e-4 && (pixel.0[2] - 1.0).abs() < 1e-6,
                "{k}: {pixel:?}"
            );
        }
    }
}
