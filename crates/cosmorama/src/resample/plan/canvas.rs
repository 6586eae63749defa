use std::ops::Range;

use bytemuck::NoUninit;

use super::band::Run;
use super::mirrors::{MOST_IMAGES, MirrorImage, Mirrors, UPRIGHT};
use super::patch_pixels::PatchPixels;
use super::picture_part::PicturePart;
use super::prefetch::LINE;
use crate::resample::patch::SIDE;

/// What one band makes of a picture. What no pixel was made of is filled with a background at the end.
pub(super) struct Canvas<'a, P: NoUninit> {
    background: [P; MANY],
    mirrors: &'a Mirrors,
    part: PicturePart<'a, P>,
    /// Which pixels of its own are made, row by row, a bit for each column: the same in all mirrors.
    made: Vec<u8>,
    pixels: PatchPixels<P>,
}

/// Pixels of the background that are laid at once: one by one three bytes are slow.
const MANY: usize = 8 * SIDE;

impl<P: NoUninit> Drop for Canvas<'_, P> {
    fn drop(&mut self) {
        for top in (0..self.part.rows()).step_by(SIDE) {
            self.fill_patches(top);
        }
        for row in 0..self.part.rows() {
            let mut column = self.first_column(row);
            while let Some(gap) = self.gap(row, column) {
                column = gap.end;
                self.fill(row..row + 1, gap);
            }
        }
    }
}

