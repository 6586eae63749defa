//! Windows of floats, in mirrors that go through them the same way.
//!
//! Four texels of a row are weighed together, as they lie in memory; what their four columns add up to is added at the end. The order
//! in which sums are made is the same whatever the instructions.
//!
//! The bounds of what lies under a pixel are found where nobody asks for anti-ringing, too: to leave them out there would take all
//! this code once more, for each size, way and number of mirrors. What is rendered without takes as long as with it.

use std::ops::Range;

use fearless_simd::{Simd, f32x4, f32x16, prelude::*, u8x64, u32x4};

use super::float_shape::{BLOCK, Header, ROWS_UNDER, Shape, Small, mark_words};
use super::texels::{FloatWindow, Texels};

/// Samples of a texel, and of a block of them.
const SAMPLES: usize = 4;
const BLOCK_SAMPLES: usize = BLOCK * SAMPLES;

/// A pixel's window in N mirrors: R of them, all or none, from right to left.
#[derive(Clone, Copy)]
pub(super) struct Window<'a, S, const N: usize, const R: usize> {
    pub(super) simd: S,
    /// Those of the view.
    pub(super) texels: &'a Texels<'a, f32, N, R>,
    /// Where it begins.
    pub(super) first: [u32; 2],
}

impl<'a, S: Simd, const N: usize, const R: usize> Window<'a, S, N, R> {
    /// Sums over a window of one of the sizes of [`Small::ALL`], and how many numbers tell of it. Written out: loops would stay
    /// loops.
    #[inline(always)]
    pub(super) fn small<const WIDTH: usize, const HEIGHT: usize, const UNDER: usize>(
        self,
        header: Header,
        numbers: &[u32],
    ) -> (Sums<S, N>, usize) {
        debug_assert_eq!(
            Small::ALL.get(header.index() as usize),
            Some(&Small { shape: Shape { width: WIDTH, height: HEIGHT }, under: UNDER }),
            "the table's order is that of the match"
        );
        let texels = self.texels.windows::<1, WIDTH, HEIGHT>(self.first);
        let row = SmallRow::<S, N, R, WIDTH, HEIGHT> { simd: self.simd, texels };
        let (marks, weights) = (header.marks(), &numbers[1..][..WIDTH * HEIGHT]);
        let marks = |row: usize| marks >> (BLOCK * (row - UNDER));
        let mut sums = row.first::<UNDER>(weights, marks(UNDER));
        const { assert!(ROWS_UNDER == 3 && UNDER <= 1 && (HEIGHT == 4 || HEIGHT == 5)) };
        if UNDER == 0 {
            row.add_bounding(&mut sums, weights, 1, marks(1));
        }
        row.add_bounding(&mut sums, weights, 2, marks(2));
        if UNDER == 1 {
            row.add_bounding(&mut sums, weights, 3, marks(3));
        } else {
            row.add(&mut sums, weights, 3);
        }
        if HEIGHT == 5 {
            row.add(&mut sums, weights, 4);
        }
        if WIDTH > BLOCK {
            row.add_last_column(&mut sums, &weights[BLOCK * HEIGHT..]);
        }
        (sums, 1 + WIDTH * HEIGHT)
    }

    /// The same of any size, whose rows from `under` on may hold texels under the pixel.
    #[inline(always)]
    pub(super) fn large(self, shape: Shape, under: Range<usize>, numbers: &[u32]) -> (Sums<S, N>, usize) {
        let Self { simd, .. } = self;
        let words = mark_words(shape.width);
        let (all_marks, weights) = numbers[1..].split_at(under.len() * words);
        let whole = shape.in_blocks();
        let (in_blocks, others) = weights[..shape.area()].split_at(whole * shape.height);
        let mut sums = Sums::zero(simd);
        for row in 0..shape.height {
            let marks = if under.contains(&row) { &all_marks[(row - under.start) * words..][..words] } else { &[] };
            let rows = self.row(row, shape.width);
            for (block, weights) in in_blocks[row * whole..][..whole].as_chunks().0.iter().enumerate() {
                let column = BLOCK * block;
                let weights = spread::<S, R>(simd, weights);
                let marks = marks.get(column / 32).map(|marks| marks >> (column % 32));
                let first = if R > 0 { shape.width - BLOCK - column } else { column };
                for (image, samples) in rows.iter().enumerate() {
                    let texels = f32x16::from_slice(simd, &samples[SAMPLES * first..][..BLOCK_SAMPLES]);
                    sums.blocks[image] += texels * weights;
                    if let Some(marks) = marks {
                        sums.bound(image, texels, beyond::<S, R>(simd, marks));
                    }
                }
            }
            let rest = shape.width - whole;
            for (column, weight) in (whole..shape.width).zip(&others[row * rest..][..rest]) {
                let weight = f32::from_bits(*weight);
                let is_under = marks.get(column / 32).is_some_and(|marks| marks >> (column % 32) & 1 == 1);
                let at = if R > 0 { shape.width - 1 - column } else { column };
                for (image, samples) in rows.iter().enumerate() {
                    let texel = f32x4::from_slice(simd, &samples[SAMPLES * at..][..SAMPLES]);
                    sums.last[image] += texel * weight;
                    if is_under {
                        // Blocks of the same texel.
                        let texels = f32x16::block_splat(texel);
                        sums.bound(image, texels, f32x16::splat(simd, 0.0));
                    }
                }
            }
        }
        (sums, 1 + all_marks.len() + shape.area())
    }

