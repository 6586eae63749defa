//! Spherical harmonics of high order: rings are transformed by Fourier along longitude, and by Legendre's functions across latitude.

use rayon::prelude::*;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use super::bands::Bands;
use super::grid::{Channels, Grid, GridSize};
use super::legendre::{Parts, Rings};

/// Integrals of a world's light times each harmonic: by number m from 0, then by band from m on.
pub(super) struct Spectrum {
    orders: Vec<Vec<Parts>>,
}

impl Spectrum {
    /// Sums over the samples of a grid, as if each were a point of light.
    pub(super) fn of(size: GridSize, rows: &[Vec<Channels>], highest: usize) -> Self {
        let waves: Vec<Vec<Parts>> = Fourier::new(size).of_rings(rows, highest);
        let rings = Rings::new(size);
        let order = |m: usize| {
            let ring: Vec<Parts> = waves.iter().map(|ring| ring.get(m).copied().unwrap_or_default()).collect();
            rings.sums(m, highest, &ring)
        };
        Self { orders: (0..=highest).into_par_iter().map(order).collect() }
    }

    /// Returns the highest band.
    pub(super) fn highest(&self) -> usize {
        self.orders.len() - 1
    }

    /// Returns the light under a lobe, in every direction.
    pub(super) fn under(&self, bands: &Bands) -> Grid {
        let highest = bands.highest().min(self.highest());
        let size = GridSize::of(highest);
        let rings = Rings::new(size);
        let order = |m: usize| {
            let weighted = self.orders[m][..=highest - m].iter().zip(m..);
            let weighted: Vec<Parts> = weighted.map(|(parts, l)| parts.map(|part| part * bands.factor(l))).collect();
            rings.values(m, &weighted)
        };
        let waves: Vec<Vec<Parts>> = (0..=highest).into_par_iter().map(order).collect();
        Grid::of_rows(size, Fourier::new(size).rings(&waves))
    }
}

/// Fourier's transform of rings.
struct Fourier {
    columns: usize,
    rows: usize,
    planner: FftPlanner<f64>,
}

impl Fourier {
    fn new(size: GridSize) -> Self {
        Self { columns: size.columns(), rows: size.rows, planner: FftPlanner::new() }
    }

    /// Returns the waves of each ring, up to a number of them for the turn. Rings without samples have none.
    fn of_rings(mut self, rows: &[Vec<Channels>], highest: usize) -> Vec<Vec<Parts>> {
        let transform = self.planner.plan_fft_forward(self.columns);
        let columns = self.columns;
        let waves = |row: &Vec<Channels>| {
            if row.is_empty() {
                return Vec::new();
            }
            // Two channels in one transform: one real, one imaginary.
            let both = |first: usize| {
                let pair = |cell: &Channels| Complex::new(f64::from(cell[first]), f64::from(cell[first + 1]));
                let mut both: Vec<_> = row.iter().map(pair).collect();
                transform.process(&mut both);
                both
            };
            let pairs = [both(0), both(2)];
            let wave = |m: usize| {
                let mut parts = Parts::default();
                for (pair, parts) in pairs.iter().zip(parts.as_chunks_mut::<4>().0) {
                    let (ahead, back) = (pair[m], pair[(columns - m) % columns].conj());
                    let (real, turned) = ((ahead + back) * 0.5, (ahead - back) * 0.5);
                    *parts = [real.re, real.im, turned.im, -turned.re];
                }
                parts
            };
            (0..=highest).map(wave).collect()
        };
        rows.par_iter().map(waves).collect()
    }

    /// Returns the samples of each ring, from waves by their number, then by ring.
    fn rings(mut self, waves: &[Vec<Parts>]) -> Vec<Vec<Channels>> {
        let transform = self.planner.plan_fft_inverse(self.columns);
        let columns = self.columns;
        let ring = |j: usize| {
            let mut row = vec![Channels::default(); columns];
            for first in [0, 1] {
                let mut both = vec![Complex::default(); columns];
                for (m, wave) in waves.iter().enumerate() {
                    let [a, b, c, d] = wave[j].as_chunks::<4>().0[first];
                    let (real, turned) = (Complex::new(a, b), Complex::new(-d, c));
                    both[m] = real + turned;
                    if m > 0 {
                        both[columns - m] = real.conj() + Complex::new(d, c);
                    }
                }
                transform.process(&mut both);
                for (cell, value) in row.iter_mut().zip(&both) {
                    (cell[2 * first], cell[2 * first + 1]) = (value.re as f32, value.im as f32);
                }
            }
            row
        };
        (0..self.rows).into_par_iter().map(ring).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lighting::prefilter::Lobe;
    use crate::sphere::Direction;

    /// Checks that a point of light under a lobe is the lobe, but for the bands left out.
    #[test]
    fn a_point_becomes_the_lobe() {
        use super::super::grid::Spread;
        let lobe = Lobe::ggx(0.3).expect("in range");
        let bands = Bands::of(&lobe).expect("few bands");
        let size = GridSize::of(bands.highest());
        let mut spread = Spread::new(size);
        let sun = Direction::new([0.3, 0.8, -0.4].into()).expect("a direction");
        spread.add(size.windows(sun), [1.0, 2.0, 0.0, 4.0]);
        let grid = Spectrum::of(size, &spread.into_rows(), bands.highest()).under(&bands);
        let peak = lobe.weight(1.0);
        for direction in Direction::spread(500).chain([sun]) {
            let expected = lobe.weight(direction.dot(sun));
            let found = grid.value(direction);
            for (found, times) in found.into_iter().zip([1.0, 2.0, 0.0, 4.0]) {
                let off = (f64::from(found) - times * expected).abs();
                assert!(off < 5e-4 * times * peak + 1e-9, "{direction:?}: {found}, not {}", times * expected);
            }
        }
    }
}
