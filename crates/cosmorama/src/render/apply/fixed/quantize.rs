//! Weights as integers, those of eight windows at once.

use std::ops::Range;

use fearless_simd::{Simd, f32x8, i16x8, i32x8, prelude::*};

use super::weights::{HIGHEST, PAIRS_UNDER, ROWS_UNDER, Shape, mark};
use crate::render::batch::window::{Size, Windows};
use crate::render::scan::tile::LARGEST;
use crate::render::scan::tile::SIDE;

/// The windows of a run before they are sorted by pixel. Bits of bytes are lanes, until they are turned.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rounded {
    pub(crate) width: usize,
    pub(crate) height: usize,
    /// By how many bits weights are scaled.
    pub(crate) bits: u32,
    /// Row by row, by lane. On both sides of each row stand zeros.
    weights: Vec<[i16; SIDE]>,
    /// In which lanes a texel lies under the pixel; the same zeros beside.
    under: Vec<u8>,
    /// Whether no window has more than [`SIDE`] columns or rows: then it is sorted by lane, too.
    is_small: bool,
    small: Small,
}

/// Of windows with eight columns and rows at most, by lane.
#[derive(Clone, Debug, Default)]
struct Small {
    /// The smallest of the small shapes that holds it, by its index, or a larger number.
    shapes: [i32; SIDE],
    /// In which column and row that begins: the only bit that is set.
    begin: [[i32; SIDE]; 2],
    /// The columns of the texels under the pixel, by row, and of all rows.
    under: [[u8; SIDE]; SIDE],
    columns_under: [u8; SIDE],
    /// The weights of a lane, by row, [`MARGIN`] zeros on either side; more rows than are written.
    weights: [[[i16; 2 * SIDE]; SIDE + HIGHEST]; SIDE],
}

/// Zeros on either side of a row of a small window.
const MARGIN: usize = SIDE / 2;

/// A number so large that what is added to it is rounded to an integer, which its last bits then hold.
const ROUNDER: f32 = 12_582_912.0;

/// Where a lane's window begins among those of a run, one to the left of them at the least.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Origin {
    pub(crate) column: isize,
    pub(crate) row: usize,
}

impl Rounded {
    /// Rounds the weights of all lanes; false if they are too large. What rounding takes from one texel the next one has: each
    /// lane's sum is exactly one, but where the last weight would be one itself, which 16 bits do not hold.
    #[inline(always)]
    pub(crate) fn fill<S: Simd>(&mut self, simd: S, windows: &Windows) -> bool {
        let Some(bits) = scale(windows.size()) else { return false };
        self.bits = bits;
        self.resize(windows);
        let (pitch, most) = (self.pitch(), i32x8::splat(simd, i32::from(i16::MAX)));
        let (mut columns, mut rows) = ([0; SIDE], [0; SIDE]);
        let scale = (1 << bits) as f32;
        let mut sums = f32x8::splat(simd, 0.0);
        let mut before: i32x8<S> = f32x8::splat(simd, ROUNDER).bitcast();
        let width = self.width;
        let weights = windows.weights().chunks_exact(width).zip(windows.under().chunks_exact(width));
        let into = self.weights.chunks_exact_mut(pitch).zip(self.under.chunks_exact_mut(pitch));
        for (row, ((into, under_into), (weights, under))) in into.zip(weights).enumerate() {
            let (into, under_into) = (&mut into[1..][..width], &mut under_into[1..][..width]);
            let mut in_row = 0;
            for column in 0..width {
                sums += f32x8::load_array(simd, weights[column]) * scale;
                let sum: i32x8<S> = (sums + ROUNDER).bitcast();
                let step = (sum - before).min(most);
                before += step;
                let (low, high) = step.split();
                into[column] = low.relaxed_narrow(high).to_array();
                under_into[column] = under[column];
                let counts = !(step.simd_eq(0).to_bitmask() as u8) | under[column];
                columns[column % SIDE] |= counts;
                in_row |= counts;
            }
            rows[row % SIDE] |= in_row;
        }
        self.is_small = self.width <= SIDE && self.height <= SIDE;
        if self.is_small {
            self.turn(simd, columns, rows);
        }
        true
    }

    /// Makes room for windows of another size, zeros beside.
    fn resize(&mut self, windows: &Windows) {
        let size = (windows.width(), windows.height());
        if (self.width, self.height) != size {
            (self.width, self.height) = size;
            let length = self.pitch() * self.height;
            refill(&mut self.under, length, 0);
            refill(&mut self.weights, length, [0; SIDE]);
        }
    }

    /// Numbers from one row to the next.
    fn pitch(&self) -> usize {
        self.width.max(SIDE) + 2
    }

