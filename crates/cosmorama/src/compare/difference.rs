use rayon::prelude::*;

use super::pair::{Pair, Site};
use super::quantile::quantile;

/// Differences between the values of two pictures, over red, green and blue of the compared pixels; white is 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Peak signal-to-noise ratio for a peak of 1, in dB; infinite when nothing differs.
    pub psnr: f64,
    /// Root mean square difference.
    pub rms: f64,
    /// Mean of the second picture minus the first, which shows whether one is brighter.
    pub mean: f64,
    /// Largest difference.
    pub largest: Largest,
    /// 99.9th percentile, over pixels, of the largest channel's difference.
    pub percentile_99_9: f64,
}

/// The largest absolute difference of any channel, and its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Largest {
    /// The absolute difference.
    pub value: f64,
    /// Column and row; the first one in reading order among equals.
    pub pixel: (usize, usize),
}

impl Difference {
    /// Computes the differences of values after `encode`; `None` when no pixel is compared.
    pub(super) fn between(pair: &Pair<'_>, encode: impl Fn(f64) -> f64 + Sync) -> Option<Self> {
        let (_, height) = pair.size();
        // Rows are added in their order, so that the sums do not depend on the number of threads.
        let rows: Vec<_> = (0..height).into_par_iter().map(|j| Tally::of_row(pair, j, &encode)).collect();
        let mut all = Tally::default();
        rows.into_iter().for_each(|row| all.add(row));
        all.difference()
    }
}

/// Partial sums over a part of the picture.
#[derive(Default)]
struct Tally {
    sum: f64,
    squares: f64,
    largest: Option<Largest>,
    /// Largest absolute difference of any channel, for each pixel.
    worst: Vec<f32>,
}

impl Tally {
    fn of_row(pair: &Pair<'_>, j: usize, encode: impl Fn(f64) -> f64) -> Self {
        let mut tally = Self::default();
        for site in pair.row(j) {
            let differences = differences(&site, &encode);
            let worst = differences.iter().fold(0.0, |worst: f64, d| worst.max(d.abs()));
            tally.sum += differences.iter().sum::<f64>();
            tally.squares += differences.iter().map(|d| d * d).sum::<f64>();
            tally.worst.push(worst as f32);
            tally.meet(Largest { value: worst, pixel: (site.column, j) });
        }
        tally
    }

    fn meet(&mut self, candidate: Largest) {
        if self.largest.is_none_or(|largest| candidate.value > largest.value) {
            self.largest = Some(candidate);
        }
    }

    fn add(&mut self, later: Self) {
        self.sum += later.sum;
        self.squares += later.squares;
        self.worst.extend(later.worst);
        later.largest.into_iter().for_each(|largest| self.meet(largest));
    }

    fn difference(mut self) -> Option<Difference> {
        let samples = 3.0 * self.worst.len() as f64;
        let mean_square = self.squares / samples;
        Some(Difference {
            psnr: -10.0 * mean_square.log10(),
            rms: mean_square.sqrt(),
            mean: self.sum / samples,
            largest: self.largest?,
            percentile_99_9: quantile(&mut self.worst, 0.999)?,
        })
    }
}

/// Returns the second picture's values minus the first's, by channel.
fn differences(site: &Site, encode: impl Fn(f64) -> f64) -> [f64; 3] {
    std::array::from_fn(|c| encode(site.second.0[c].into()) - encode(site.first.0[c].into()))
}
