use std::f64::consts::{PI, TAU};

use crate::sphere::Direction;

/// Red, green, blue and opacity.
pub(super) type Channels = [f32; 4];

/// Rings of equal colatitude with samples at equal longitudes, between which smooth functions are interpolated.
///
/// Column 0 is at the front, row 0 half a step below the pole +Y. Beyond a pole, rows go on at the other side.
pub(super) struct Grid {
    size: GridSize,
    /// Row by row; each row begins anew at its end for [`BESIDE`] cells, so that no window wraps round.
    cells: Vec<Channels>,
}

/// Rows of a grid; it has twice as many columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct GridSize {
    pub(super) rows: usize,
}

/// Samples along a side of the window from which a value is interpolated, by Lagrange's polynomials.
pub(super) const TAPS: usize = 6;

/// Cells that are there twice at the end of each row.
const BESIDE: usize = TAPS - 1;

/// Window of a value: its first sample and the weights of all.
#[derive(Clone, Copy)]
pub(super) struct Taps {
    first: isize,
    weights: [f32; TAPS],
}

impl Taps {
    /// Returns the window about a position, in samples.
    pub(super) fn at(position: f64) -> Self {
        let before = position.floor();
        let f = position - before;
        // Lagrange's polynomials of the samples −2 to 3.
        let [a, b, c, d, e, g] = [f + 2.0, f + 1.0, f, f - 1.0, f - 2.0, f - 3.0];
        let weights = [
            b * c * d * e * g / -120.0,
            a * c * d * e * g / 24.0,
            a * b * d * e * g / -12.0,
            a * b * c * e * g / 12.0,
            a * b * c * d * g / -24.0,
            a * b * c * d * e / 120.0,
        ];
        Self { first: before as isize - 2, weights: weights.map(|weight| weight as f32) }
    }
}

impl GridSize {
    /// Returns a size at which windows follow functions of so many bands: at least four samples for the shortest wave. Its rows have
    /// small factors, and are a multiple of 16.
    pub(super) fn of(highest: usize) -> Self {
        let least = 2 * (highest + 1);
        let mut rows = 32;
        while rows < least {
            rows *= 2;
        }
        // Between a power of two and the one before lie five and six eighths of it.
        let smaller = [rows / 8 * 5, rows / 4 * 3].into_iter().find(|rows| *rows >= least && rows.is_multiple_of(16));
        Self { rows: smaller.unwrap_or(rows) }
    }

    /// Returns the number of columns.
    pub(super) fn columns(self) -> usize {
        2 * self.rows
    }

    /// Returns the number of cells of a row, some of which are there twice.
    fn stride(self) -> usize {
        self.columns() + BESIDE
    }

    /// Returns the sine and cosine of the latitude of a row.
    pub(super) fn latitude(self, row: usize) -> (f64, f64) {
        let (sine, cosine) = ((row as f64 + 0.5) * PI / self.rows as f64).sin_cos();
        (cosine, sine)
    }

    /// Returns the windows of a direction: across and down.
    pub(super) fn windows(self, direction: Direction) -> [Taps; 2] {
        let vector = direction.vector();
        let longitude = vector.x.atan2(-vector.z);
        let colatitude = vector.x.hypot(vector.z).atan2(vector.y);
        [self.across(longitude), self.down(colatitude)]
    }

    /// Returns the window of a longitude.
    pub(super) fn across(self, longitude: f64) -> Taps {
        let taps = Taps::at(longitude * self.columns() as f64 / TAU);
        Taps { first: taps.first.rem_euclid(self.columns() as isize), ..taps }
    }

    /// Returns the window of a colatitude, from 0 at +Y to π.
    pub(super) fn down(self, colatitude: f64) -> Taps {
        Taps::at(colatitude * self.rows as f64 / PI - 0.5)
    }

    /// Returns the row and the first column of the k-th line of a window. Lines beyond a pole are on the other side of it.
    fn line(self, [across, down]: [Taps; 2], k: usize) -> (usize, usize) {
        let (rows, row) = (self.rows as isize, down.first + k as isize);
        let (row, is_beyond) = match row {
            row if row < 0 => (-1 - row, true),
            row if row >= rows => (2 * rows - 1 - row, true),
            row => (row, false),
        };
        let column = across.first as usize + if is_beyond { self.rows } else { 0 };
        (row as usize, if column >= self.columns() { column - self.columns() } else { column })
    }
}

