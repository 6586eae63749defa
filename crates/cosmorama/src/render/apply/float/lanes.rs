use std::ops::Range;

use fearless_simd::{Simd, f32x8, prelude::*};

use super::shape::{BLOCK, ROWS_UNDER, Small};
use crate::render::apply::fixed::quantize::turned_bits;
use crate::render::batch::window::Windows;
use crate::render::scan::tile::SIDE;

/// What windows of a run hold, pixel by pixel: of windows with no more than [`SIDE`] columns and rows. Bits are columns or rows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lanes {
    width: usize,
    height: usize,
    /// The columns and rows with a weight or a texel under the pixel.
    columns: [u8; SIDE],
    rows: [u8; SIDE],
    /// The rows with a texel under the pixel, and its columns in each.
    rows_under: [u8; SIDE],
    under: [[u8; SIDE]; SIDE],
}

impl Lanes {
    /// `None` if windows are larger.
    #[inline(always)]
    pub(crate) fn of<S: Simd>(simd: S, windows: &Windows) -> Option<Self> {
        let (width, height) = (windows.width(), windows.height());
        if width == 0 || width > SIDE || height > SIDE {
            return None;
        }
        // Bits of bytes are lanes, until they are turned.
        let (mut columns, mut rows, mut rows_under) = ([0; SIDE], [0; SIDE], [0; SIDE]);
        let mut under = [[0; SIDE]; SIDE];
        let all = windows.weights().chunks_exact(width).zip(windows.under().chunks_exact(width));
        for (row, (weights, lanes)) in all.enumerate() {
            let mut in_row = [0; SIDE];
            let (mut any, mut any_under) = (0, 0);
            for (column, (weights, &lanes)) in weights.iter().zip(lanes).enumerate() {
                let counts = !(f32x8::load_array_ref(simd, weights).simd_eq(0.0).to_bitmask() as u8) | lanes;
                columns[column % SIDE] |= counts;
                in_row[column % SIDE] = lanes;
                any |= counts;
                any_under |= lanes;
            }
            rows[row % SIDE] = any;
            rows_under[row % SIDE] = any_under;
            under[row % SIDE] = turned_bits(in_row);
        }
        let [columns, rows, rows_under] = [columns, rows, rows_under].map(turned_bits);
        Some(Self { width, height, columns, rows, rows_under, under })
    }

    /// The smallest of the small sizes that holds a lane's window, by its index, and the column and row where it begins.
    #[inline(always)]
    pub(crate) fn small(&self, lane: usize) -> Option<(usize, [usize; 2])> {
        let [columns, rows, rows_under] = [self.columns, self.rows, self.rows_under].map(|bits| span(bits[lane]));
        let columns_under = span(self.under.iter().fold(0, |all, row| all | row[lane]));
        let column_of = |Small { shape, .. }: &Small| {
            let column = first(&columns, shape.width, self.width)?;
            (columns_under.end <= column + BLOCK).then_some(column)
        };
        let row_of = |Small { shape, under }: &Small| {
            let row = first(&rows, shape.height, self.height)?;
            let may_be = row + under..row + under + ROWS_UNDER;
            (may_be.start <= rows_under.start && rows_under.end <= may_be.end).then_some(row)
        };
        // Whatever the width, the same heights follow.
        let widths = Small::ALL.chunks(Small::HEIGHTS).enumerate();
        let (narrowest, column) = widths.filter_map(|(at, all)| Some((at, column_of(&all[0])?))).next()?;
        let heights = Small::ALL[..Small::HEIGHTS].iter().enumerate();
        let (lowest, row) = heights.filter_map(|(at, small)| Some((at, row_of(small)?))).next()?;
        Some((narrowest * Small::HEIGHTS + lowest, [column, row]))
    }

    /// The marks of a lane's small window that begins in this column and row.
    #[inline(always)]
    pub(crate) fn marks(&self, lane: usize, [column, row]: [usize; 2], small: &Small) -> u32 {
        (0..ROWS_UNDER).fold(0, |marks, at| {
            let columns = u32::from(self.under[(row + small.under + at) % SIDE][lane]) >> column;
            marks | (columns & ((1 << BLOCK) - 1)) << (BLOCK * at)
        })
    }
}

/// Where so many columns, or rows, begin that hold these, among all there are.
#[inline(always)]
fn first(held: &Range<usize>, length: usize, all: usize) -> Option<usize> {
    let first = held.start.min(all.checked_sub(length)?);
    (held.end <= first + length).then_some(first)
}

/// From the first bit to the last.
#[inline(always)]
fn span(bits: u8) -> Range<usize> {
    bits.trailing_zeros() as usize % 8..8 - bits.leading_zeros() as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_span_from_the_first_to_the_last() {
        assert_eq!([0, 1, 0x80, 0x3c].map(span), [0..0, 0..1, 7..8, 2..6]);
    }
}
