//! How windows are kept in a plan: their sizes, and the number that stands before each one's weights.

use std::fmt::Debug;
use std::ops::Range;

use fearless_simd::Simd;

use super::span::Run;
use crate::render::batch::window::Windows;
use crate::render::scan::tile::SIDE;

/// How the weights of windows are kept in one type of number.
pub(crate) trait Format: Clone + Debug + Default + Send + Sync {
    /// The sizes of small windows.
    const SMALL: SmallShapes;

    /// How many weights are kept in a number, of texels beside each other.
    const TOGETHER: usize;

    /// How many texels there are from one row of a view to the next in the light that they are for, if rows hold so many.
    fn pitch(width: usize) -> usize;

    /// Takes up the windows of a run; false if they cannot be held.
    fn take<S: Simd>(&mut self, simd: S, windows: &Windows) -> bool;

    /// Writes down a lane's window, and where it begins; false if that cannot be.
    fn write(&self, windows: &Windows, place: Place, corner: &mut [u32; 2], numbers: &mut Vec<u32>) -> bool;
}

/// The size of a pixel's window as it is kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shape {
    pub(crate) width: usize,
    pub(crate) height: usize,
    /// The first of the [`ROWS_UNDER`] rows outside which no texel of a small window lies under the pixel.
    pub(crate) under: usize,
}

/// Rows of a small window that may hold texels under the pixel, and columns, the first ones.
pub(crate) const ROWS_UNDER: usize = 3;
pub(crate) const COLUMNS_UNDER: usize = 4;

/// Sizes of windows where a kernel is as small as may be.
pub(crate) type SmallShapes = [Shape; 2 * Shape::HEIGHTS];

impl Shape {
    /// How many of the small ones are as wide.
    pub(crate) const HEIGHTS: usize = 3;

    /// Lists the small shapes: as many of each width, in the same order.
    pub(crate) const fn small([narrow, wide]: [usize; 2]) -> SmallShapes {
        const fn new(width: usize, height: usize, under: usize) -> Shape {
            Shape { width, height, under }
        }
        [new(narrow, 4, 0), new(narrow, 4, 1), new(narrow, 5, 1), new(wide, 4, 0), new(wide, 4, 1), new(wide, 5, 1)]
    }

    /// Returns the shape of large windows of so many columns and rows.
    #[inline(always)]
    pub(crate) fn large<F: Format>([width, height]: [usize; 2]) -> Self {
        Self { width: width.next_multiple_of(F::TOGETHER), height, under: 0 }
    }

    pub(crate) fn area(self) -> usize {
        self.width * self.height
    }

    /// How many numbers tell of a row of a large window which texels lie under the pixel.
    #[inline(always)]
    pub(crate) fn mark_words(self) -> usize {
        self.width.div_ceil(32)
    }
}

/// Where a window belongs: to which run of its group, and in which lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    pub(crate) run: usize,
    pub(crate) lane: usize,
}

/// What is known of a pixel's window: its shape, its place, and in the other bits what its format tells.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Header(pub(crate) u32);

impl Header {
    const SHAPE: u32 = 9;
    const LANE: u32 = 12;
    const RUN: u32 = 29;

    /// In place of an index of small shapes: as large as the run's windows are.
    const LARGE: usize = 7;

    /// `rest` has no bits but 0 to 8 and 16 to 28.
    #[inline(always)]
    pub(crate) fn new(small: Option<usize>, Place { run, lane }: Place, rest: u32) -> Self {
        let shape = small.unwrap_or(Self::LARGE);
        Self((shape << Self::SHAPE | (run % SIDE) << Self::RUN | (lane % SIDE) << Self::LANE) as u32 | rest)
    }

    /// The index of its shape among the small ones; more, if it is none.
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

/// The numbers of a window's pixel: those after its header.
#[derive(Clone, Debug)]
pub(crate) struct Kept<'a> {
    pub(crate) shape: Shape,
    /// The rows of a large window that may hold texels under the pixel; none of a small one.
    pub(crate) under: Range<usize>,
    /// Which texels of these rows do.
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

    /// Returns which texels of a row of a large window lie under the pixel; nothing of rows in which none does.
    #[inline(always)]
    pub(crate) fn marks_of(&self, row: usize) -> Option<&'a [u32]> {
        let words = self.shape.mark_words();
        self.under.contains(&row).then(|| &self.marks[(row - self.under.start) * words..][..words])
    }

    /// How many numbers there are of it, the header among them.
    #[inline(always)]
    pub(crate) fn length(&self) -> usize {
        1 + self.marks.len() + self.weights.len()
    }
}
