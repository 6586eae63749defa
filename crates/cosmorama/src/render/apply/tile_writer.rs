use std::ops::Range;

use bytemuck::NoUninit;

use super::output_region::PicturePart;
use crate::render::plan::span::Run;
use crate::render::plan::symmetry::{MirrorImage, Mirrors, TOGETHER, UPRIGHT, Ways};
use crate::render::plan::traversal::Pass;
use crate::render::scan::tile::SIDE;

/// Light of a pass's windows, by run, lane and mirror image. Mirror images are in the order of the view's traversals,
/// from the pass's first one on. Where there is no window, values are arbitrary.
pub(crate) type GroupLight<L> = [[[L; TOGETHER]; SIDE]; SIDE];

/// Conversion of windows' light to pixels.
pub(crate) trait Develop {
    type Light: Copy;
    type Pixel: NoUninit;

    /// Returns the pixel of a window's light.
    fn one(&self, light: Self::Light) -> Self::Pixel;

    /// Returns the pixels of eight windows at once, which is how most pixels are made.
    fn eight(&self, light: [&Self::Light; SIDE]) -> [Self::Pixel; SIDE];
}

/// Part of a picture that one band makes. Pixels that were not made are filled with a background at the end.
pub(crate) struct Canvas<'a, P: NoUninit> {
    background: [P; MANY],
    mirrors: &'a Mirrors,
    part: PicturePart<'a, P>,
    /// Bits of the band's own pixels that are made, row by row, one for each column. They hold for all mirror images.
    made: Vec<u8>,
    /// Whether all of the picture is background to begin with.
    is_blank: bool,
}

/// Number of background pixels that are written at once. Three bytes at a time would be slow.
const MANY: usize = 8 * SIDE;

