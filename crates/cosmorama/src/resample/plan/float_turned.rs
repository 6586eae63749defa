//! Windows of floats in mirrors that show columns as rows: four texels that lie beside each other are of four rows.

use std::ops::Range;

use fearless_simd::{Simd, f32x4, f32x16, mask32x16, prelude::*, u8x64, u32x4, u32x16};

use super::float_shape::{BLOCK, ROWS_UNDER, Shape};
use super::float_window::{BLOCK_SAMPLES, Lines, Marks, SAMPLES, Sums, spread, way};
use super::texels::{Texels, Window};

/// A window of a small size, so wide and high as all mirrors see it: in these as many rows and columns.
#[derive(Clone, Copy)]
pub(super) struct TurnedWindow<'a, S: Simd, const N: usize, const R: usize, const WIDTH: usize, const HEIGHT: usize> {
    pub(super) simd: S,
    pub(super) texels: [Window<'a, f32, HEIGHT, WIDTH>; N],
    pub(super) weights: &'a [u32],
    pub(super) marks: Marks<S>,
}

impl<S: Simd, const N: usize, const R: usize, const WIDTH: usize, const HEIGHT: usize>
    TurnedWindow<'_, S, N, R, WIDTH, HEIGHT>
{
    /// Where the texels of its first four rows lie in a column, and the one after them: as texels run, and the other way.
    const BLOCK_AT: [usize; 2] = [0, HEIGHT - BLOCK];
    const LAST_AT: [usize; 2] = [HEIGHT - 1, 0];

    #[inline(always)]
    pub(super) fn sums<const UNDER: usize>(&self) -> Sums<S, N> {
        let mut sums = Sums::zero(self.simd);
        let rows = self.weights.as_chunks::<BLOCK>().0;
        let (a, b) = (u32x4::load_array_ref(self.simd, &rows[0]), u32x4::load_array_ref(self.simd, &rows[1]));
        let (c, d) = (u32x4::load_array_ref(self.simd, &rows[2]), u32x4::load_array_ref(self.simd, &rows[3]));
        // From right to left the last row comes first.
        let weights = [a.combine(b).combine(c.combine(d)), d.combine(c).combine(b.combine(a))];
        self.add_column::<UNDER>(&mut sums, weights, 0);
        self.add_column::<UNDER>(&mut sums, weights, 1);
        self.add_column::<UNDER>(&mut sums, weights, 2);
        self.add_column::<UNDER>(&mut sums, weights, 3);
        let after = &self.weights[BLOCK * HEIGHT..];
        if WIDTH > BLOCK {
            let weights = spread(self.simd, after.first_chunk().expect("weights of four rows"));
            for image in 0..N {
                sums.blocks[image] += self.block(image, BLOCK) * weights[way::<N, R>(image)];
            }
        }
        if HEIGHT > BLOCK {
            let weights = &self.weights[BLOCK * BLOCK..];
            self.add_last(&mut sums, 0, weights[0]);
            self.add_last(&mut sums, 1, weights[1]);
            self.add_last(&mut sums, 2, weights[2]);
            self.add_last(&mut sums, 3, weights[3]);
            if WIDTH > BLOCK {
                self.add_last(&mut sums, BLOCK, after[BLOCK]);
            }
        }
        sums
    }

    /// Adds the first four texels of a column, given the weights of four rows of four, for each way.
    #[inline(always)]
    fn add_column<const UNDER: usize>(&self, sums: &mut Sums<S, N>, weights: [u32x16<S>; 2], column: usize) {
        let one = u8x64::load_array_ref(self.simd, &ONE.0[column]);
        let weights: [f32x16<S>; 2] =
            [weights[0].swizzle_dyn_within_blocks(one).bitcast(), weights[1].swizzle_dyn_within_blocks(one).bitcast()];
        let mark = &MARK.0[UNDER];
        let is_beside = [self.marks.without(&mark[0][column]), self.marks.without(&mark[1][column])];
        for image in 0..N {
            let (texels, way) = (self.block(image, column), way::<N, R>(image));
            sums.blocks[image] += texels * weights[way];
            sums.bound(image, texels, is_beside[way]);
        }
    }

    #[inline(always)]
    fn block(&self, image: usize, column: usize) -> f32x16<S> {
        let first = Self::BLOCK_AT[way::<N, R>(image)];
        f32x16::load_array_ref(self.simd, self.texels[image].samples::<BLOCK_SAMPLES>(column, first))
    }

    /// Adds the texel of a column that lies in the row after the first four.
    #[inline(always)]
    fn add_last(&self, sums: &mut Sums<S, N>, column: usize, weight: u32) {
        let weight = f32x4::splat(self.simd, f32::from_bits(weight));
        for image in 0..N {
            let texel = self.texels[image].samples::<SAMPLES>(column, Self::LAST_AT[way::<N, R>(image)]);
            sums.last[image] += f32x4::load_array_ref(self.simd, texel) * weight;
        }
    }
}

