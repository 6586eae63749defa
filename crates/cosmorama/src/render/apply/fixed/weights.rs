use fearless_simd::{Simd, dispatch};

use super::quantize::{Origin, Rounded};
use crate::raster::FixedLight;
use crate::render::batch::window::Windows;
use crate::render::plan::span::{Corners, Run};
use crate::render::plan::weights::Weights;
use crate::render::plan::window_order::{self, Place, Told};
use crate::render::scan::tile::SIDE;

/// The weights of windows as integers, pixel by pixel, row by row, two beside each other in each number.
///
/// Before those of a pixel stands a [`Header`]; then, if its window is not of one of the [`Shape::SMALL`] sizes, which texels do not
/// lie under the pixel, [`mark_words`] numbers for each row in which some do.
#[derive(Clone, Debug, Default)]
pub(crate) struct FixedWeights {
    pub(crate) numbers: Vec<u32>,
    rounded: Rounded,
}

/// The size of a pixel's window: how many pairs of texels across, and how many rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shape {
    pub(crate) pairs: usize,
    pub(crate) height: usize,
    /// The first of the [`ROWS_UNDER`] rows outside which no texel of a small window lies under the pixel.
    pub(crate) under: usize,
}

/// Rows of a small window that may hold texels under the pixel, and pairs of each of them, the first ones.
pub(crate) const ROWS_UNDER: usize = 3;
pub(crate) const PAIRS_UNDER: usize = 2;

impl Shape {
    /// How many of the small ones are as wide.
    pub(crate) const HEIGHTS: usize = 3;

    /// Where a kernel is as small as may be: as many of each width, in the same order.
    pub(crate) const SMALL: [Self; 6] = [
        Self::new(2, 4, 0),
        Self::new(2, 4, 1),
        Self::new(2, 5, 1),
        Self::new(3, 4, 0),
        Self::new(3, 4, 1),
        Self::new(3, 5, 1),
    ];

    const fn new(pairs: usize, height: usize, under: usize) -> Self {
        Self { pairs, height, under }
    }

    /// Returns the shape of windows that are as large as their run's.
    #[inline(always)]
    pub(crate) fn of_run(run: &Run) -> Self {
        Self::new(usize::from(run.width).div_ceil(2), usize::from(run.height), 0)
    }
}

/// Rows of the highest small window, and pairs of the widest.
pub(crate) const HIGHEST: usize = 5;
pub(crate) const WIDEST: usize = 3;

/// Numbers that hold any of them with its header, and what follows its last row.
const MOST: usize = 1 + WIDEST * (HIGHEST - 1) + SIDE / 2;

/// What is known of a pixel's window: which texels of a small one do not lie under the pixel, its shape and how its weights are
/// scaled.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Header(pub(crate) u32);

impl Header {
    /// In place of an index of [`Shape::SMALL`]: as large as the run's windows are.
    const LARGE: u32 = 7;

    /// All marks of a small window: of [`PAIRS_UNDER`] pairs of [`ROWS_UNDER`] rows, row by row.
    const MARKS: u32 = {
        let pairs = (1 << (ROWS_UNDER * PAIRS_UNDER)) - 1;
        pairs << 16 | pairs
    };

    /// `under` are marks of texels under the pixel. Those of the others are kept: a mark becomes the sign that takes a texel out of the
    /// bounds.
    fn new(small: Option<usize>, bits: u32, under: u32, place: Place) -> Self {
        let small = small.map_or(Self::LARGE, |index| index as u32);
        Self(small << 9 | bits << 25 | !under & Self::MARKS | place.bits())
    }

    /// The index of its shape among the small ones; more, if it is none.
    #[inline(always)]
    pub(crate) fn shape(self) -> u32 {
        self.0 >> 9 & 7
    }

    /// Whether it is one of these.
    #[inline(always)]
    pub(crate) fn is_small(self) -> bool {
        (self.shape() as usize) < Shape::SMALL.len()
    }

    /// By how many bits the weights are scaled.
    #[inline(always)]
    pub(crate) fn bits(self) -> u32 {
        self.0 >> 25 & 15
    }

    /// What it tells of a run's window.
    pub(crate) fn told(self, run: &Run) -> Told {
        let length = match Shape::SMALL.get(self.shape() as usize) {
            Some(shape) => 1 + shape.pairs * shape.height,
            None => {
                let Shape { pairs, height, .. } = Shape::of_run(run);
                1 + run.rows_under().len() * mark_words(pairs) + pairs * height
            }
        };
        Told { shape: self.shape(), length }
    }
}

/// Marks a texel of one of 16 pairs: the first ones of pairs in the lower half of a number, in the order of the pairs, the second
/// ones in the upper. Where both halves are channels' samples, one bit of each tells of a pair.
#[inline(always)]
pub(crate) const fn mark(texel: usize) -> u32 {
    1 << (texel / 2 + texel % 2 * 16)
}

/// Marks of the pairs of a small window's row, given a bit for each texel.
#[inline(always)]
fn marks_of(texels: u8) -> u32 {
    const TEXELS: usize = 2 * PAIRS_UNDER;
    const MARKS: [u32; 1 << TEXELS] = {
        let mut marks = [0; 1 << TEXELS];
        let mut at = 0;
        while at < TEXELS << TEXELS {
            if (at / TEXELS) >> (at % TEXELS) & 1 == 1 {
                marks[at / TEXELS] |= mark(at % TEXELS);
            }
            at += 1;
        }
        marks
    };
    MARKS[usize::from(texels) % MARKS.len()]
}

