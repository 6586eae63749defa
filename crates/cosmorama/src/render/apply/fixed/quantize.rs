//! Rounding of weights to integers, for eight windows at once.

use std::ops::Range;

use fearless_simd::{Simd, f32x8, i16x8, i32x8, prelude::*};

use super::weights::{HIGHEST, SMALL, mark};
use crate::render::apply::lane_shapes::LaneShapes;
use crate::render::batch::window::{Size, Windows};
use crate::render::plan::window_format::COLUMNS_UNDER;
use crate::render::scan::tile::LARGEST;
use crate::render::scan::tile::SIDE;

/// Rounded weights of the windows of a run, one window in each lane. In bytes of marks, each bit is a lane.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rounded {
    pub(crate) width: usize,
    pub(crate) height: usize,
    /// Number of bits by which weights are scaled.
    pub(crate) bits: u32,
    /// Weights of all lanes, texel by texel and row by row. There are zeros on both sides of each row.
    weights: Vec<[i16; SIDE]>,
    /// Bits of the lanes in which a texel lies under the pixel, for each texel, with zeros on both sides of each row as
    /// well.
    under: Vec<u8>,
    shapes: LaneShapes,
    /// Weights of each lane by row, for windows with at most [`SIDE`] columns and rows. There are [`MARGIN`] zeros on
    /// either side, and more rows than are written.
    small: [[[i16; 2 * SIDE]; SIDE + HIGHEST]; SIDE],
}

/// Number of zeros on either side of a row of a small window.
const MARGIN: usize = SIDE / 2;

/// Number so large that adding it rounds to an integer, which the last bits of the sum then hold: 1.5 × 2²³.
const ROUNDER: f32 = 12_582_912.0;

/// First texel of a lane's window, relative to the first texel of the run's windows. It may lie one column to the left
/// of that.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Origin {
    pub(crate) column: isize,
    pub(crate) row: usize,
}

impl Rounded {
    /// Rounds the weights of all lanes; false if they are too large.
    #[inline(always)]
    pub(crate) fn fill<S: Simd>(&mut self, simd: S, windows: &Windows) -> bool {
        let Some(bits) = scale(windows.size()) else { return false };
        self.bits = bits;
        self.resize(windows);
        let (pitch, width) = (self.pitch(), self.width);
        let (mut columns, mut rows) = ([0; SIDE], [0; SIDE]);
        let mut rounding = Rounding::new(simd, bits);
        let weights = windows.weights().chunks_exact(width).zip(windows.under().chunks_exact(width));
        let into = self.weights.chunks_exact_mut(pitch).zip(self.under.chunks_exact_mut(pitch));
        for (row, ((into, under_into), (weights, under))) in into.zip(weights).enumerate() {
            let (into, under_into) = (&mut into[1..][..width], &mut under_into[1..][..width]);
            let mut in_row = 0;
            for column in 0..width {
                let rounded = rounding.next(simd, &weights[column]);
                into[column] = rounded.to_array();
                under_into[column] = under[column];
                let counts = !(rounded.simd_eq(0).to_bitmask() as u8) | under[column];
                columns[column % SIDE] |= counts;
                in_row |= counts;
            }
            rows[row % SIDE] |= in_row;
        }
        if self.width <= SIDE && self.height <= SIDE {
            self.turn(simd, [columns, rows]);
        } else {
            self.shapes.clear();
        }
        true
    }

    /// Makes room for windows of another size, with zeros beside them.
    fn resize(&mut self, windows: &Windows) {
        let size = (windows.width(), windows.height());
        if (self.width, self.height) != size {
            (self.width, self.height) = size;
            let length = self.pitch() * self.height;
            refill(&mut self.under, length, 0);
            refill(&mut self.weights, length, [0; SIDE]);
        }
    }

    /// Returns the distance from one row to the next, in texels.
    fn pitch(&self) -> usize {
        self.width.max(SIDE) + 2
    }

    /// Transposes small windows, so that each lane's weights are adjacent. `counts` has the lanes with weights in each
    /// column and row.
    #[inline(always)]
    fn turn<S: Simd>(&mut self, simd: S, counts: [[u8; SIDE]; 2]) {
        let (pitch, size) = (self.pitch(), [self.width, self.height]);
        let mut all_under = [[0; SIDE]; SIDE];
        for (row, (under, weights)) in self.under.chunks_exact(pitch).zip(self.weights.chunks_exact(pitch)).enumerate()
        {
            all_under[row] = *under[1..].first_chunk().expect("a row has zeros beside");
            let lanes = turned(std::array::from_fn(|column| i16x8::load_array(simd, weights[column + 1])));
            for (lane, weights) in lanes.into_iter().enumerate() {
                weights.store_slice(&mut self.small[lane][row][MARGIN..][..SIDE]);
            }
        }
        // A window of whole pairs may reach one column further.
        self.shapes.find(simd, (&SMALL, 1), size, counts, &all_under);
    }

    /// Returns the index of the smallest small shape that holds a lane's window, and where the window begins.
    #[inline(always)]
    pub(crate) fn shape(&self, lane: usize) -> Option<(usize, Origin)> {
        let (index, [column, row]) = self.shapes.shape(lane)?;
        Some((index, Origin { column: column as isize, row }))
    }

    /// Returns whether all texels under the pixel of a lane's small window lie in the first [`COLUMNS_UNDER`] columns.
    #[inline(always)]
    pub(crate) fn are_marks_early(&self, lane: usize, origin: Origin) -> bool {
        texels_from(origin, self.shapes.columns_under(lane)) < 1 << COLUMNS_UNDER
    }