/// In each block one of its four numbers, for all samples of a texel.
static ONE: Lines<[[u8; 64]; BLOCK]> = {
    let mut one = [[0; 64]; BLOCK];
    let mut at = 0;
    while at < 64 * BLOCK {
        one[at / 64][at % 64] = (4 * (at / 64) + at % 4) as u8;
        at += 1;
    }
    Lines(one)
};

/// Of each sample of a column's first four texels the texel's bit among those of the rows from the first or the second on, for each
/// way; none, if it is in no such row.
static MARK: Lines<[[[[u32; BLOCK_SAMPLES]; BLOCK]; 2]; 2]> = {
    let mut mark = [[[[0; BLOCK_SAMPLES]; BLOCK]; 2]; 2];
    let mut at = 0;
    while at < 2 * BLOCK * BLOCK_SAMPLES {
        let (under, column, sample) = (at / BLOCK_SAMPLES / BLOCK, at / BLOCK_SAMPLES % BLOCK, at % BLOCK_SAMPLES);
        let row = sample / SAMPLES;
        if under <= row && row < under + ROWS_UNDER {
            let bit = 1 << (BLOCK * (row - under) + column);
            mark[under][0][column][sample] = bit;
            mark[under][1][column][BLOCK_SAMPLES - 1 - sample] = bit;
        }
        at += 1;
    }
    Lines(mark)
};

/// What is known of a window of any size.
pub(super) struct Large<'a> {
    pub(super) shape: Shape,
    pub(super) under: Range<usize>,
    /// How many numbers tell of a row which texels lie under the pixel.
    pub(super) words: usize,
    pub(super) marks: &'a [u32],
    pub(super) weights: &'a [u32],
}

impl Large<'_> {
    /// Sums over it, in mirrors that go through them with columns for rows.
    #[inline(always)]
    pub(super) fn sums<S: Simd, const N: usize, const R: usize>(
        &self,
        simd: S,
        texels: &Texels<f32, N, R>,
        first: [u32; 2],
    ) -> Sums<S, N> {
        let Shape { width, height } = self.shape;
        let mut sums = Sums::zero(simd);
        let whole = height / BLOCK * BLOCK;
        for column in 0..width {
            let mut columns: [&[f32]; N] = [&[]; N];
            for (image, samples) in columns.iter_mut().enumerate() {
                *samples = texels.row(image, [first[1], first[0] + column as u32], height);
            }
            for row in (0..whole).step_by(BLOCK) {
                let weights = spread(simd, &std::array::from_fn(|at| self.weights[self.shape.index(row + at, column)]));
                let marks = (0..BLOCK).fold(0, |marks, at| marks | self.mark(row + at, column) << at);
                let is_beside = Marks::new(simd, marks).beside(0);
                for (image, samples) in columns.iter().enumerate() {
                    let way = way::<N, R>(image);
                    let first = if way == 0 { row } else { height - BLOCK - row };
                    let texels = f32x16::from_slice(simd, &samples[SAMPLES * first..][..BLOCK_SAMPLES]);
                    sums.blocks[image] += texels * weights[way];
                    sums.bound(image, texels, is_beside[way]);
                }
            }
            for row in whole..height {
                let weight = f32::from_bits(self.weights[self.shape.index(row, column)]);
                let is_beside = mask32x16::splat(simd, self.mark(row, column) == 0);
                for (image, samples) in columns.iter().enumerate() {
                    let at = if way::<N, R>(image) == 0 { row } else { height - 1 - row };
                    let texel = f32x4::from_slice(simd, &samples[SAMPLES * at..][..SAMPLES]);
                    sums.last[image] += texel * weight;
                    // Blocks of the same texel.
                    sums.bound(image, f32x16::block_splat(texel), is_beside);
                }
            }
        }
        sums
    }

    /// 1 if a texel lies under the pixel.
    #[inline(always)]
    fn mark(&self, row: usize, column: usize) -> u32 {
        if !self.under.contains(&row) {
            return 0;
        }
        self.marks[(row - self.under.start) * self.words + column / 32] >> (column % 32) & 1
    }
}
