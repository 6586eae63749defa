use super::band::Run;
use super::mirrors::{MirrorImage, Mirrors};
use crate::resample::patch::SIDE;

/// Columns that are filled at once: about those of a tile.
const COLUMNS: usize = 8 * SIDE;

/// The rows of a picture that one band makes: its own, and those that mirror it from below. All of them are filled with a
/// background, each shortly before its pixels are made, so that it is still at hand then; the rest at the end.
pub(super) struct Canvas<'a, P: Copy> {
    width: usize,
    background: P,
    /// How many columns are to be made, and how many of them are filled, in all mirrors.
    columns: usize,
    filled: usize,
    own: &'a mut [P],
    mirrored: &'a mut [P],
}

impl<P: Copy> Drop for Canvas<'_, P> {
    fn drop(&mut self) {
        self.fill(self.columns);
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
        own.zip(below).map(move |(own, mirrored)| Self { width, background, columns, filled: 0, own, mirrored })
    }

    /// Fills columns as far as this one is among them.
    #[inline(always)]
    fn reach(&mut self, column: usize) {
        if column >= self.filled {
            self.fill((column + 1).next_multiple_of(COLUMNS).min(self.columns));
        }
    }

    /// Fills so many columns, in all mirrors.
    #[inline(never)]
    fn fill(&mut self, columns: usize) {
        let (from, to) = (self.filled, columns);
        self.filled = columns;
        for rows in [&mut *self.own, &mut *self.mirrored] {
            for row in rows.chunks_exact_mut(self.width) {
                row[from..to].fill(self.background);
                if self.columns < self.width {
                    row[self.width - to..self.width - from].fill(self.background);
                }
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
        self.reach(column + SIDE - 1);
        let column = if image.flips[0] { self.width - SIDE - column } else { column };
        let (rows, row) = if image.flips[1] {
            let last = self.mirrored.len() / self.width - 1;
            (&mut *self.mirrored, last - row)
        } else {
            (&mut *self.own, row)
        };
        rows[row * self.width + column..][..SIDE].copy_from_slice(pixels);
    }

    /// The pixel that a mirror image shows in place of the one in this column and row of the band.
    #[inline(always)]
    pub(super) fn pixel(&mut self, image: &MirrorImage, [column, row]: [usize; 2]) -> &mut P {
        self.reach(column);
        let column = if image.flips[0] { self.width - 1 - column } else { column };
        if image.flips[1] {
            let rows = self.mirrored.len() / self.width;
            &mut self.mirrored[(rows - 1 - row) * self.width + column]
        } else {
            &mut self.own[row * self.width + column]
        }
    }
}