/// How many numbers tell of a row of so many pairs which texels lie under the pixel.
#[inline(always)]
pub(crate) fn mark_words(pairs: usize) -> usize {
    pairs.div_ceil(16)
}

impl FixedWeights {
    /// Writes down a lane's window, and where it begins; false if that cannot be.
    #[inline(always)]
    fn write(&mut self, windows: &Windows, place: Place, corner: &mut [u32; 2]) -> bool {
        let Rounded { width, height, .. } = self.rounded;
        let (whole, left) = (windows.columns_within(), corner[0] as isize);
        // A window of whole pairs may reach beyond the view; then it begins earlier, if it can.
        let within = |shape: Shape, Origin { column, row }| {
            let beyond = left + column + 2 * shape.pairs as isize - whole.end as isize;
            Origin { column: column - beyond.max(0), row }
        };
        let small = self.rounded.shape(place.lane);
        let small = small.map(|(index, origin)| (index, within(Shape::SMALL[index], origin)));
        let is_small = |origin: Origin| origin.column < -1 || self.rounded.are_marks_early(place.lane, origin);
        let small = small.filter(|(_, origin)| is_small(*origin));
        let large = Shape::new(width.div_ceil(2), height, 0);
        let (shape, origin) = match small {
            Some((index, origin)) => (Shape::SMALL[index], origin),
            None => (large, within(large, Origin { column: 0, row: 0 })),
        };
        if origin.column < -1 || left + origin.column < whole.start as isize {
            return false;
        }
        *corner = [(left + origin.column) as u32, corner[1] + origin.row as u32];
        match small {
            Some((index, _)) => self.write_small(place, origin, index),
            None => self.write_large(windows, place, origin, shape),
        }
        true
    }

    #[inline(always)]
    fn write_small(&mut self, place: Place, origin: Origin, index: usize) {
        let Self { numbers, rounded } = self;
        let Shape { pairs, height, under } = Shape::SMALL[index];
        let marks = |row| marks_of(rounded.small_marks(place.lane, origin, under + row)) << (PAIRS_UNDER * row);
        let under = (0..ROWS_UNDER).fold(0, |all, row| all | marks(row));
        let header = Header::new(Some(index), rounded.bits, under, place);
        // Whatever the shape, as much is written: each row overwrites what followed the one before.
        let length = numbers.len();
        numbers.extend_from_slice(&[0; MOST]);
        let room: &mut [u32; MOST] = numbers[length..].first_chunk_mut().expect("there is as much room");
        room[0] = header.0;
        for (row, weights) in rounded.small_pairs(place.lane, origin).into_iter().enumerate() {
            room[1 + pairs.min(WIDEST) * row..][..weights.len()].copy_from_slice(&weights);
        }
        numbers.truncate(length + 1 + pairs * height);
    }

    fn write_large(&mut self, windows: &Windows, place: Place, origin: Origin, Shape { pairs, height, .. }: Shape) {
        let Self { numbers, rounded } = self;
        let lane = place.lane;
        numbers.push(Header::new(None, rounded.bits, 0, place).0);
        let words = |row| (0..pairs).step_by(16).map(move |first| (row, first..pairs.min(first + 16)));
        let words = windows.rows_under().flat_map(words);
        numbers.extend(words.map(|(row, pairs)| !rounded.marks(lane, origin, row, pairs)));
        for row in 0..height {
            numbers.extend(rounded.pairs(lane, origin, row, pairs));
        }
    }

    #[inline(always)]
    fn keep_lanes<S: Simd>(&mut self, simd: S, windows: &Windows, corners: &mut Corners, run: usize) -> bool {
        if !self.rounded.fill(simd, windows) {
            return false;
        }
        let length = self.numbers.len();
        for (lane, corner) in corners.iter_mut().enumerate() {
            let Some(corner) = corner else { continue };
            if !self.write(windows, Place { run, lane }, corner) {
                self.numbers.truncate(length);
                return false;
            }
        }
        true
    }
}

impl Weights for FixedWeights {
    fn pitch(width: usize) -> usize {
        FixedLight::pitch(width)
    }

    fn len(&self) -> usize {
        self.numbers.len()
    }

    fn keep(&mut self, windows: &Windows, corners: &mut Corners, run: usize) -> bool {
        let level = windows.level();
        dispatch!(level, simd => self.keep_lanes(simd, windows, corners, run))
    }

    fn truncate(&mut self, length: usize) {
        self.numbers.truncate(length);
    }

    fn settle<'a>(&mut self, groups: impl Iterator<Item = &'a [Run]>) {
        window_order::sort(&mut self.numbers, groups, |run, header| Header(header).told(run));
        self.rounded = Rounded::default();
    }

    fn bytes(&self) -> usize {
        self.numbers.capacity() * size_of::<u32>()
    }

    fn used_bytes(&self) -> usize {
        self.numbers.len() * size_of::<u32>()
    }
}
