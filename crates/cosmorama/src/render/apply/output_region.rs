//! Unchecked writes to a picture: bands write in parallel, each to pixels of its own. This file and `texels.rs` are the
//! only ones that do not check each index.
#![allow(unsafe_code)]

use std::marker::PhantomData;
use std::ops::Range;

use bytemuck::NoUninit;

use crate::render::plan::symmetry::{MOST_IMAGES, MirrorImage, Mirrors};

/// Pixels of a picture that one band makes, in all mirror images: its own rows, and the rows that mirror them from
/// below. With mirror images about the diagonals they are a square frame around those of the next bands.
pub(crate) struct PicturePart<'a, P> {
    pixels: *mut P,
    /// Columns of the band, and the number of its rows.
    columns: Range<usize>,
    rows: usize,
    images: [Shown; MOST_IMAGES],
    /// Whether pixels are written past the caches, and whether some were since the last fence.
    is_streamed: bool,
    is_unfenced: bool,
    picture: PhantomData<&'a mut [P]>,
}

// SAFETY: it is an exclusive borrow of some pixels, which no other part has.
unsafe impl<P: Send> Send for PicturePart<'_, P> {}

/// Size of a picture, in bytes, from which it is written past the caches. It would leave them before it is read, and
/// what it overwrites need not be read into them. Tests use a small size.
const STREAMED: usize = if cfg!(test) { 1 << 14 } else { 1 << 25 };

/// Place in which a mirror image shows pixels of a band.
#[derive(Clone, Copy, Debug, Default)]
struct Shown {
    is_turned: bool,
    /// Index in the picture of the pixel that shows the first column and row of the band.
    first: isize,
    /// Steps in the picture from one column to the next, and from one row to the next.
    steps: [isize; 2],
}

impl<'a, P: Copy> PicturePart<'a, P> {
    /// Divides a picture, `width` pixels wide, into the parts that bands of `rows` rows make, from the top one on.
    ///
    /// # Panics
    /// If its size is not the one that `mirrors` make.
    pub(crate) fn all(pixels: &'a mut [P], width: usize, rows: usize, mirrors: &Mirrors) -> Vec<Self> {
        if pixels.is_empty() {
            return Vec::new();
        }
        let height = pixels.len() / width;
        let is_halved = |axis: usize| mirrors.images.iter().any(|image| image.is_turned || image.flips[axis]);
        let all = |axis: usize, length: usize| if is_halved(axis) { 2 * length } else { length };
        let is_whole = all(0, mirrors.columns) == width && all(1, mirrors.rows) == height;
        assert!(is_whole && pixels.len() == width * height, "a picture as large as the mirrors make it");
        let may_turn = width == height && mirrors.has_diagonals();
        let are_known = mirrors.images.iter().all(|image| may_turn || !image.is_turned);
        assert!(
            are_known && mirrors.images.len() <= MOST_IMAGES,
            "columns are rows in squares with all their diagonals"
        );
        let is_streamed = size_of_val(pixels) >= STREAMED && can_stream(pixels);
        let pixels = pixels.as_mut_ptr();
        let part = |index: usize| {
            let first = index * rows;
            let mut images = [Shown::default(); MOST_IMAGES];
            for (shown, image) in images.iter_mut().zip(&mirrors.images) {
                *shown = Shown::new(image, first, [width, height]);
            }
            let (columns, rows) = (mirrors.first_column(first)..mirrors.columns, rows.min(mirrors.rows - first));
            Self { pixels, columns, rows, images, is_streamed, is_unfenced: false, picture: PhantomData }
        };
        (0..mirrors.rows.div_ceil(rows)).map(part).collect()
    }

    /// Returns the number of rows of the band.
    pub(crate) fn rows(&self) -> usize {
        self.rows
    }

    /// Returns the columns of the band.
    pub(crate) fn columns(&self) -> Range<usize> {
        self.columns.clone()
    }