impl Grid {
    /// Makes a grid of its rows, each with all its columns.
    pub(super) fn of_rows(size: GridSize, rows: impl IntoIterator<Item = Vec<Channels>>) -> Self {
        let mut cells = Vec::with_capacity(size.rows * size.stride());
        for row in rows {
            cells.extend_from_slice(&row);
            cells.extend_from_slice(&row[..BESIDE]);
        }
        Self { size, cells }
    }

    /// Returns the value in a direction.
    pub(super) fn value(&self, direction: Direction) -> Channels {
        let windows = self.size.windows(direction);
        let [across, down] = windows;
        let mut sum = [0.0; 4];
        for (k, weight) in down.weights.into_iter().enumerate() {
            let (row, column) = self.size.line(windows, k);
            let first = row * self.size.stride() + column;
            for (cell, beside) in self.cells[first..first + TAPS].iter().zip(across.weights) {
                add(&mut sum, *cell, weight * beside);
            }
        }
        sum
    }
}

/// Light on its way into a grid: each texel gives to the samples of its window what they would give to it. Sums of a smooth function
/// over texels are then sums over samples.
pub(super) struct Spread {
    size: GridSize,
    /// Rows to which something was given.
    rows: Vec<Option<Vec<Channels>>>,
}

impl Spread {
    /// Creates a spread of nothing.
    pub(super) fn new(size: GridSize) -> Self {
        Self { size, rows: vec![None; size.rows] }
    }

    /// Returns the size of the grid.
    pub(super) fn size(&self) -> GridSize {
        self.size
    }

    /// Gives the light of a point.
    #[inline(always)]
    pub(super) fn add(&mut self, windows: [Taps; 2], light: Channels) {
        for (k, weight) in windows[1].weights.into_iter().enumerate() {
            let (row, column) = self.size.line(windows, k);
            let light = light.map(|channel| channel * weight);
            let cells = Self::row(&mut self.rows, self.size, row);
            for (cell, beside) in cells[column..column + TAPS].iter_mut().zip(windows[0].weights) {
                add(cell, light, beside);
            }
        }
    }

    /// Returns a ring that light of one colatitude is given to first.
    pub(super) fn ring(&self) -> Ring {
        Ring(vec![[0.0; 4]; self.size.stride()])
    }

    /// Gives the light of a ring, which is emptied.
    #[inline(always)]
    pub(super) fn add_ring(&mut self, down: Taps, ring: &mut Ring) {
        let start = Taps { first: 0, ..down };
        for (k, weight) in down.weights.into_iter().enumerate() {
            let (row, column) = self.size.line([start, down], k);
            let cells = Self::row(&mut self.rows, self.size, row);
            // Beyond a pole, half a turn on.
            let turned = |from: usize| (from + column) % self.size.columns();
            let half = self.size.rows;
            for first in [0, half] {
                let (into, from) = (&mut cells[turned(first)..], &ring.0[first..first + half]);
                into.iter_mut().zip(from).for_each(|(cell, light)| add(cell, *light, weight));
            }
            let (into, from) = (&mut cells[column..], &ring.0[self.size.columns()..]);
            into.iter_mut().zip(from).for_each(|(cell, light)| add(cell, *light, weight));
        }
        ring.0.fill([0.0; 4]);
    }

    fn row(rows: &mut [Option<Vec<Channels>>], size: GridSize, row: usize) -> &mut [Channels] {
        rows[row].get_or_insert_with(|| vec![[0.0; 4]; size.stride()])
    }

    /// Adds what another holds.
    pub(super) fn merge(&mut self, other: Self) {
        for (row, other) in self.rows.iter_mut().zip(other.rows) {
            let Some(other) = other else { continue };
            match row {
                None => *row = Some(other),
                Some(row) => row.iter_mut().zip(other).for_each(|(cell, light)| add(cell, light, 1.0)),
            }
        }
    }