impl<'a, P: NoUninit> Canvas<'a, P> {
    /// Cuts a picture, `width` pixels wide, into what bands of `rows` rows make, from the top one on.
    pub(super) fn bands(
        pixels: &'a mut [P],
        width: usize,
        rows: usize,
        mirrors: &'a Mirrors,
        background: P,
    ) -> Vec<Self> {
        let canvas = |part: PicturePart<'a, P>| {
            let made = vec![0; part.rows() * bytes_of(mirrors.columns)];
            let (background, pixels) = ([background; MANY], PatchPixels::filled(background));
            Self { background, mirrors, part, made, pixels }
        };
        PicturePart::all(pixels, width, rows, mirrors).into_iter().map(canvas).collect()
    }

    /// Notes pixels of a row as made: eight from this column on, those whose bits are set.
    #[inline(always)]
    fn note(&mut self, [column, row]: [usize; 2], lanes: u8) {
        let at = row * bytes_of(self.mirrors.columns) + column / 8;
        let [low, high] = (u16::from(lanes) << (column % 8)).to_le_bytes();
        self.made[at] |= low;
        self.made[at + 1] |= high;
    }

    /// The first column of a row that it makes itself.
    fn first_column(&self, row: usize) -> usize {
        self.part.columns().start + self.mirrors.first_column(row / SIDE * SIDE)
    }

    /// The next columns of a row, from this one on, of which no pixel is made.
    fn gap(&self, row: usize, from: usize) -> Option<Range<usize>> {
        let (columns, bytes) = (self.mirrors.columns, bytes_of(self.mirrors.columns));
        let made = &self.made[row * bytes..][..bytes];
        let next = |from: usize, is_made: bool| {
            let whole = if is_made { 0 } else { u8::MAX };
            let mut column = from;
            while column < columns && (made[column / 8] >> (column % 8) & 1 == 1) != is_made {
                // Whole bytes of the others are passed over at once.
                column = if column.is_multiple_of(8) && made[column / 8] == whole { column + 8 } else { column + 1 };
            }
            column.min(columns)
        };
        let start = next(from, false);
        (start < columns).then(|| start..next(start, true))
    }

    /// Fills patches of which no pixel is made, from this row on: in one go, where a mirror shows their columns as rows.
    fn fill_patches(&mut self, top: usize) {
        let bytes = bytes_of(self.mirrors.columns);
        let rows = top..self.part.rows().min(top + SIDE);
        let is_empty = |made: &[u8], byte: usize| rows.clone().all(|row| made[row * bytes + byte] == 0);
        let patches = self.mirrors.columns.div_ceil(SIDE);
        let mut patch = self.first_column(top) / SIDE;
        while patch < patches {
            let first = patch;
            while patch < patches && is_empty(&self.made, patch) {
                rows.clone().for_each(|row| self.made[row * bytes + patch] = u8::MAX);
                patch += 1;
            }
            if first < patch {
                self.fill(rows.clone(), first * SIDE..self.mirrors.columns.min(patch * SIDE));
            }
            patch += 1;
        }
    }

    /// The mirrors that show a pixel of the band.
    #[inline(always)]
    pub(super) fn images_of(&self, [column, row]: [usize; 2]) -> &'a [MirrorImage] {
        // With diagonals the first row has the number of the first column; without, any does.
        self.mirrors.images_of([column, self.part.columns().start + row])
    }

    /// Fills columns of some rows of a patch with the background, in all mirrors.
    fn fill(&mut self, rows: Range<usize>, columns: Range<usize>) {
        for (index, image) in self.mirrors.images.iter().enumerate() {
            if image.is_turned {
                // Not those of the patch on the diagonal.
                let others = columns.start.max(self.first_column(rows.start) + SIDE)..columns.end;
                for column in others {
                    lay(&self.background, self.part.beside(index, [column, rows.start], rows.len()));
                }
            } else {
                for row in rows.clone() {
                    lay(&self.background, self.part.beside(index, [columns.start, row], columns.len()));
                }
            }
        }
    }

    /// Where to make the pixels of a group, before they are [`put`](Self::put) where they belong.
    #[inline(always)]
    pub(super) fn pixels(&mut self) -> &mut PatchPixels<P> {
        &mut self.pixels
    }

    /// Puts the pixels of a group where each mirror shows them.
    pub(super) fn put(&mut self, group: &[Run]) {
        let Some(first) = group.first() else { return };
        // The same of all the patch.
        let images = self.images_of(first.pixel(0));
        for run in group {
            if run.is_whole() {
                self.put_row(run, images.len());
            } else {
                self.put_lanes(run, images);
            }
        }
        if images.len() == MOST_IMAGES {
            let follow = |above: &Run, below: &Run| {
                let ([_, row], [_, next]) = (above.pixel(0), below.pixel(0));
                above.is_whole() && below.is_whole() && next == row + 1
            };
            group.chunk_by(follow).filter(|rows| rows[0].is_whole()).for_each(|rows| self.put_turned(rows));
        }
    }

    /// Puts a row of a patch where it is a row; that is in the first of so many mirrors.
    fn put_row(&mut self, run: &Run, images: usize) {
        let pixel = run.pixel(0);
        self.note(pixel, u8::MAX);
        for (image, rows) in self.pixels.upright.iter().enumerate().take(images) {
            self.part.write(image, pixel, &rows[run.row_in_patch()]);
        }
    }

    /// Puts rows of a patch below each other where columns are rows.
    fn put_turned(&mut self, runs: &[Run]) {
        let (pixel, first) = (runs[0].pixel(0), runs[0].row_in_patch());
        for (index, image) in self.mirrors.turned().iter().enumerate() {
            let after = first + runs.len();
            let made = if image.flips[0] { SIDE - after..SIDE - first } else { first..after };
            for (lane, pixels) in self.pixels.turned[index].iter().enumerate() {
                let (image, pixel) = (UPRIGHT + index, [pixel[0] + lane, pixel[1]]);
                // As many as there mostly are come without a call.
                if runs.len() == SIDE {
                    self.part.write(image, pixel, pixels);
                } else {
                    self.part.write(image, pixel, &pixels[made.clone()]);
                }
            }
        }
    }

    /// Puts those pixels of a row that are made.
    fn put_lanes(&mut self, run: &Run, images: &[MirrorImage]) {
        for (index, image) in images.iter().enumerate() {
            let flip = if image.flips[0] { SIDE - 1 } else { 0 };
            for lane in run.lanes() {
                let pixel = *self.pixels.pixel(index, [lane, run.row_in_patch()], flip);
                *self.pixel(index, run.pixel(lane)) = pixel;
            }
        }
    }

    /// Asks for the memory that the pixels of whole runs will be written to: a line of it that is not at hand is waited for even so.
    /// Other runs are few, and have no place for eight pixels in each mirror.
    #[inline(always)]
    pub(super) fn prefetch(&self, runs: &[Run]) {
        // The last pixel in each line: the first line is that of the last pixel before, too, or else has one of these.
        let step = const { if LINE < size_of::<[P; SIDE]>() { LINE / size_of::<P>() } else { SIDE } };
        let mut is_first = true;
        for run in runs.iter().filter(|run| run.is_whole()) {
            let [column, row] = run.pixel(0);
            for (index, image) in self.images_of([column, row]).iter().enumerate() {
                if !image.is_turned {
                    for across in (step - 1..SIDE).step_by(step) {
                        self.part.prefetch(index, [column + across, row]);
                    }
                } else if is_first {
                    // What the first run of a patch and those below it are written to.
                    for across in 0..SIDE {
                        self.part.prefetch(index, [column + across, row]);
                        for down in (step - 1..SIDE).step_by(step) {
                            self.part.prefetch(index, [column + across, row + down]);
                        }
                    }
                }
            }
            is_first = false;
        }
    }

    /// The pixel that a mirror shows in place of the one in this column and row of the band.
    #[inline(always)]
    pub(super) fn pixel(&mut self, image: usize, pixel: [usize; 2]) -> &mut P {
        if image == 0 {
            self.note(pixel, 1);
        }
        &mut self.part.beside(image, pixel, 1)[0]
    }
}

/// Fills pixels. From memory: as a number that is known, the background would be written byte by byte.
fn lay<P: Copy>(background: &[P; MANY], pixels: &mut [P]) {
    let (many, few) = pixels.as_chunks_mut();
    many.fill(*background);
    let (eights, others) = few.as_chunks_mut::<SIDE>();
    let (eight, _) = background.as_chunks();
    eights.fill(eight[0]);
    others.fill(background[0]);
}

/// Bytes of bits for so many columns, and one more, which eight of them that begin within a byte may reach.
const fn bytes_of(columns: usize) -> usize {
    columns.div_ceil(8) + 1
}