    /// Returns `count` neighbouring pixels of a row of the picture in a mirror image. The first of them (or the last,
    /// from right to left) shows this column and row of the band. The others show the columns after it or, in a
    /// transposed image, the rows.
    ///
    /// # Panics
    /// If they are not all in the band, or there is no such mirror image.
    #[inline(always)]
    pub(crate) fn beside(&mut self, image: usize, pixel: [usize; 2], count: usize) -> &mut [P] {
        self.fence();
        let size = if self.images[image].is_turned { [1, count] } else { [count, 1] };
        let first = self.place(image, pixel, size).first;
        // SAFETY: `place` made sure that these are neighbouring pixels of the band, which no other part has. The
        // picture is borrowed exclusively by its parts, and this part by the result.
        unsafe { std::slice::from_raw_parts_mut(first, count) }
    }

    /// Returns where a mirror image shows this number of columns and rows of the band, from this pixel on.
    ///
    /// # Panics
    /// If they are not all in the band, or there is no such mirror image.
    #[inline(always)]
    fn place(&self, image: usize, [column, row]: [usize; 2], [columns, rows]: [usize; 2]) -> Place<P> {
        let Shown { is_turned, first, steps: [across, down] } = self.images[image];
        let (along, next) = if is_turned { (down, across) } else { (across, down) };
        let (length, lines) = if is_turned { (rows, columns) } else { (columns, rows) };
        // Differences, since a sum might wrap to zero.
        let is_within = self.columns.contains(&column)
            && columns <= self.columns.end - column
            && row < self.rows
            && rows <= self.rows - row;
        assert!(is_within && along != 0 && length > 0, "pixels of the band");
        let first = first + across * column as isize + down * row as isize;
        let first = if along < 0 { first - (length as isize - 1) } else { first };
        // Each mirror image shows each computed pixel somewhere in the picture, whose size `all` has checked. No other
        // part has that pixel. Without diagonals, bands are rows of the picture or of its upper half, and a mirror
        // image shows a row as itself or at the same distance from the bottom. With diagonals, the computed columns and
        // rows are halves of a square, and each mirror image shows a pixel at the distance min(column, row) from the
        // nearest edge. The columns of a band begin with the number of its first row, so that this distance is the
        // number of one of its rows.
        Place { first: self.pixels.wrapping_offset(first), next, length, lines }
    }
}

/// Place in which a mirror image shows pixels of a band: some lines of the picture, all of them pixels of the band.
struct Place<P> {
    /// Leftmost pixel of the first line.
    first: *mut P,
    /// Distance from one line to the next, in pixels.
    next: isize,
    /// Number of pixels of a line.
    length: usize,
    lines: usize,
}

/// Pixels of a band in lines of the picture, which are written from left to right.
pub(crate) struct Lines<'a, P> {
    place: Place<P>,
    is_streamed: bool,
    picture: PhantomData<&'a mut [P]>,
}

impl<P: NoUninit> PicturePart<'_, P> {
    /// Returns the lines in which a mirror image shows these columns and rows, from this pixel on, for writing. A line
    /// shows a row of the band or, in a transposed image, a column.
    ///
    /// # Panics
    /// If they are not all in the band, or there is no such mirror image.
    #[inline(always)]
    pub(crate) fn lines(&mut self, image: usize, pixel: [usize; 2], size: [usize; 2]) -> Lines<'_, P> {
        let (place, is_streamed) = (self.place(image, pixel, size), self.is_streamed);
        self.is_unfenced |= is_streamed;
        Lines { place, is_streamed, picture: PhantomData }
    }
}

impl<P: NoUninit> Lines<'_, P> {
    /// Writes all pixels of a line.
    ///
    /// # Panics
    /// If there is no such line, or its length differs.
    #[inline(always)]
    pub(crate) fn write<const LENGTH: usize>(&mut self, line: usize, pixels: &[P; LENGTH]) {
        let Place { first, next, length, lines } = self.place;
        assert!(line < lines && LENGTH == length, "a line of the picture");
        let first = first.wrapping_offset(next * line as isize);
        // SAFETY: `place` made sure that these are neighbouring pixels of the band, which no other part has.
        let into = unsafe { std::slice::from_raw_parts_mut(first, LENGTH) };
        if self.is_streamed { stream(into, pixels) } else { into.copy_from_slice(pixels) }
    }
}

impl<P> PicturePart<'_, P> {
    /// Orders the writes past the caches before all later reads.
    #[inline(always)]
    fn fence(&mut self) {
        #[cfg(target_arch = "x86_64")]
        if std::mem::take(&mut self.is_unfenced) {
            // SAFETY: all processors of this kind have the instruction.
            unsafe { std::arch::x86_64::_mm_sfence() }
        }
    }
}

