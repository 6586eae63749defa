use std::ops::Range;

use super::band::Run;
use super::mirrors::{MirrorImage, Mirrors};
use super::prefetch::prefetch_lines;
use crate::resample::patch::SIDE;

/// The rows of a picture that one band makes: its own, and those that mirror it from below. What no pixel was made of is filled
/// with a background at the end.
pub(super) struct Canvas<'a, P: Copy> {
    width: usize,
    background: P,
    /// How many columns are to be made, and which pixels of them are, row by row, a bit for each: the same in all mirrors.
    columns: usize,
    made: Vec<u8>,
    own: &'a mut [P],
    mirrored: &'a mut [P],
}

impl<P: Copy> Drop for Canvas<'_, P> {
    fn drop(&mut self) {
        for row in 0..self.own.len() / self.width {
            let mut column = 0;
            while let Some(gap) = self.gap(row, column) {
                column = gap.end;
                self.fill(row, gap);
            }
        }
    }
}

impl<'a, P: Copy> Canvas<'a, P> {
    /// Cuts a picture, `width` pixels wide, into what bands of `rows` rows make.
    pub(super) fn bands(
        pixels: &'a mut [P],
        width: usize,
        rows: usize,
        mirrors: &Mirrors,
        background: P,
    ) -> impl rayon::iter::IndexedParallelIterator<Item = Self>
    where
        P: Send + Sync,
    {
        use rayon::prelude::*;
        let (own, mirrored) = pixels.split_at_mut(mirrors.rows * width);
        // Below, the rows of the first band are the last ones; where nothing is mirrored there is nothing.
        // A picture without columns has no bands.
        let chunk = (rows * width).max(1);
        let own = own.par_chunks_mut(chunk);
        let bands = own.len();
        let mut below: Vec<&mut [P]> = mirrored.rchunks_mut(chunk).collect();
        below.resize_with(bands, Default::default);
        let columns = mirrors.columns;
        own.zip(below).map(move |(own, mirrored)| {
            let made = vec![0; own.len() / width * bytes_of(columns)];
            Self { width, background, columns, made, own, mirrored }
        })
    }

    /// Notes pixels of a row as made: eight from this column on, those whose bits are set.
    #[inline(always)]
    fn note(&mut self, [column, row]: [usize; 2], lanes: u8) {
        let at = row * bytes_of(self.columns) + column / 8;
        let [low, high] = (u16::from(lanes) << (column % 8)).to_le_bytes();
        self.made[at] |= low;
        self.made[at + 1] |= high;
    }

    /// The next columns of a row, from this one on, of which no pixel is made.
    fn gap(&self, row: usize, from: usize) -> Option<Range<usize>> {
        let bytes = bytes_of(self.columns);
        let made = &self.made[row * bytes..][..bytes];
        let next = |from: usize, is_made: bool| {
            let whole = if is_made { 0 } else { u8::MAX };
            let mut column = from;
            while column < self.columns && (made[column / 8] >> (column % 8) & 1 == 1) != is_made {
                // Whole bytes of the others are passed over at once.
                column = if column.is_multiple_of(8) && made[column / 8] == whole { column + 8 } else { column + 1 };
            }
            column.min(self.columns)
        };
        let start = next(from, false);
        (start < self.columns).then(|| start..next(start, true))
    }

    /// Fills columns of a row with the background, in all mirrors.
    fn fill(&mut self, row: usize, columns: Range<usize>) {
        let Self { width, background, .. } = *self;
        let mirrored = width - columns.end..width - columns.start;
        let below = (self.mirrored.len() / width).checked_sub(1 + row);
        let rows = [(&mut *self.own, Some(row)), (&mut *self.mirrored, below)];
        for (rows, row) in rows {
            let Some(row) = row else { continue };
            let row = &mut rows[row * width..][..width];
            row[columns.clone()].fill(background);
            if self.columns < width {
                row[mirrored.clone()].fill(background);
            }
        }
    }

    /// Writes the pixels of a run, from left to right as a mirror image shows them.
    #[inline(always)]
    pub(super) fn put(&mut self, image: &MirrorImage, run: &Run, pixels: &[P; SIDE]) {
        if !run.is_whole() {
            for lane in run.lanes() {
                *self.pixel(image, run.pixel(lane)) = pixels[if image.flips[0] { SIDE - 1 - lane } else { lane }];
            }
            return;
        }
        let [column, row] = run.pixel(0);
        if image.flips == [false; 2] {
            self.note([column, row], u8::MAX);
        }
        let (rows, first) = self.place(image, [column, row], SIDE);
        rows[first..][..SIDE].copy_from_slice(pixels);
    }

    /// Asks for the memory that the pixels of whole runs will be written to: a line of it that is not at hand is waited for even so.
    /// Other runs are few, and have no place for eight pixels in each mirror.
    #[inline(always)]
    pub(super) fn prefetch(&mut self, mirrors: &Mirrors, runs: &[Run]) {
        for run in runs {
            if !run.is_whole() {
                continue;
            }
            for image in &mirrors.images {
                let (rows, first) = self.place(image, run.pixel(0), SIDE);
                prefetch_lines(rows, first as u32, SIDE as u32 - 1);
            }
        }
    }

    /// The pixel that a mirror image shows in place of the one in this column and row of the band.
    #[inline(always)]
    pub(super) fn pixel(&mut self, image: &MirrorImage, pixel: [usize; 2]) -> &mut P {
        if image.flips == [false; 2] {
            self.note(pixel, 1);
        }
        let (rows, at) = self.place(image, pixel, 1);
        &mut rows[at]
    }

    /// Where a mirror image shows so many pixels from this column and row of the band on: the first of them among those of some rows.
    #[inline(always)]
    fn place(&mut self, image: &MirrorImage, [column, row]: [usize; 2], count: usize) -> (&mut [P], usize) {
        let column = if image.flips[0] { self.width - count - column } else { column };
        if image.flips[1] {
            let rows = self.mirrored.len() / self.width;
            (&mut *self.mirrored, (rows - 1 - row) * self.width + column)
        } else {
            (&mut *self.own, row * self.width + column)
        }
    }
}

/// Bytes of bits for so many columns, and one more, which eight of them that begin within a byte may reach.
const fn bytes_of(columns: usize) -> usize {
    columns.div_ceil(8) + 1
}