    /// Returns a bit for each texel of those columns, in a row of a lane's small window, that lies under the pixel.
    #[inline(always)]
    pub(crate) fn small_marks(&self, lane: usize, origin: Origin, row: usize) -> u8 {
        texels_from(origin, self.shapes.under(lane, origin.row + row)) as u8
    }

    /// Returns the weights of a lane's small window in pairs, row by row. Each row goes on with what follows the
    /// window.
    #[inline(always)]
    pub(crate) fn small_pairs(&self, lane: usize, origin: Origin) -> [[u32; SIDE / 2]; HIGHEST] {
        let first = (MARGIN as isize + origin.column) as usize % (SIDE + 1);
        let rows: &[_; HIGHEST] = self.small[lane][origin.row % SIDE..].first_chunk().expect("there are more rows");
        std::array::from_fn(|row| {
            let pairs = rows[row][first..][..SIDE].as_chunks().0;
            std::array::from_fn(|at| pair(pairs[at]))
        })
    }

    /// Returns the marks of a row of a lane's window, for at most 16 pairs.
    pub(crate) fn marks(&self, lane: usize, origin: Origin, row: usize, pairs: Range<usize>) -> u32 {
        let first = (origin.row + row) * self.pitch() + (origin.column + 1) as usize;
        let under = &self.under[first + 2 * pairs.start..first + 2 * pairs.end];
        under.iter().enumerate().fold(0, |marks, (at, lanes)| marks | (u32::from(lanes >> lane & 1) * mark(at)))
    }

    /// Returns the weights of a row of a lane's window, pair by pair.
    pub(crate) fn pairs(&self, lane: usize, origin: Origin, row: usize, pairs: usize) -> impl Iterator<Item = u32> {
        let first = (origin.row + row) * self.pitch() + (origin.column + 1) as usize;
        let weights = self.weights[first..][..2 * pairs].as_chunks().0;
        weights.iter().map(move |[a, b]| pair([a[lane], b[lane]]))
    }
}

/// Rounding of windows' weights, texel by texel. The rounding error of one texel is passed to the next, so that each
/// lane's sum is exactly one. The exception is a last weight of one, which 16 bits do not hold.
pub(crate) struct Rounding<S: Simd> {
    scale: f32,
    sums: f32x8<S>,
    before: i32x8<S>,
}

impl<S: Simd> Rounding<S> {
    /// Begins with the first texel; weights are scaled by this number of bits.
    #[inline(always)]
    pub(crate) fn new(simd: S, bits: u32) -> Self {
        let before = f32x8::splat(simd, ROUNDER).bitcast();
        Self { scale: (1 << bits) as f32, sums: f32x8::splat(simd, 0.0), before }
    }

    /// Rounds the next texel's weights.
    #[inline(always)]
    pub(crate) fn next(&mut self, simd: S, weights: &[f32; SIDE]) -> i16x8<S> {
        self.sums += f32x8::load_array_ref(simd, weights) * self.scale;
        let sum: i32x8<S> = (self.sums + ROUNDER).bitcast();
        let step = (sum - self.before).min(i32x8::splat(simd, i32::from(i16::MAX)));
        self.before += step;
        let (low, high) = step.split();
        low.relaxed_narrow(high)
    }
}

/// Converts bits of columns to bits of the texels of a window that begins at `origin`.
#[inline(always)]
fn texels_from(origin: Origin, columns: u8) -> u32 {
    u32::from(columns) << 1 >> (origin.column + 1)
}

/// Packs two weights into a number.
#[inline(always)]
fn pair([a, b]: [i16; 2]) -> u32 {
    u32::from(a as u16) | u32::from(b as u16) << 16
}

/// Fills a whole vector anew.
fn refill<T: Copy>(vector: &mut Vec<T>, length: usize, value: T) {
    vector.clear();
    vector.resize(length, value);
}

/// Transposes 8 × 8 numbers: the first row gets the first number of each row. Each of three steps interleaves every row
/// with the fourth row after it.
#[inline(always)]
pub(crate) fn turned<S: Simd>(mut rows: [i16x8<S>; SIDE]) -> [i16x8<S>; SIDE] {
    for _ in 0..3 {
        let zipped: [_; SIDE / 2] = std::array::from_fn(|at| rows[at].interleave(rows[at + SIDE / 2]));
        rows = std::array::from_fn(|at| if at % 2 == 0 { zipped[at / 2].0 } else { zipped[at / 2].1 });
    }
    rows
}

/// Returns the number of bits by which weights of this size are scaled, so that sums of products fit into 32.
pub(crate) fn scale(Size { largest, sum }: Size) -> Option<u32> {
    // Rounding may add one to a sum for each texel.
    const { assert!(3.9 * (1 << 14) as f64 + (LARGEST as f64) < (1 << 16) as f64) };
    if largest < 1.0 && sum < 1.9 {
        Some(15)
    } else if largest < 1.99 && sum < 3.9 {
        Some(14)
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use fearless_simd::dispatch;

    use super::*;
    use crate::filter::rim::simd_levels::levels;

    #[test]
    fn numbers_are_turned() {
        for level in levels() {
            let found = dispatch!(level, simd => {
                let row = |row: usize| i16x8::load_array(simd, std::array::from_fn(|column| (10 * row + column) as i16));
                turned(std::array::from_fn(row)).map(|row| row.to_array())
            });
            assert_eq!(found, std::array::from_fn(|row| std::array::from_fn(|column| (10 * column + row) as i16)));
        }
    }

    #[test]
    fn a_window_that_begins_earlier_has_its_marks_later() {
        let rounded = Rounded { shapes: LaneShapes::of_columns_under(0b1000), ..Rounded::default() };
        let are_early = |column: isize| rounded.are_marks_early(0, Origin { column, row: 0 });
        assert!(!are_early(-1) && are_early(0) && are_early(1));
    }
}
