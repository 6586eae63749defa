use std::ops::Range;

use super::band::Run;
use super::mirrors::{MOST_IMAGES, MirrorImage, Mirrors, UPRIGHT};
use super::picture_part::PicturePart;
use super::prefetch::prefetch_lines;
use crate::resample::patch::SIDE;

/// What one band makes of a picture. What no pixel was made of is filled with a background at the end.
pub(super) struct Canvas<'a, P: Copy> {
    background: P,
    mirrors: &'a Mirrors,
    part: PicturePart<'a, P>,
    /// Which pixels of its own are made, row by row, a bit for each column: the same in all mirrors.
    made: Vec<u8>,
    /// What will be written where columns are rows.
    tile: Tile<P>,
}

/// Runs below each other, where mirrors show columns as rows: so many pixels lie beside each other there.
struct Tile<P> {
    /// Column and row of the first pixel.
    first: [usize; 2],
    rows: usize,
    /// For each of those mirrors, lane by lane, from left to right.
    pixels: [[[P; SIDE]; SIDE]; UPRIGHT],
}

impl<P: Copy> Drop for Canvas<'_, P> {
    fn drop(&mut self) {
        self.write_tile();
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

impl<'a, P: Copy> Canvas<'a, P> {
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
            let tile = Tile { first: [0; 2], rows: 0, pixels: [[[background; SIDE]; SIDE]; UPRIGHT] };
            Self { background, mirrors, part, made, tile }
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
        let (background, mirrors) = (self.background, self.mirrors);
        for (index, image) in mirrors.images.iter().enumerate() {
            if image.is_turned {
                // Not those of the patch on the diagonal.
                let others = columns.start.max(self.first_column(rows.start) + SIDE)..columns.end;
                for column in others {
                    lay(background, self.part.beside(index, [column, rows.start], rows.len()));
                }
            } else {
                for row in rows.clone() {
                    lay(background, self.part.beside(index, [columns.start, row], columns.len()));
                }
            }
        }
    }

    /// Writes the pixels of a run in each mirror, from left to right as that shows them; where it shows columns as rows, from the first
    /// to the last.
    #[inline(always)]
    pub(super) fn put(&mut self, run: &Run, pixels: &[[P; SIDE]; MOST_IMAGES]) {
        let images = self.images_of(run.pixel(0));
        if !run.is_whole() {
            for (index, (image, pixels)) in images.iter().zip(pixels).enumerate() {
                let last = if image.flips[0] && !image.is_turned { SIDE - 1 } else { 0 };
                for lane in run.lanes() {
                    *self.pixel(index, run.pixel(lane)) = pixels[(lane ^ last) % SIDE];
                }
            }
            return;
        }
        let pixel = run.pixel(0);
        self.note(pixel, u8::MAX);
        for (image, pixels) in pixels.iter().enumerate().take(images.len().min(UPRIGHT)) {
            self.part.beside(image, pixel, SIDE).copy_from_slice(pixels);
        }
        if images.len() == MOST_IMAGES {
            let turned = pixels.last_chunk().expect("mirrors that show columns as rows come last");
            self.put_turned(pixel, turned);
        }
    }

    /// The same where columns are rows, beside those of the run above.
    #[inline(always)]
    fn put_turned(&mut self, [column, row]: [usize; 2], pixels: &[[P; SIDE]; UPRIGHT]) {
        let Tile { first, rows, .. } = self.tile;
        if rows == SIDE || [first[0], first[1] + rows] != [column, row] {
            self.write_tile();
            self.tile.first = [column, row];
        }
        let at = self.tile.rows % SIDE;
        for (image, pixels) in pixels.iter().enumerate() {
            let at = if self.mirrors.turned()[image].flips[0] { SIDE - 1 - at } else { at };
            for (tile, pixel) in self.tile.pixels[image].iter_mut().zip(pixels) {
                tile[at] = *pixel;
            }
        }
        self.tile.rows += 1;
    }

    /// Writes what is in the tile, and empties it.
    fn write_tile(&mut self) {
        let (mirrors, rows) = (self.mirrors, std::mem::take(&mut self.tile.rows));
        if rows == 0 {
            return;
        }
        let [column, row] = self.tile.first;
        for (index, image) in mirrors.turned().iter().enumerate() {
            let columns = if image.flips[0] { SIDE - rows..SIDE } else { 0..rows };
            for lane in 0..SIDE {
                let pixels = self.tile.pixels[index][lane];
                let line = self.part.beside(UPRIGHT + index, [column + lane, row], rows);
                // As many as there mostly are come without a call.
                match line.first_chunk_mut::<SIDE>() {
                    Some(line) => *line = pixels,
                    None => line.copy_from_slice(&pixels[columns.clone()]),
                }
            }
        }
    }

    /// Asks for the memory that the pixels of whole runs will be written to: a line of it that is not at hand is waited for even so.
    /// Other runs are few, and have no place for eight pixels in each mirror.
    #[inline(always)]
    pub(super) fn prefetch(&mut self, runs: &[Run]) {
        let mut is_first = true;
        for run in runs.iter().filter(|run| run.is_whole()) {
            let [_, row] = run.pixel(0);
            for (index, image) in self.images_of(run.pixel(0)).iter().enumerate() {
                if !image.is_turned {
                    prefetch_lines(self.part.beside(index, run.pixel(0), SIDE), 0, SIDE as u32 - 1);
                } else if is_first {
                    // What the first run of a patch and those below it are written to.
                    let rows = (SIDE - row % SIDE).min(self.part.rows() - row);
                    for lane in 0..SIDE {
                        prefetch_lines(self.part.beside(index, run.pixel(lane), rows), 0, rows as u32 - 1);
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

/// Fills pixels, eight at a time: one by one three bytes are slow.
fn lay<P: Copy>(background: P, pixels: &mut [P]) {
    let (eights, others) = pixels.as_chunks_mut::<SIDE>();
    eights.fill([background; SIDE]);
    others.fill(background);
}

/// Bytes of bits for so many columns, and one more, which eight of them that begin within a byte may reach.
const fn bytes_of(columns: usize) -> usize {
    columns.div_ceil(8) + 1
}