    /// Sorts small windows by lane.
    #[inline(always)]
    fn turn<S: Simd>(&mut self, simd: S, columns: [u8; SIDE], rows: [u8; SIDE]) {
        let pitch = self.pitch();
        let Self { small, under, weights, .. } = self;
        let mut rows_under = [0; SIDE];
        for (row, (under, weights)) in under.chunks_exact(pitch).zip(weights.chunks_exact(pitch)).enumerate() {
            rows_under[row] = under.iter().fold(0, |all, lanes| all | lanes);
            small.under[row] = turned_bits(std::array::from_fn(|column| under[column + 1]));
            let lanes = turned(std::array::from_fn(|column| i16x8::load_array(simd, weights[column + 1])));
            for (lane, weights) in lanes.into_iter().enumerate() {
                weights.store_slice(&mut small.weights[lane][row][MARGIN..][..SIDE]);
            }
        }
        let all_rows = |all: [u8; SIDE], row: &[u8; SIDE]| std::array::from_fn(|lane| all[lane] | row[lane]);
        small.columns_under = small.under[..self.height].iter().fold([0; SIDE], all_rows);
        let columns_under = small.columns_under;
        self.find_shapes(simd, [turned_bits(columns), turned_bits(rows), columns_under, turned_bits(rows_under)]);
    }

    /// Finds the smallest of the small shapes that holds each lane's window, given in which columns and rows something counts, and in
    /// which columns and rows texels lie under the pixel. Where windows begin is told by a bit, so that no lane needs a branch.
    #[inline(always)]
    fn find_shapes<S: Simd>(&mut self, simd: S, counts: [[u8; SIDE]; 4]) {
        let [columns, rows, columns_under, under] = counts.map(|bits| i32x8::load_array(simd, bits.map(i32::from)));
        let (first_column, first_row) = ((columns & -columns).max(1), (rows & -rows).max(1));
        let none = i32x8::splat(simd, Shape::SMALL.len() as i32);
        // The first one that holds it is the last one that is looked at. Whatever the number of pairs, the same heights follow.
        let (mut narrowest, mut column) = (none, first_column);
        for (at, shape) in Shape::SMALL.iter().enumerate().step_by(Shape::HEIGHTS).rev() {
            let width = 2 * shape.pairs;
            if width <= self.width + 1 {
                let begin = first_column.min(1 << self.width.saturating_sub(width));
                let may_be_under = begin * ((1 << (2 * PAIRS_UNDER)) - 1);
                let holds =
                    columns.simd_le(first_column * ((1 << width) - 1)) & (columns_under & !may_be_under).simd_eq(0);
                narrowest = holds.select(i32x8::splat(simd, at as i32), narrowest);
                column = holds.select(begin, column);
            }
        }
        let (mut lowest, mut row) = (none, first_row);
        for (at, shape) in Shape::SMALL[..Shape::HEIGHTS].iter().enumerate().rev() {
            if shape.height <= self.height {
                let begin = first_row.min(1 << (self.height - shape.height));
                let may_be_under = begin * (((1 << ROWS_UNDER) - 1) << shape.under);
                let holds = rows.simd_le(first_row * ((1 << shape.height) - 1)) & (under & !may_be_under).simd_eq(0);
                lowest = holds.select(i32x8::splat(simd, at as i32), lowest);
                row = holds.select(begin, row);
            }
        }
        self.small.shapes = (narrowest + lowest).to_array();
        self.small.begin = [column.to_array(), row.to_array()];
    }

    /// The smallest of the small shapes that holds a lane's window, by its index, and where it begins.
    #[inline(always)]
    pub(crate) fn shape(&self, lane: usize) -> Option<(usize, Origin)> {
        let index = self.small.shapes[lane] as usize;
        let [column, row] = self.small.begin;
        let origin =
            Origin { column: column[lane].trailing_zeros() as isize, row: row[lane].trailing_zeros() as usize };
        (self.is_small && index < Shape::SMALL.len()).then_some((index, origin))
    }

    /// Whether all texels under the pixel of a lane's small window lie in the first [`PAIRS_UNDER`] pairs of their rows.
    #[inline(always)]
    pub(crate) fn are_marks_early(&self, lane: usize, origin: Origin) -> bool {
        texels_from(origin, self.small.columns_under[lane]) < 1 << (2 * PAIRS_UNDER)
    }

    /// Which texels of those pairs in a row of a lane's small window lie under the pixel, a bit for each.
    #[inline(always)]
    pub(crate) fn small_marks(&self, lane: usize, origin: Origin, row: usize) -> u8 {
        texels_from(origin, self.small.under[(origin.row + row) % SIDE][lane]) as u8
    }

    /// The weights of a lane's small window, row by row, pair by pair, and what follows.
    #[inline(always)]
    pub(crate) fn small_pairs(&self, lane: usize, origin: Origin) -> [[u32; SIDE / 2]; HIGHEST] {
        let first = (MARGIN as isize + origin.column) as usize % (SIDE + 1);
        let rows: &[_; HIGHEST] =
            self.small.weights[lane][origin.row % SIDE..].first_chunk().expect("there are more rows");
        std::array::from_fn(|row| {
            let pairs = rows[row][first..][..SIDE].as_chunks().0;
            std::array::from_fn(|at| pair(pairs[at]))
        })
    }