    /// The samples of a row, in each mirror.
    #[inline(always)]
    fn row(&self, row: usize, width: usize) -> [&'a [f32]; N] {
        let mut rows: [&'a [f32]; N] = [&[]; N];
        for (image, samples) in rows.iter_mut().enumerate() {
            *samples = self.texels.row(image, [self.first[0], self.first[1] + row as u32], width);
        }
        rows
    }
}

/// The rows of a window of a small size.
#[derive(Clone, Copy)]
struct SmallRow<'a, S, const N: usize, const R: usize, const WIDTH: usize, const HEIGHT: usize> {
    simd: S,
    texels: [FloatWindow<'a, WIDTH, HEIGHT>; N],
}

impl<S: Simd, const N: usize, const R: usize, const WIDTH: usize, const HEIGHT: usize>
    SmallRow<'_, S, N, R, WIDTH, HEIGHT>
{
    /// Where its first four columns lie in memory, and the one after them.
    const BLOCK_AT: usize = if R > 0 { WIDTH - BLOCK } else { 0 };
    const LAST_AT: usize = if R > 0 { 0 } else { WIDTH - 1 };

    /// Sums over the first row and, if it is not that, the first of those whose texels may lie under the pixel.
    #[inline(always)]
    fn first<const UNDER: usize>(&self, weights: &[u32], marks: u32) -> Sums<S, N> {
        let mut sums = Sums::zero(self.simd);
        let (first, beyond) = (self.weights(weights, 0), beyond::<S, R>(self.simd, marks));
        for image in 0..N {
            sums.blocks[image] = self.block(image, 0) * first;
            let texels = self.block(image, UNDER);
            (sums.least[image], sums.greatest[image]) = (texels + beyond, texels - beyond);
        }
        if UNDER > 0 {
            let weights = self.weights(weights, UNDER);
            for image in 0..N {
                sums.blocks[image] += self.block(image, UNDER) * weights;
            }
        }
        sums
    }

    /// Adds a block of a row none of whose texels lies under the pixel.
    #[inline(always)]
    fn add(&self, sums: &mut Sums<S, N>, weights: &[u32], row: usize) {
        let weights = self.weights(weights, row);
        for image in 0..N {
            sums.blocks[image] += self.block(image, row) * weights;
        }
    }

    /// Adds one some of whose texels may.
    #[inline(always)]
    fn add_bounding(&self, sums: &mut Sums<S, N>, weights: &[u32], row: usize, marks: u32) {
        let weights = self.weights(weights, row);
        let beyond = beyond::<S, R>(self.simd, marks);
        for image in 0..N {
            let texels = self.block(image, row);
            sums.blocks[image] += texels * weights;
            sums.bound(image, texels, beyond);
        }
    }

    #[inline(always)]
    fn weights(&self, weights: &[u32], row: usize) -> f32x16<S> {
        spread::<S, R>(self.simd, &weights.as_chunks().0[row])
    }

    #[inline(always)]
    fn block(&self, image: usize, row: usize) -> f32x16<S> {
        f32x16::load_array_ref(self.simd, self.texels[image].samples::<BLOCK_SAMPLES>(row, Self::BLOCK_AT))
    }

    /// Adds the column after the blocks.
    #[inline(always)]
    fn add_last_column(&self, sums: &mut Sums<S, N>, weights: &[u32]) {
        self.add_last(sums, weights, 0);
        self.add_last(sums, weights, 1);
        self.add_last(sums, weights, 2);
        self.add_last(sums, weights, 3);
        if HEIGHT == 5 {
            self.add_last(sums, weights, 4);
        }
    }

    #[inline(always)]
    fn add_last(&self, sums: &mut Sums<S, N>, weights: &[u32], row: usize) {
        let weight = f32x4::splat(self.simd, f32::from_bits(weights[row]));
        for image in 0..N {
            let texel = self.texels[image].samples::<SAMPLES>(row, Self::LAST_AT);
            sums.last[image] += f32x4::load_array_ref(self.simd, texel) * weight;
        }
    }
}

/// Four weights, each for all samples of a texel, in the order in which texels lie.
#[inline(always)]
fn spread<S: Simd, const R: usize>(simd: S, weights: &[u32; BLOCK]) -> f32x16<S> {
    let weights: f32x4<S> = u32x4::load_array_ref(simd, weights).bitcast();
    let order = if R > 0 { &ORDER[1] } else { &ORDER[0] };
    f32x16::block_splat(weights).swizzle_dyn_within_blocks(u8x64::load_array_ref(simd, order))
}

/// From four numbers in each block to one of them: the first in the first block, or the last.
static ORDER: [[u8; 64]; 2] = {
    let mut order = [[0; 64]; 2];
    let mut at = 0;
    while at < 64 {
        let within = (at % 4) as u8;
        order[0][at] = 4 * (at / 16) as u8 + within;
        order[1][at] = 4 * (3 - at / 16) as u8 + within;
        at += 1;
    }
    order
};

/// Zero for the samples of those of four texels that are marked, infinity for others, in the order in which texels lie.
#[inline(always)]
fn beyond<S: Simd, const R: usize>(simd: S, marks: u32) -> f32x16<S> {
    let table = if R > 0 { &BEYOND.0[1] } else { &BEYOND.0[0] };
    f32x16::load_array_ref(simd, &table[marks as usize % 16])
}

/// In whole lines of memory.
#[repr(align(64))]
struct Lines<T>(T);

static BEYOND: Lines<[[[f32; BLOCK_SAMPLES]; 16]; 2]> = {
    let mut beyond = [[[0.0; BLOCK_SAMPLES]; 16]; 2];
    let mut marks = 0;
    while marks < 16 {
        let mut at = 0;
        while at < BLOCK_SAMPLES {
            let texel = at / SAMPLES;
            if marks >> texel & 1 == 0 {
                beyond[0][marks][at] = f32::INFINITY;
            }
            if marks >> (BLOCK - 1 - texel) & 1 == 0 {
                beyond[1][marks][at] = f32::INFINITY;
            }
            at += 1;
        }
        marks += 1;
    }
    Lines(beyond)
};

/// What adds up over a window, and the bounds of what lies under the pixel, column by column of the blocks.
pub(super) struct Sums<S: Simd, const N: usize> {
    blocks: [f32x16<S>; N],
    /// Over what is in no block.
    last: [f32x4<S>; N],
    least: [f32x16<S>; N],
    greatest: [f32x16<S>; N],
}

impl<S: Simd, const N: usize> Sums<S, N> {
    #[inline(always)]
    fn zero(simd: S) -> Self {
        Self {
            blocks: [f32x16::splat(simd, 0.0); N],
            last: [f32x4::splat(simd, 0.0); N],
            least: [f32x16::splat(simd, f32::INFINITY); N],
            greatest: [f32x16::splat(simd, f32::NEG_INFINITY); N],
        }
    }

    /// Notes texels that lie under the pixel, where nothing is added to them.
    #[inline(always)]
    fn bound(&mut self, image: usize, texels: f32x16<S>, beyond: f32x16<S>) {
        self.least[image] = self.least[image].min(texels + beyond);
        self.greatest[image] = self.greatest[image].max(texels - beyond);
    }

    /// The sum in a mirror; within what lies under the pixel, if that is asked for.
    #[inline(always)]
    pub(super) fn average(&self, image: usize, is_bounded: bool) -> f32x4<S> {
        let (a, b) = self.blocks[image].split();
        let (a, b) = (a + b).split();
        let sum = a + b + self.last[image];
        if !is_bounded {
            return sum;
        }
        let (a, b) = self.least[image].split();
        let (a, b) = a.min(b).split();
        let least = a.min(b);
        let (a, b) = self.greatest[image].split();
        let (a, b) = a.max(b).split();
        sum.max(least).min(a.max(b))
    }
}
