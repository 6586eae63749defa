use crate::render::plan::span::Run;
use crate::render::plan::window_order::{Place, Told};

/// The size of a pixel's window, and how its weights follow each other: first those of its blocks, row by row, then those of the
/// columns that make no whole block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shape {
    pub(crate) width: usize,
    pub(crate) height: usize,
}

/// Texels beside each other that are weighed together.
pub(crate) const BLOCK: usize = 4;

impl Shape {
    /// Returns the shape of windows that are as large as their run's.
    #[inline(always)]
    pub(crate) fn of_run(run: &Run) -> Self {
        Self { width: usize::from(run.width), height: usize::from(run.height) }
    }

    pub(crate) fn area(self) -> usize {
        self.width * self.height
    }

    /// Columns in whole blocks: the first ones.
    #[inline(always)]
    pub(crate) fn in_blocks(self) -> usize {
        self.width / BLOCK * BLOCK
    }

    /// Where among them the weight of a texel stands.
    #[inline(always)]
    pub(crate) fn index(self, row: usize, column: usize) -> usize {
        let whole = self.in_blocks();
        if column < whole {
            row * whole + column
        } else {
            self.height * whole + row * (self.width - whole) + column - whole
        }
    }
}

/// The size of a window where a kernel is as small as may be, and the first of the [`ROWS_UNDER`] rows outside which none of its
/// texels lies under the pixel; nor does any outside its first [`BLOCK`] columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Small {
    pub(crate) shape: Shape,
    pub(crate) under: usize,
}

/// Rows of a small window that may hold texels under the pixel.
pub(crate) const ROWS_UNDER: usize = 3;

impl Small {
    /// How many of them are as wide.
    pub(crate) const HEIGHTS: usize = 3;

    /// As many of each width, in the same order.
    pub(crate) const ALL: [Self; 6] = [
        Self::new(4, 4, 0),
        Self::new(4, 4, 1),
        Self::new(4, 5, 1),
        Self::new(5, 4, 0),
        Self::new(5, 4, 1),
        Self::new(5, 5, 1),
    ];

    const fn new(width: usize, height: usize, under: usize) -> Self {
        Self { shape: Shape { width, height }, under }
    }
}

/// What is known of a pixel's window.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Header(pub(crate) u32);

impl Header {
    /// As large as all windows of the run, in place of an index of [`Small::ALL`].
    const LARGE: u32 = 7;

    pub(crate) fn small(index: usize, marks: u32, place: Place) -> Self {
        Self(index as u32 | marks << 16 | place.bits())
    }

    pub(crate) fn large(place: Place) -> Self {
        Self(Self::LARGE | place.bits())
    }

    /// What it tells of a run's window.
    pub(crate) fn told(self, run: &Run) -> Told {
        let length = match Small::ALL.get(self.index() as usize) {
            Some(small) => 1 + small.shape.area(),
            None => {
                let shape = Shape::of_run(run);
                1 + run.rows_under().len() * mark_words(shape.width) + shape.area()
            }
        };
        Told { shape: self.index(), length }
    }

    /// The index of its size among the small ones; more, if it is none.
    #[inline(always)]
    pub(crate) fn index(self) -> u32 {
        self.0 & 7
    }

    /// Which texels of a small window lie under the pixel: a bit for each of the first columns of each of those rows.
    #[inline(always)]
    pub(crate) fn marks(self) -> u32 {
        self.0 >> 16 & ((1 << (ROWS_UNDER * BLOCK)) - 1)
    }
}

/// How many numbers tell of a row of a large window which texels lie under the pixel.
#[inline(always)]
pub(crate) fn mark_words(width: usize) -> usize {
    width.div_ceil(32)
}