    /// Returns the samples of each row: [`GridSize::columns`] of them, or none for a dark one.
    pub(super) fn into_rows(self) -> Vec<Vec<Channels>> {
        let columns = self.size.columns();
        let folded = |row: Option<Vec<Channels>>| {
            let mut row = row.unwrap_or_default();
            for k in columns..row.len() {
                let beside = row[k];
                add(&mut row[k - columns], beside, 1.0);
            }
            row.truncate(columns);
            row
        };
        self.rows.into_iter().map(folded).collect()
    }
}

/// Light of one colatitude, by longitude.
pub(super) struct Ring(Vec<Channels>);

impl Ring {
    /// Gives light to the samples about a longitude.
    #[inline(always)]
    pub(super) fn add(&mut self, across: &Taps, light: Channels) {
        let first = across.first as usize;
        for (cell, weight) in self.0[first..first + TAPS].iter_mut().zip(across.weights) {
            add(cell, light, weight);
        }
    }
}

#[inline(always)]
fn add(sum: &mut Channels, light: Channels, weight: f32) {
    sum.iter_mut().zip(light).for_each(|(sum, light)| *sum += light * weight);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Computes a function of eight bands.
    fn smooth(direction: Direction) -> Channels {
        let [x, y, z] = direction.vector().to_array();
        [1.0, x * y - z, (x + 0.5 * z).powi(8), y.powi(7)].map(|value| value as f32)
    }

    fn samples(size: GridSize) -> Vec<Vec<Channels>> {
        let at = |row: usize, column: usize| {
            let ((sine, cosine), turn) = (size.latitude(row), column as f64 * TAU / size.columns() as f64);
            smooth(Direction::from_unit([cosine * turn.sin(), sine, -cosine * turn.cos()].into()))
        };
        (0..size.rows).map(|row| (0..size.columns()).map(|column| at(row, column)).collect()).collect()
    }

    #[test]
    fn values_between_samples_are_interpolated() {
        let size = GridSize { rows: 48 };
        let grid = Grid::of_rows(size, samples(size));
        for direction in Direction::spread(1000).chain([Direction::UP, Direction::DOWN, Direction::BACK]) {
            let (found, expected) = (grid.value(direction), smooth(direction));
            for (found, expected) in found.into_iter().zip(expected) {
                assert!((found - expected).abs() < 2e-4, "{direction:?}: {found}, not {expected}");
            }
        }
    }

    /// Checks that texels give to samples what samples give to texels.
    #[test]
    fn sums_over_texels_are_sums_over_samples() {
        let size = GridSize { rows: 48 };
        let mut spread = Spread::new(size);
        let mut expected = [0.0f64; 4];
        for (k, direction) in Direction::spread(300).enumerate() {
            let light = (k % 7) as f32;
            spread.add(size.windows(direction), [light; 4]);
            expected.iter_mut().zip(smooth(direction)).for_each(|(sum, value)| *sum += f64::from(value * light));
        }
        let (mut ring, colatitude) = (spread.ring(), 0.02f64);
        for k in 0..40 {
            let longitude = 0.2 * f64::from(k);
            ring.add(&size.across(longitude), [2.0; 4]);
            let (sine, cosine) = colatitude.sin_cos();
            let at = Direction::from_unit([sine * longitude.sin(), cosine, -sine * longitude.cos()].into());
            expected.iter_mut().zip(smooth(at)).for_each(|(sum, value)| *sum += f64::from(2.0 * value));
        }
        spread.add_ring(size.down(colatitude), &mut ring);
        let mut found = [0.0f64; 4];
        for (row, values) in spread.into_rows().into_iter().zip(samples(size)) {
            for (cell, value) in row.iter().zip(&values) {
                (0..4).for_each(|channel| found[channel] += f64::from(cell[channel]) * f64::from(value[channel]));
            }
        }
        for (found, expected) in found.into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-4 * expected.abs() + 0.05, "{found}, not {expected}");
        }
    }

    #[test]
    fn sizes_have_small_factors() {
        for (highest, rows) in [(3, 32), (20, 48), (95, 192), (96, 256), (148, 320), (400, 1024), (767, 1536)] {
            assert_eq!(GridSize::of(highest).rows, rows, "{highest}");
        }
    }
}