    /// The marks of a row of a lane's window, of 16 pairs at most.
    pub(crate) fn marks(&self, lane: usize, origin: Origin, row: usize, pairs: Range<usize>) -> u32 {
        let first = (origin.row + row) * self.pitch() + (origin.column + 1) as usize;
        let under = &self.under[first + 2 * pairs.start..first + 2 * pairs.end];
        under.iter().enumerate().fold(0, |marks, (at, lanes)| marks | (u32::from(lanes >> lane & 1) * mark(at)))
    }

    /// The weights of a row of a lane's window, pair by pair.
    pub(crate) fn pairs(&self, lane: usize, origin: Origin, row: usize, pairs: usize) -> impl Iterator<Item = u32> {
        let first = (origin.row + row) * self.pitch() + (origin.column + 1) as usize;
        let weights = self.weights[first..][..2 * pairs].as_chunks().0;
        weights.iter().map(move |[a, b]| pair([a[lane], b[lane]]))
    }
}

/// From columns to texels of a window that begins there, a bit for each.
#[inline(always)]
fn texels_from(origin: Origin, columns: u8) -> u32 {
    u32::from(columns) << 1 >> (origin.column + 1)
}

/// Two weights as a number.
#[inline(always)]
fn pair([a, b]: [i16; 2]) -> u32 {
    u32::from(a as u16) | u32::from(b as u16) << 16
}

/// Fills all of a vector anew.
fn refill<T: Copy>(vector: &mut Vec<T>, length: usize, value: T) {
    vector.clear();
    vector.resize(length, value);
}

/// Bits of eight bytes turned: the first of each in the first byte (Warren, Hacker's Delight, 7-3).
#[inline(always)]
pub(crate) fn turned_bits(bytes: [u8; SIDE]) -> [u8; SIDE] {
    let mut bits = u64::from_le_bytes(bytes);
    for (shift, mask) in [(7, 0x00aa_00aa_00aa_00aa), (14, 0x0000_cccc_0000_cccc), (28, 0x0000_0000_f0f0_f0f0)] {
        let changed = (bits ^ bits >> shift) & mask;
        bits ^= changed ^ changed << shift;
    }
    bits.to_le_bytes()
}

/// Eight times eight numbers turned: the first of each in the first. Three times each is zipped with the fourth after it.
#[inline(always)]
fn turned<S: Simd>(mut rows: [i16x8<S>; SIDE]) -> [i16x8<S>; SIDE] {
    for _ in 0..3 {
        let zipped: [_; SIDE / 2] = std::array::from_fn(|at| rows[at].interleave(rows[at + SIDE / 2]));
        rows = std::array::from_fn(|at| if at % 2 == 0 { zipped[at / 2].0 } else { zipped[at / 2].1 });
    }
    rows
}

/// By how many bits weights of this size are scaled, so that sums of products fit into 32.
fn scale(Size { largest, sum }: Size) -> Option<u32> {
    // To what they come to rounding may add one for each texel.
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
    fn bits_are_turned() {
        let bytes = [0x81, 0x02, 0xff, 0x00, 0x10, 0x7e, 0x55, 0xa0];
        let turned = turned_bits(bytes);
        for (row, byte) in bytes.iter().enumerate() {
            for (column, turned) in turned.iter().enumerate() {
                assert_eq!(byte >> column & 1, turned >> row & 1, "bit {column} of byte {row}");
            }
        }
    }

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

    /// Finds the shape of a window 6 texels wide and 4 high; `columns_under` marks columns with texels under the pixel.
    fn shape(columns_under: u8) -> Option<usize> {
        let mut found = levels().into_iter().map(|level| {
            let mut rounded = Rounded { width: 6, height: 4, is_small: true, ..Rounded::default() };
            let counts = [0b11_1111, 0b1111, columns_under, 0b0110].map(|bits| [bits; SIDE]);
            dispatch!(level, simd => rounded.find_shapes(simd, counts));
            rounded.shape(0).map(|(index, _)| index)
        });
        let first = found.next().expect("at least the plain one");
        assert!(found.all(|shape| shape == first));
        first
    }

    #[test]
    fn a_window_whose_last_texels_lie_under_the_pixel_is_no_small_one() {
        assert_eq!(shape(0b00_1100), Some(3));
        assert_eq!(shape(0b00_1111), Some(3));
        assert_eq!((shape(0b01_0000), shape(0b10_0100)), (None, None));
    }

    #[test]
    fn a_window_that_begins_earlier_has_its_marks_later() {
        let mut rounded = Rounded::default();
        rounded.small.columns_under = [0b1000; SIDE];
        let are_early = |column: isize| rounded.are_marks_early(0, Origin { column, row: 0 });
        assert!(!are_early(-1) && are_early(0) && are_early(1));
    }
}
