use fearless_simd::{Simd, i32x8, prelude::*};

use crate::render::plan::window_format::{COLUMNS_UNDER, ROWS_UNDER, Shape, SmallShapes};
use crate::render::scan::tile::SIDE;

/// Smallest of the small shapes that holds each lane's window, for windows with at most [`SIDE`] columns and rows.
#[derive(Clone, Debug, Default)]
pub(crate) struct LaneShapes {
    /// Index of the shape; a larger number if none holds the window.
    shapes: [i32; SIDE],
    /// Column and row at which the shape begins, each as the only bit that is set.
    begin: [[i32; SIDE]; 2],
    /// Bits of the columns with texels under the pixel, for each row, and for all rows together.
    under: [[u8; SIDE]; SIDE],
    columns_under: [u8; SIDE],
}

impl LaneShapes {
    /// Clears all shapes, for windows that are not small.
    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        self.shapes = [i32::MAX; SIDE];
    }

    /// Returns shapes whose texels under the pixel lie in these columns.
    #[cfg(test)]
    pub(crate) fn of_columns_under(columns: u8) -> Self {
        Self { columns_under: [columns; SIDE], ..Self::default() }
    }

    /// Finds the shapes for windows with this number of columns and rows, followed by `beyond` empty columns.
    ///
    /// Each bit is a lane. `counts` has the lanes with weights in each column and row. `under` has the lanes in which
    /// each texel of a row lies under the pixel.
    #[inline(always)]
    pub(crate) fn find<S: Simd>(
        &mut self,
        simd: S,
        (small, beyond): (&SmallShapes, usize),
        size: [usize; 2],
        counts: [[u8; SIDE]; 2],
        under: &[[u8; SIDE]; SIDE],
    ) {
        let (mut rows_under, mut columns_under) = ([0; SIDE], [0; SIDE]);
        for (row, lanes) in under.iter().enumerate() {
            rows_under[row] = lanes.iter().fold(0, |all, lanes| all | lanes);
            self.under[row] = turned_bits(*lanes);
            for (all, columns) in columns_under.iter_mut().zip(self.under[row]) {
                *all |= columns;
            }
        }
        self.columns_under = columns_under;
        let [columns, rows] = counts.map(turned_bits);
        self.search(simd, (small, beyond), size, [columns, rows, columns_under, turned_bits(rows_under)]);
    }

    /// Searches the shapes, given the columns and rows with weights, and those with texels under the pixel. A bit marks
    /// where a window begins, so that no lane needs a branch.
    #[inline(always)]
    fn search<S: Simd>(
        &mut self,
        simd: S,
        (small, beyond): (&SmallShapes, usize),
        [all_columns, all_rows]: [usize; 2],
        counts: [[u8; SIDE]; 4],
    ) {
        let [columns, rows, columns_under, under] = counts.map(|bits| i32x8::load_array(simd, bits.map(i32::from)));
        let (first_column, first_row) = ((columns & -columns).max(1), (rows & -rows).max(1));
        let none = i32x8::splat(simd, small.len() as i32);
        // Searched backwards, so that the first width that fits wins. The same heights follow each width.
        let (mut narrowest, mut column) = (none, first_column);
        for (at, Shape { width, .. }) in small.iter().enumerate().step_by(Shape::HEIGHTS).rev() {
            if *width <= all_columns + beyond {
                let begin = first_column.min(1 << all_columns.saturating_sub(*width));
                let may_be_under = begin * ((1 << COLUMNS_UNDER) - 1);
                let holds =
                    columns.simd_le(first_column * ((1 << width) - 1)) & (columns_under & !may_be_under).simd_eq(0);
                narrowest = holds.select(i32x8::splat(simd, at as i32), narrowest);
                column = holds.select(begin, column);
            }
        }
        let (mut lowest, mut row) = (none, first_row);
        for (at, shape) in small[..Shape::HEIGHTS].iter().enumerate().rev() {
            if shape.height <= all_rows {
                let begin = first_row.min(1 << (all_rows - shape.height));
                let may_be_under = begin * (((1 << ROWS_UNDER) - 1) << shape.under);
                let holds = rows.simd_le(first_row * ((1 << shape.height) - 1)) & (under & !may_be_under).simd_eq(0);
                lowest = holds.select(i32x8::splat(simd, at as i32), lowest);
                row = holds.select(begin, row);
            }
        }
        self.shapes = (narrowest + lowest).to_array();
        self.begin = [column.to_array(), row.to_array()];
    }

    /// Returns the index of a lane's shape, and the column and row where it begins.
    #[inline(always)]
    pub(crate) fn shape(&self, lane: usize) -> Option<(usize, [usize; 2])> {
        let index = self.shapes[lane] as usize;
        let begin = self.begin.map(|begin| begin[lane].trailing_zeros() as usize);
        (index < 2 * Shape::HEIGHTS).then_some((index, begin))
    }

    /// Returns the columns of a lane's texels under the pixel in a row, a bit for each.
    #[inline(always)]
    pub(crate) fn under(&self, lane: usize, row: usize) -> u8 {
        self.under[row % SIDE][lane]
    }

    /// Returns the columns of a lane's texels under the pixel in all rows, a bit for each.
    #[inline(always)]
    pub(crate) fn columns_under(&self, lane: usize) -> u8 {
        self.columns_under[lane]
    }
}

/// Transposes the bits of eight bytes (Warren, Hacker's Delight, 7-3). The first byte gets the first bit of each.
#[inline(always)]
pub(crate) fn turned_bits(bytes: [u8; SIDE]) -> [u8; SIDE] {
    let mut bits = u64::from_le_bytes(bytes);
    for (shift, mask) in [(7, 0x00aa_00aa_00aa_00aa), (14, 0x0000_cccc_0000_cccc), (28, 0x0000_0000_f0f0_f0f0)] {
        let changed = (bits ^ bits >> shift) & mask;
        bits ^= changed ^ changed << shift;
    }
    bits.to_le_bytes()
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

    /// Returns the shape of a window 6 texels wide and 4 high; `columns_under` marks columns with texels under the
    /// pixel.
    fn shape(columns_under: u8) -> Option<usize> {
        let mut found = levels().into_iter().map(|level| {
            let mut shapes = LaneShapes::default();
            let counts = [0b11_1111, 0b1111, columns_under, 0b0110].map(|bits| [bits; SIDE]);
            dispatch!(level, simd => shapes.search(simd, (&Shape::small([4, 6]), 0), [6, 4], counts));
            shapes.shape(0).map(|(index, _)| index)
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
}