impl<P: NoUninit> Drop for Canvas<'_, P> {
    fn drop(&mut self) {
        if self.is_blank {
            return;
        }
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
    /// Divides a picture, `width` pixels wide, into the parts that bands of `rows` rows make, from the top one on.
    pub(crate) fn bands(
        pixels: &'a mut [P],
        width: usize,
        rows: usize,
        mirrors: &'a Mirrors,
        background: P,
    ) -> Vec<Self> {
        let canvas = |part: PicturePart<'a, P>| {
            let made = vec![0; part.rows() * bytes_of(mirrors.columns)];
            Self { background: [background; MANY], mirrors, part, made, is_blank: false }
        };
        PicturePart::all(pixels, width, rows, mirrors).into_iter().map(canvas).collect()
    }

    /// Leaves pixels that are not made as they are. Memory of zeros that nobody touches costs nothing.
    pub(crate) fn on_blank(mut self) -> Self {
        self.is_blank = true;
        self
    }

    /// Marks pixels of a row as made: of the eight from this column on, those whose bits are set.
    #[inline(always)]
    fn note(&mut self, [column, row]: [usize; 2], lanes: u8) {
        let at = row * bytes_of(self.mirrors.columns) + column / 8;
        let [low, high] = (u16::from(lanes) << (column % 8)).to_le_bytes();
        self.made[at] |= low;
        self.made[at + 1] |= high;
    }

    /// Returns the first column of a row that the band makes itself.
    fn first_column(&self, row: usize) -> usize {
        self.part.columns().start + self.mirrors.first_column(row / SIDE * SIDE)
    }

    /// Returns the next range of columns of a row, from this one on, in which no pixel is made.
    fn gap(&self, row: usize, from: usize) -> Option<Range<usize>> {
        let (columns, bytes) = (self.mirrors.columns, bytes_of(self.mirrors.columns));
        let made = &self.made[row * bytes..][..bytes];
        let next = |from: usize, is_made: bool| {
            let whole = if is_made { 0 } else { u8::MAX };
            let mut column = from;
            while column < columns && (made[column / 8] >> (column % 8) & 1 == 1) != is_made {
                // Bytes that have none of the pixels searched for are skipped whole.
                column = if column.is_multiple_of(8) && made[column / 8] == whole { column + 8 } else { column + 1 };
            }
            column.min(columns)
        };
        let start = next(from, false);
        (start < columns).then(|| start..next(start, true))
    }

    /// Fills patches in which no pixel is made, from this row on. Neighbouring patches are filled together.
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

    /// Returns the mirror images that show a pixel of the band.
    #[inline(always)]
    pub(crate) fn images_of(&self, [column, row]: [usize; 2]) -> &'a [MirrorImage] {
        // With diagonals, the band's first row has the number of its first column. Without them, the row does not
        // matter.
        self.mirrors.images_of([column, self.part.columns().start + row])
    }

    /// Fills columns of some rows of a patch with the background, in all mirror images.
    fn fill(&mut self, rows: Range<usize>, columns: Range<usize>) {
        for (index, image) in self.mirrors.images.iter().enumerate() {
            if image.is_turned {
                // The patch on the diagonal has no transposed images.
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

    /// Makes pixels of a pass's light, and writes them where each mirror image shows them. `ways` are the traversals of
    /// the view.
    #[inline(always)]
    pub(crate) fn put<D: Develop<Pixel = P>>(
        &mut self,
        Pass { group, ways: some }: &Pass,
        ways: &Ways,
        light: &GroupLight<D::Light>,
        develop: &D,
    ) {
        let Some(first) = group.first() else { return };
        if some.start == 0 {
            group.iter().for_each(|run| self.note(run.pixel(0), run.lane_bits()));
        }
        let is_whole = |(row, run): (usize, &Run)| run.is_whole() && run.row_in_patch() == row;
        let is_square = group.len() == SIDE && group.iter().enumerate().all(is_whole);
        // All pixels of the patch have the same mirror images.
        let images = self.images_of(first.pixel(0)).len();
        for (at, &(image, is_reversed)) in ways.order[some.clone()].iter().enumerate() {
            match (image < UPRIGHT, is_reversed) {
                _ if image >= images => {}
                (true, false) => self.put_rows::<D, false>(group, [at, image], light, develop),
                (true, true) => self.put_rows::<D, true>(group, [at, image], light, develop),
                (false, false) if is_square => self.put_columns::<D, false>(first, [at, image], light, develop),
                (false, true) if is_square => self.put_columns::<D, true>(first, [at, image], light, develop),
                (false, _) => {
                    for (run, light) in group.iter().zip(light) {
                        self.put_lanes(run, [at, image], light, develop);
                    }
                }
            }
        }
    }

    /// Writes rows of a patch in a mirror image that is not transposed; `at` is the image's index in the light.
    #[inline(always)]
    fn put_rows<D: Develop<Pixel = P>, const REVERSED: bool>(
        &mut self,
        group: &[Run],
        [at, image]: [usize; 2],
        light: &GroupLight<D::Light>,
        develop: &D,
    ) {
        let runs = || group.iter().zip(light);
        if let Some((run, _)) = runs().find(|(run, _)| run.is_whole()) {
            let [column, row] = run.pixel(0);
            let top = row - run.row_in_patch();
            let mut lines = self.part.lines(image, [column, top], [SIDE, SIDE.min(self.part.rows() - top)]);
            for (run, light) in runs().filter(|(run, _)| run.is_whole()) {
                let mut eight = [&light[0][at % TOGETHER]; SIDE];
                for (lane, one) in eight.iter_mut().enumerate() {
                    *one = &light[turned::<REVERSED>(lane)][at % TOGETHER];
                }
                lines.write(run.row_in_patch(), &develop.eight(eight));
            }
        }
        for (run, light) in runs().filter(|(run, _)| !run.is_whole()) {
            self.put_lanes(run, [at, image], light, develop);
        }
    }

    /// Writes columns of a patch that has all its pixels, in a transposed mirror image.
    #[inline(always)]
    fn put_columns<D: Develop<Pixel = P>, const REVERSED: bool>(
        &mut self,
        first: &Run,
        [at, image]: [usize; 2],
        light: &GroupLight<D::Light>,
        develop: &D,
    ) {
        let mut lines = self.part.lines(image, first.pixel(0), [SIDE; 2]);
        for (lane, top) in light[0].iter().enumerate() {
            let mut eight = [&top[at % TOGETHER]; SIDE];
            for (row, one) in eight.iter_mut().enumerate() {
                *one = &light[turned::<REVERSED>(row)][lane][at % TOGETHER];
            }
            lines.write(lane, &develop.eight(eight));
        }
    }

    /// Writes those pixels of a row that the run makes.
    fn put_lanes<D: Develop<Pixel = P>>(
        &mut self,
        run: &Run,
        [at, image]: [usize; 2],
        light: &[[D::Light; TOGETHER]; SIDE],
        develop: &D,
    ) {
        for lane in run.lanes() {
            self.part.lines(image, run.pixel(lane), [1; 2]).write(0, &[develop.one(light[lane][at])]);
        }
    }

    /// Makes pixels of the light of a run, where nothing is mirrored, and writes those in these lanes.
    #[inline(always)]
    pub(crate) fn put_run<D: Develop<Pixel = P>>(
        &mut self,
        pixel: [usize; 2],
        lanes: u8,
        light: &[D::Light; SIDE],
        develop: &D,
    ) {
        self.note(pixel, lanes);
        if lanes == u8::MAX {
            self.part.lines(0, pixel, [SIDE, 1]).write(0, &develop.eight(light.each_ref()));
            return;
        }
        for (lane, light) in light.iter().enumerate().filter(|(lane, _)| lanes >> lane & 1 == 1) {
            self.part.lines(0, [pixel[0] + lane, pixel[1]], [1; 2]).write(0, &[develop.one(*light)]);
        }
    }

    /// Returns the pixel that a mirror image shows in place of the one in this column and row of the band.
    #[inline(always)]
    pub(crate) fn pixel(&mut self, image: usize, pixel: [usize; 2]) -> &mut P {
        if image == 0 {
            self.note(pixel, 1);
        }
        &mut self.part.beside(image, pixel, 1)[0]
    }
}

/// Returns an index below [`SIDE`], or if `REVERSED` the one that is as far from the other end.
#[inline(always)]
const fn turned<const REVERSED: bool>(index: usize) -> usize {
    if REVERSED { SIDE - 1 - index } else { index }
}

/// Fills pixels with the background, copied from memory: as a constant it would be written byte by byte.
fn lay<P: Copy>(background: &[P; MANY], pixels: &mut [P]) {
    let (many, few) = pixels.as_chunks_mut();
    many.fill(*background);
    let (eights, others) = few.as_chunks_mut::<SIDE>();
    let (eight, _) = background.as_chunks();
    eights.fill(eight[0]);
    others.fill(background[0]);
}

/// Returns the number of bytes for one bit a column, and one more byte, which eight bits that begin within a byte may
/// reach.
const fn bytes_of(columns: usize) -> usize {
    columns.div_ceil(8) + 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::RowLayout;
    use crate::render::plan::symmetry::MOST_IMAGES;
    use crate::render::plan::traversal::passes;

    /// Conversion that shows light as it is.
    struct AsItIs;

    impl Develop for AsItIs {
        type Light = u32;
        type Pixel = u32;

        fn one(&self, light: u32) -> u32 {
            light
        }

        fn eight(&self, light: [&u32; SIDE]) -> [u32; SIDE] {
            light.map(|light| *light)
        }
    }

    /// Returns all possible mirror images of a picture of 32 × 32 pixels.
    fn mirrors() -> Mirrors {
        let layout = RowLayout::of([[4, 4]], |width| width);
        let flips = [[false, false], [true, false], [false, true], [true, true]];
        let image = |at: usize| {
            let mut image = MirrorImage::itself(&layout);
            (image.is_turned, image.flips) = (at >= UPRIGHT, flips[at % UPRIGHT]);
            image
        };
        Mirrors::new([16, 16], (0..MOST_IMAGES).map(image).collect())
    }

    /// Returns the light of a run, a lane and a mirror image.
    fn number(run: usize, lane: usize, at: usize) -> u32 {
        (1 + (SIDE * run + lane) * MOST_IMAGES + at) as u32
    }

    /// Writes a group of runs with these lanes, one below the other from this pixel on. Checks that each pixel is where
    /// its mirror image shows it, and that no other is touched.
    fn assert_put(first: [usize; 2], lanes: &[u8]) {
        let mirrors = mirrors();
        let group: Vec<Run> = lanes
            .iter()
            .enumerate()
            .map(|(row, &lanes)| Run::of_lanes(lanes, 0).at([first[0], first[1] + row]))
            .collect();
        let mut picture = vec![0; 32 * 32];
        let mut canvases = Canvas::bands(&mut picture, 32, 2 * SIDE, &mirrors, 0);
        for (pass, _) in passes(std::iter::once(&*group), MOST_IMAGES) {
            let first = pass.ways.start;
            let number = |run, lane, at| number(run, lane, first + at);
            let light =
                std::array::from_fn(|run| std::array::from_fn(|lane| std::array::from_fn(|at| number(run, lane, at))));
            canvases[0].put(&pass, mirrors.ways(0), &light, &AsItIs);
        }
        drop(canvases);
        let mut expected = vec![0; 32 * 32];
        for (number_of_run, run) in group.iter().enumerate() {
            for lane in run.lanes() {
                let [column, row] = run.pixel(lane);
                for (at, (image, _)) in mirrors.ways(0).order.iter().enumerate() {
                    let shown = &mirrors.images[*image];
                    let [across, down] = if shown.is_turned { [row, column] } else { [column, row] };
                    let [x, y] = [(across, shown.flips[0]), (down, shown.flips[1])]
                        .map(|(at, is_flipped)| if is_flipped { 31 - at } else { at });
                    // The diagonal patch is not shown transposed.
                    if !shown.is_turned || first[0] / SIDE != first[1] / SIDE {
                        expected[32 * y + x] = number(number_of_run, lane, at);
                    }
                }
            }
        }
        assert!(picture == expected, "{first:?} {lanes:x?}");
    }

    #[test]
    fn pixels_are_put_where_mirrors_show_them() {
        for first in [[0, 0], [8, 0], [8, 8]] {
            assert_put(first, &[0xff; SIDE]);
            assert_put(first, &[0xff; 3]);
            assert_put(first, &[0xff, 0xff, 0x81, 0x10, 0xff, 0x7e, 0xff, 0x01]);
        }
        assert_put([8, 2], &[0xff; 6]);
        assert_put([8, 0], &[]);
    }
}
