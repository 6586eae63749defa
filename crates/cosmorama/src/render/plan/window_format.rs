//! Format of windows in a plan: their sizes, and the header before each one's weights.

use std::fmt::Debug;
use std::ops::Range;

use fearless_simd::Simd;

use super::span::Run;
use crate::render::batch::window::Windows;
use crate::render::scan::tile::SIDE;

/// Storage of windows' weights in one type of number.
pub(crate) trait Format: Clone + Debug + Default + Send + Sync {
    /// Sizes of small windows.
    const SMALL: SmallShapes;

    /// Number of weights of neighbouring texels that are kept in one number.
    const TOGETHER: usize;

    /// Returns the number of texels from one row of a view to the next in the light for this format.
    fn pitch(width: usize) -> usize;

    /// Converts the windows of a run; false if they do not fit.
    fn take<S: Simd>(&mut self, simd: S, windows: &Windows) -> bool;

    /// Writes a lane's window, and moves the corner to where it begins; false if it does not fit.
    fn write(&self, windows: &Windows, place: Place, corner: &mut [u32; 2], numbers: &mut Vec<u32>) -> bool;
}

/// Size of a pixel's window as it is kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shape {
    pub(crate) width: usize,
    pub(crate) height: usize,
    /// First of the [`ROWS_UNDER`] rows that may hold texels under the pixel, in a small window.
    pub(crate) under: usize,
}

/// Number of rows of a small window that may hold texels under the pixel, and number of columns from the first.
pub(crate) const ROWS_UNDER: usize = 3;
pub(crate) const COLUMNS_UNDER: usize = 4;

/// Sizes of the windows of the smallest kernels.
pub(crate) type SmallShapes = [Shape; 2 * Shape::HEIGHTS];

impl Shape {
    /// Number of small shapes of each width.
    pub(crate) const HEIGHTS: usize = 3;

    /// Lists the small shapes: the same heights, in the same order, for each of two widths.
    pub(crate) const fn small([narrow, wide]: [usize; 2]) -> SmallShapes {
        const fn new(width: usize, height: usize, under: usize) -> Shape {
            Shape { width, height, under }
        }
        [new(narrow, 4, 0), new(narrow, 4, 1), new(narrow, 5, 1), new(wide, 4, 0), new(wide, 4, 1), new(wide, 5, 1)]
    }

    /// Returns the shape of large windows with this number of columns and rows.
    #[inline(always)]
    pub(crate) fn large<F: Format>([width, height]: [usize; 2]) -> Self {
        Self { width: width.next_multiple_of(F::TOGETHER), height, under: 0 }
    }

    pub(crate) fn area(self) -> usize {
        self.width * self.height
    }

    /// Returns the number of words that mark, in a row of a large window, which texels lie under the pixel.
    #[inline(always)]
    pub(crate) fn mark_words(self) -> usize {
        self.width.div_ceil(32)
    }
}

/// Place of a window: the run of its group, and the lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    pub(crate) run: usize,
    pub(crate) lane: usize,
}

/// Header of a pixel's window: its shape, its place, and in the other bits data of its format.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Header(pub(crate) u32);

impl Header {
    const SHAPE: u32 = 9;
    const LANE: u32 = 12;
    const RUN: u32 = 29;

    /// Index of the shape of a window that is not small: it is as large as the run's windows.
    const LARGE: usize = 7;

    /// Packs a header; `rest` may use only bits 0 to 8 and 16 to 28.
    #[inline(always)]
    pub(crate) fn new(small: Option<usize>, Place { run, lane }: Place, rest: u32) -> Self {
        let shape = small.unwrap_or(Self::LARGE);
        Self((shape << Self::SHAPE | (run % SIDE) << Self::RUN | (lane % SIDE) << Self::LANE) as u32 | rest)
    }

    /// Returns the index of its shape among the small ones, or a greater number if it is not small.
    #[inline(always)]
    pub(crate) fn shape(self) -> u32 {
        self.0 >> Self::SHAPE & 7
    }

    #[inline(always)]
    pub(crate) fn place(self) -> Place {
        let part = |first: u32| (self.0 >> first) as usize % SIDE;
        Place { run: part(Self::RUN), lane: part(Self::LANE) }
    }
}

/// Numbers of a pixel's window that follow its header.
#[derive(Clone, Debug)]
pub(crate) struct Kept<'a> {
    pub(crate) shape: Shape,
    /// Rows of a large window that may hold texels under the pixel; empty for a small window.
    pub(crate) under: Range<usize>,
    /// Bits of the texels of these rows that lie under the pixel.
    pub(crate) marks: &'a [u32],
    pub(crate) weights: &'a [u32],
}

impl<'a> Kept<'a> {
    /// Reads a large window of a run from its header on.
    #[inline(always)]
    pub(crate) fn large<F: Format>(run: &Run, numbers: &'a [u32]) -> Self {
        let (shape, under) = (Shape::large::<F>([run.width, run.height].map(usize::from)), run.rows_under());
        let (marks, weights) = numbers[1..].split_at(under.len() * shape.mark_words());
        Self { shape, under, marks, weights: &weights[..shape.area() / F::TOGETHER] }
    }

    /// Reads a window of a run from its header on.
    pub(crate) fn of<F: Format>(run: &Run, numbers: &'a [u32]) -> Self {
        match F::SMALL.get(Header(numbers[0]).shape() as usize) {
            Some(&shape) => {
                Self { shape, under: 0..0, marks: &[], weights: &numbers[1..][..shape.area() / F::TOGETHER] }
            }
            None => Self::large::<F>(run, numbers),
        }
    }

    /// Returns which texels of a row of a large window lie under the pixel; `None` for rows in which none does.
    #[inline(always)]
    pub(crate) fn marks_of(&self, row: usize) -> Option<&'a [u32]> {
        let words = self.shape.mark_words();
        self.under.contains(&row).then(|| &self.marks[(row - self.under.start) * words..][..words])
    }

    /// Returns the count of numbers, including the header.
    #[inline(always)]
    pub(crate) fn length(&self) -> usize {
        1 + self.marks.len() + self.weights.len()
    }
}