impl<P> Drop for PicturePart<'_, P> {
    fn drop(&mut self) {
        self.fence();
    }
}

/// Number of bytes that one instruction writes past the caches.
const BLOCK: usize = 16;

/// Returns whether pixels can be written past the caches, one by one.
fn can_stream<P>(pixels: &[P]) -> bool {
    cfg!(target_arch = "x86_64") && size_of::<P>() == BLOCK && pixels.as_ptr().addr().is_multiple_of(BLOCK)
}

/// Copies pixels past the caches.
///
/// # Panics
/// If that is impossible, or the lengths differ.
#[inline(always)]
fn stream<P: NoUninit>(into: &mut [P], pixels: &[P]) {
    assert!(can_stream(into) && into.len() == pixels.len(), "pixels that can be streamed");
    #[cfg(target_arch = "x86_64")]
    for (into, pixel) in into.iter_mut().zip(pixels) {
        use std::arch::x86_64::{_mm_loadu_si128, _mm_stream_si128};
        // SAFETY: a pixel has sixteen initialised bytes and begins at a multiple of sixteen, since the first one does.
        unsafe { _mm_stream_si128(std::ptr::from_mut(into).cast(), _mm_loadu_si128(std::ptr::from_ref(pixel).cast())) }
    }
}

impl Shown {
    /// Computes where a mirror image shows a band that begins in this row.
    fn new(image: &MirrorImage, top: usize, [width, height]: [usize; 2]) -> Self {
        // Column and row of the picture that show the first computed pixel, and the direction in which the next ones
        // follow.
        let [column, row] = [0, 1].map(|axis| if image.flips[axis] { [width, height][axis] as isize - 1 } else { 0 });
        let [right, below] = [0, 1].map(|axis| if image.flips[axis] { -1 } else { 1 });
        let (width, top) = (width as isize, top as isize);
        let steps = if image.is_turned { [below * width, right] } else { [right, below * width] };
        Self { is_turned: image.is_turned, first: row * width + column + steps[1] * top, steps }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::RowLayout;

    /// Number of rows of a band.
    const ROWS: usize = 4;

    /// Returns the first `count` mirror images of a picture of this size.
    fn mirrors(size: [usize; 2], count: usize) -> Mirrors {
        let layout = RowLayout::of([[4, 4]], |width| width);
        let flips = [[false, false], [true, false], [false, true], [true, true]];
        let image = |at: usize| {
            let mut image = MirrorImage::itself(&layout);
            (image.is_turned, image.flips) = (at >= 4, flips[at % 4]);
            image
        };
        let length = |axis: usize| if count > 1 << axis { size[axis] / 2 } else { size[axis] };
        Mirrors::new([length(0), length(1)], (0..count).map(image).collect())
    }

    #[test]
    fn each_pixel_is_in_the_part_of_one_band() {
        for (size, count) in [
            ([10, 7], 1),
            ([10, 7], 2),
            ([6, 14], 4),
            ([26, 26], 8),
            ([8, 8], 8),
            ([2, 2], 8),
            ([0, 0], 1),
            ([0, 5], 1),
        ] {
            let mirrors = mirrors(size, count);
            // How often each pixel is made, and by which band.
            let mut picture = vec![(0, 0); size[0] * size[1]];
            let parts = PicturePart::all(&mut picture, size[0], ROWS, &mirrors);
            assert_eq!(parts.len(), if size.contains(&0) { 0 } else { mirrors.rows.div_ceil(ROWS) });
            for (band, mut part) in parts.into_iter().enumerate() {
                for row in 0..part.rows() {
                    for pixel in part.columns().map(|column| [column, row]) {
                        for image in 0..count {
                            let [(made, by)] = part.beside(image, pixel, 1) else { unreachable!("one pixel") };
                            // Pixels along a diagonal are made twice, by the same band.
                            assert!(*made == 0 || *by == band, "{size:?} {count}: {pixel:?} of {band} and {by}");
                            (*made, *by) = (*made + 1, band);
                        }
                    }
                }
            }
            assert!(picture.iter().all(|(made, _)| *made > 0), "{size:?} {count}: {picture:?}");
            assert!(count == 8 || picture.iter().all(|(made, _)| *made == 1), "{size:?} {count}: {picture:?}");
        }
    }

    #[test]
    fn pixels_beside_each_other_are_those_that_follow_in_the_picture() {
        let mirrors = mirrors([24, 24], 8);
        let mut picture: Vec<usize> = (0..24 * 24).collect();
        let mut parts = PicturePart::all(&mut picture, 24, ROWS, &mirrors);
        let seen = |part: &mut PicturePart<usize>, image: usize| part.beside(image, [5, 1], 3).to_vec();
        let row = |column: usize, row: usize| vec![24 * row + column, 24 * row + column + 1, 24 * row + column + 2];
        // In the second band, whose first row is the fifth: columns 5 to 7, and rows 5 to 7 of column 5.
        let expected = [[5, 5], [16, 5], [5, 18], [16, 18], [5, 5], [16, 5], [5, 18], [16, 18]];
        for (image, [column, at]) in expected.into_iter().enumerate() {
            assert_eq!(seen(&mut parts[1], image), row(column, at), "{image}");
        }
    }

    #[test]
    #[cfg(target_arch = "x86_64")]
    fn pixels_are_written_past_the_caches_as_they_would_be_into_them() {
        for (side, is_streamed) in [(24, false), (40, true)] {
            let mirrors = mirrors([side, side], 8);
            let mut picture = vec![0u128; side * side];
            {
                let mut parts = PicturePart::all(&mut picture, side, ROWS, &mirrors);
                assert!(parts.iter().all(|part| part.is_streamed == is_streamed), "{side}");
                parts[1].lines(3, [5, 1], [3, 1]).write(0, &[1, 2, u128::MAX]);
                parts[1].lines(4, [5, 1], [2, 3]).write(1, &[4, 5, 6]);
            }
            let (flipped, turned) = (side * (side - 6) + side - 8, side * 6 + 5);
            assert_eq!((&picture[flipped..][..3], &picture[turned..][..3]), (&[1, 2, u128::MAX][..], &[4, 5, 6][..]));
            assert_eq!(picture.iter().filter(|pixel| **pixel != 0).count(), 6);
        }
        let bytes = [0u128; 3];
        let shifted: &[[u8; 16]] = bytemuck::cast_slice(&bytemuck::cast_slice::<u128, u8>(&bytes)[1..33]);
        assert!(can_stream(&bytes) && !can_stream(shifted) && !can_stream(&[[0u8; 3]; 16]));
    }

    #[test]
    fn no_pixel_is_given_that_another_band_makes() {
        let mirrors = mirrors([24, 24], 8);
        let mut picture = vec![0; 24 * 24];
        let mut parts = PicturePart::all(&mut picture, 24, ROWS, &mirrors);
        let mut is_given = |image: usize, pixel: [usize; 2], count: usize| {
            let given = std::panic::AssertUnwindSafe(|| parts[1].beside(image, pixel, count).len());
            std::panic::catch_unwind(given).is_ok_and(|given| given == count)
        };
        assert!(is_given(0, [4, 0], 8) && is_given(3, [11, 3], 1) && is_given(4, [11, 0], 4));
        for (image, pixel, count) in [(0, [3, 0], 1), (0, [4, 4], 1), (1, [5, 0], 8), (4, [4, 1], 4), (8, [4, 0], 1)] {
            assert!(!is_given(image, pixel, count), "{count} from {pixel:?} in {image}");
        }
        assert!(
            !is_given(0, [usize::MAX, 0], 1) && !is_given(0, [4, 0], usize::MAX) && !is_given(5, [4, usize::MAX], 1)
        );
        let are_parts = |width: usize, height: usize, mirrors: &Mirrors| {
            std::panic::catch_unwind(|| PicturePart::all(&mut vec![0; width * height], width, ROWS, mirrors).len())
                .is_ok()
        };
        assert!(are_parts(24, 24, &mirrors) && !are_parts(24, 23, &mirrors) && !are_parts(23, 24, &mirrors));
        // Transposed images need a square picture, and all eight images.
        assert!(!are_parts(24, 20, &super::tests::mirrors([24, 20], 8)));
        assert!(!are_parts(24, 24, &super::tests::mirrors([24, 24], 5)));
    }
}
