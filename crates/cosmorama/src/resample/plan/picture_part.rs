//! The other door behind which indices are not checked each time: bands write to one picture, each to pixels of its own.
#![allow(unsafe_code)]

use std::marker::PhantomData;
use std::ops::Range;

use super::mirrors::{MOST_IMAGES, MirrorImage, Mirrors};

/// The pixels of a picture that one band makes, in all mirrors: its own rows and those that mirror it from below; with mirrors along
/// the diagonals a frame as wide as it is high, within which lie those of the next bands.
pub(super) struct PicturePart<'a, P> {
    pixels: *mut P,
    /// Columns of the band, and how many rows.
    columns: Range<usize>,
    rows: usize,
    images: [Shown; MOST_IMAGES],
    picture: PhantomData<&'a mut [P]>,
}

// SAFETY: it is an exclusive borrow of some pixels, which no other part has.
unsafe impl<P: Send> Send for PicturePart<'_, P> {}

/// Where a mirror shows pixels of a band.
#[derive(Clone, Copy, Debug, Default)]
struct Shown {
    is_turned: bool,
    /// Where in the picture the pixel of the first column and row of the band's rows is.
    first: isize,
    /// Pixels of the picture from one column to the next, and from one row to the next.
    steps: [isize; 2],
}

impl<'a, P: Copy> PicturePart<'a, P> {
    /// Cuts a picture, `width` pixels wide, into what bands of `rows` rows make, from the top one on.
    ///
    /// # Panics
    /// If it is not of the size that the mirrors make.
    pub(super) fn all(pixels: &'a mut [P], width: usize, rows: usize, mirrors: &Mirrors) -> Vec<Self> {
        // A picture without columns has no rows.
        let height = pixels.len() / width.max(1);
        let is_halved = |axis: usize| mirrors.images.iter().any(|image| image.is_turned || image.flips[axis]);
        let all = |axis: usize, length: usize| if is_halved(axis) { 2 * length } else { length };
        let is_whole = all(0, mirrors.columns) == width && all(1, mirrors.rows) == height;
        assert!(is_whole && pixels.len() == width * height, "a picture as large as the mirrors make it");
        let is_square = width == height || mirrors.images.iter().all(|image| !image.is_turned);
        assert!(is_square && mirrors.images.len() <= MOST_IMAGES, "columns are rows of squares alone");
        let pixels = pixels.as_mut_ptr();
        let part = |index: usize| {
            let first = index * rows;
            let mut images = [Shown::default(); MOST_IMAGES];
            for (shown, image) in images.iter_mut().zip(&mirrors.images) {
                *shown = Shown::new(image, first, [width, height]);
            }
            let (columns, rows) = (mirrors.first_column(first)..mirrors.columns, rows.min(mirrors.rows - first));
            Self { pixels, columns, rows, images, picture: PhantomData }
        };
        (0..mirrors.rows.div_ceil(rows)).map(part).collect()
    }

    /// How many rows the band has.
    pub(super) fn rows(&self) -> usize {
        self.rows
    }

    /// The columns of the band.
    pub(super) fn columns(&self) -> Range<usize> {
        self.columns.clone()
    }

    /// So many pixels beside each other in the picture, as a mirror shows them, of which this column and row of the band is the first
    /// or, from right to left, the last one. They are columns of the band; where columns are rows, rows.
    ///
    /// # Panics
    /// If they are not all in the band, or there are not so many mirrors.
    #[inline(always)]
    pub(super) fn beside(&mut self, image: usize, [column, row]: [usize; 2], count: usize) -> &mut [P] {
        let Shown { is_turned, first, steps: [across, down] } = self.images[image];
        let ([columns, rows], along) = if is_turned { ([1, count], down) } else { ([count, 1], across) };
        let is_within = self.columns.start <= column && column + columns <= self.columns.end && row + rows <= self.rows;
        assert!(is_within && along != 0, "pixels of the band");
        let first = first + across * column as isize + down * row as isize;
        let first = if along < 0 { first - (count as isize - 1) } else { first };
        // SAFETY: each mirror shows the rows and columns of all bands, which are among those of `Mirrors`, somewhere in the picture, which
        // `all` found to be of their size; those of this band no other part has: of bands of whole rows, or half ones, these and those that
        // mirror them are other rows than the others', and with diagonals, where the columns begin with the number of the first row, what
        // mirrors show of a band is as far from the picture's edge as its rows are from the top. Nobody else has this picture meanwhile, and
        // what is borrowed from this part is given back before more is.
        unsafe { std::slice::from_raw_parts_mut(self.pixels.offset(first), count) }
    }
}

impl Shown {
    /// Where a mirror shows a band that begins in this row.
    fn new(image: &MirrorImage, top: usize, [width, height]: [usize; 2]) -> Self {
        // In the picture, from left to right and from top to bottom: the pixel that the first one is seen as, and which way others follow.
        let [column, row] = [0, 1].map(|axis| if image.flips[axis] { [width, height][axis] as isize - 1 } else { 0 });
        let [right, below] = [0, 1].map(|axis| if image.flips[axis] { -1 } else { 1 });
        let (width, top) = (width as isize, top as isize);
        let steps = if image.is_turned { [below * width, right] } else { [right, below * width] };
        Self { is_turned: image.is_turned, first: row * width + column + steps[1] * top, steps }
    }
}
