//! Windows of floats in transposed mirror images, where four texels that are neighbours in memory belong to four rows.

use fearless_simd::{Simd, f32x4, f32x16, prelude::*, u8x64, u32x4, u32x16};

use super::weights::BLOCK;
use super::window::{BLOCK_SAMPLES, Lines, Marks, SAMPLES, Sum, spread, way};
use crate::render::apply::texels::Window;
use crate::render::plan::window_format::ROWS_UNDER;

/// A small window in transposed mirror images. `WIDTH` and `HEIGHT` are its size in the picture that is mirrored; in
/// memory it has `WIDTH` rows and `HEIGHT` columns.
#[derive(Clone, Copy)]
pub(crate) struct TurnedWindow<'a, S: Simd, const N: usize, const R: usize, const WIDTH: usize, const HEIGHT: usize> {
    pub(crate) simd: S,
    pub(crate) texels: [Window<'a, f32, HEIGHT, WIDTH>; N],
    pub(crate) weights: &'a [u32],
    pub(crate) marks: Marks<S>,
}

impl<S: Simd, const N: usize, const R: usize, const WIDTH: usize, const HEIGHT: usize>
    TurnedWindow<'_, S, N, R, WIDTH, HEIGHT>
{
    /// Index in a column of the texels of the first four rows, and of the row after them: in forward and in reversed
    /// order.
    const BLOCK_AT: [usize; 2] = [0, HEIGHT - BLOCK];
    const LAST_AT: [usize; 2] = [HEIGHT - 1, 0];

    #[inline(always)]
    pub(crate) fn sums<const UNDER: usize>(&self) -> [Sum<S>; N] {
        let mut sums = [Sum::zero(self.simd); N];
        let rows = self.weights.as_chunks::<BLOCK>().0;
        let (a, b) = (u32x4::load_array_ref(self.simd, &rows[0]), u32x4::load_array_ref(self.simd, &rows[1]));
        let (c, d) = (u32x4::load_array_ref(self.simd, &rows[2]), u32x4::load_array_ref(self.simd, &rows[3]));
        // In reversed order the last row comes first.
        let weights = [a.combine(b).combine(c.combine(d)), d.combine(c).combine(b.combine(a))];
        self.add_column::<UNDER>(&mut sums, weights, 0);
        self.add_column::<UNDER>(&mut sums, weights, 1);
        self.add_column::<UNDER>(&mut sums, weights, 2);
        self.add_column::<UNDER>(&mut sums, weights, 3);
        let after = &self.weights[BLOCK * HEIGHT..];
        if WIDTH > BLOCK {
            let weights = spread(self.simd, after.first_chunk().expect("weights of four rows"));
            for (image, sum) in sums.iter_mut().enumerate() {
                sum.blocks += self.block(image, BLOCK) * weights[way::<N, R>(image)];
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

    /// Adds the first four texels of a column, given the weights of four rows of four, in forward and in reversed
    /// order.
    #[inline(always)]
    fn add_column<const UNDER: usize>(&self, sums: &mut [Sum<S>; N], weights: [u32x16<S>; 2], column: usize) {
        let one = u8x64::load_array_ref(self.simd, &ONE.0[column]);
        let weights: [f32x16<S>; 2] =
            [weights[0].swizzle_dyn_within_blocks(one).bitcast(), weights[1].swizzle_dyn_within_blocks(one).bitcast()];
        let mark = &MARK.0[UNDER];
        let is_beside = [self.marks.without(&mark[0][column]), self.marks.without(&mark[1][column])];
        for (image, sum) in sums.iter_mut().enumerate() {
            let (texels, way) = (self.block(image, column), way::<N, R>(image));
            sum.blocks += texels * weights[way];
            sum.bound(texels, is_beside[way]);
        }
    }

    #[inline(always)]
    fn block(&self, image: usize, column: usize) -> f32x16<S> {
        let first = Self::BLOCK_AT[way::<N, R>(image)];
        f32x16::load_array_ref(self.simd, self.texels[image].samples::<BLOCK_SAMPLES>(column, first))
    }

    /// Adds the texel of a column that lies in the row after the first four.
    #[inline(always)]
    fn add_last(&self, sums: &mut [Sum<S>; N], column: usize, weight: u32) {
        let weight = f32x4::splat(self.simd, f32::from_bits(weight));
        for (image, sum) in sums.iter_mut().enumerate() {
            let texel = self.texels[image].samples::<SAMPLES>(column, Self::LAST_AT[way::<N, R>(image)]);
            sum.last += f32x4::load_array_ref(self.simd, texel) * weight;
        }
    }
}

/// Byte order that repeats, in each block, one of its four numbers for all samples of a texel.
static ONE: Lines<[[u8; 64]; BLOCK]> = {
    let mut one = [[0; 64]; BLOCK];
    let mut at = 0;
    while at < 64 * BLOCK {
        one[at / 64][at % 64] = (4 * (at / 64) + at % 4) as u8;
        at += 1;
    }
    Lines(one)
};

/// Mark bits of each sample of a column's first four texels, in forward and in reversed order. Bits count from the
/// first or from the second row on. A texel in none of the marked rows has no bit.
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
