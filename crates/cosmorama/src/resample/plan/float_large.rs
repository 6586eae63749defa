//! Windows of floats of any size, in mirrors that go through them one way or the other.

use std::ops::Range;

use fearless_simd::{Simd, f32x4, f32x16, mask32x16, prelude::*};

use super::float_shape::{BLOCK, Shape};
use super::float_window::{BLOCK_SAMPLES, Marks, SAMPLES, Sum, spread, way};
use super::texels::{Rows, Texels};

/// What is known of one.
pub(super) struct Large<'a> {
    pub(super) shape: Shape,
    /// The rows that may hold texels under the pixel.
    pub(super) under: Range<usize>,
    /// How many numbers tell of such a row which texels do.
    pub(super) words: usize,
    pub(super) marks: &'a [u32],
    pub(super) weights: &'a [u32],
}

/// A row of one in N mirrors, in the last R of them from right to left.
#[derive(Clone, Copy)]
struct Row<'a, const N: usize, const R: usize> {
    /// Its texels as they lie in memory, first those that are in blocks.
    blocks: [&'a [[f32; BLOCK_SAMPLES]]; N],
    others: [&'a [[f32; SAMPLES]]; N],
    weights: &'a [[u32; BLOCK]],
    other_weights: &'a [u32],
}

impl<'a, const N: usize, const R: usize> Row<'a, N, R> {
    /// Takes the next row of each mirror.
    #[inline(always)]
    fn next(rows: &mut [Rows<'a, f32>; N], weights: &'a [u32], other_weights: &'a [u32]) -> Self {
        let weights = weights.as_chunks().0;
        let (mut blocks, mut others): ([&[[f32; BLOCK_SAMPLES]]; N], [&[f32]; N]) = ([&[]; N], [&[]; N]);
        for image in 0..N {
            let samples = rows[image].next().unwrap_or_default();
            (blocks[image], others[image]) = if way::<N, R>(image) == 0 {
                samples.as_chunks()
            } else {
                let (others, blocks) = samples.as_rchunks();
                (blocks, others)
            };
        }
        // Checked here once, and not at each texel.
        let mut row = Self { blocks, others: [&[]; N], weights, other_weights };
        for image in 0..N {
            row.blocks[image] = &blocks[image][..weights.len()];
            row.others[image] = &others[image].as_chunks().0[..other_weights.len()];
        }
        row
    }

    #[inline(always)]
    fn block<S: Simd>(&self, simd: S, image: usize, index: usize) -> f32x16<S> {
        let blocks = self.blocks[image];
        let index = if way::<N, R>(image) == 0 { index } else { blocks.len() - 1 - index };
        f32x16::load_array_ref(simd, &blocks[index])
    }

    #[inline(always)]
    fn other<S: Simd>(&self, simd: S, image: usize, index: usize) -> f32x4<S> {
        let others = self.others[image];
        let index = if way::<N, R>(image) == 0 { index } else { others.len() - 1 - index };
        f32x4::load_array_ref(simd, &others[index])
    }

    /// Adds it, if none of its texels lies under the pixel.
    #[inline(always)]
    fn add<S: Simd>(&self, simd: S, sums: &mut [Sum<S>; N]) {
        for (index, weights) in self.weights.iter().enumerate() {
            let weights = spread(simd, weights);
            for (image, sum) in sums.iter_mut().enumerate() {
                sum.blocks += self.block(simd, image, index) * weights[way::<N, R>(image)];
            }
        }
        for (index, weight) in self.other_weights.iter().enumerate() {
            for (image, sum) in sums.iter_mut().enumerate() {
                sum.last += self.other(simd, image, index) * f32::from_bits(*weight);
            }
        }
    }

    /// Adds it, given which of its texels do.
    #[inline(always)]
    fn add_bounding<S: Simd>(&self, simd: S, sums: &mut [Sum<S>; N], marks: &[u32]) {
        for (index, weights) in self.weights.iter().enumerate() {
            let weights = spread(simd, weights);
            let is_beside = Marks::new(simd, marks[BLOCK * index / 32] >> (BLOCK * index % 32)).beside(0);
            for (image, sum) in sums.iter_mut().enumerate() {
                let (texels, way) = (self.block(simd, image, index), way::<N, R>(image));
                sum.blocks += texels * weights[way];
                sum.bound(texels, is_beside[way]);
            }
        }
        for (column, (index, weight)) in (BLOCK * self.weights.len()..).zip(self.other_weights.iter().enumerate()) {
            let is_under = marks[column / 32] >> (column % 32) & 1 == 1;
            for (image, sum) in sums.iter_mut().enumerate() {
                let texel = self.other(simd, image, index);
                sum.last += texel * f32::from_bits(*weight);
                if is_under {
                    // Blocks of the same texel.
                    sum.bound(f32x16::block_splat(texel), mask32x16::splat(simd, false));
                }
            }
        }
    }
}

impl Large<'_> {
    /// Sums over it, in mirrors that go through its rows as rows.
    #[inline(always)]
    pub(super) fn upright<S: Simd, const N: usize, const R: usize>(
        &self,
        simd: S,
        texels: &Texels<f32, N, R>,
        first: [u32; 2],
    ) -> [Sum<S>; N] {
        let Shape { width, height } = self.shape;
        let whole = self.shape.in_blocks();
        let (mut weights, mut other_weights) = self.weights.split_at(whole * height);
        let (mut marks, mut sums) = (self.marks, [Sum::zero(simd); N]);
        let mut rows = texels.rows(first, [width, height]);
        for row in 0..height {
            let (these, others);
            (these, weights) = weights.split_at(whole);
            (others, other_weights) = other_weights.split_at(width - whole);
            let next = Row::<N, R>::next(&mut rows, these, others);
            if self.under.contains(&row) {
                let these;
                (these, marks) = marks.split_at(self.words);
                next.add_bounding(simd, &mut sums, these);
            } else {
                next.add(simd, &mut sums);
            }
        }
        sums
    }

    /// Sums over it, in mirrors that go through them with columns for rows.
    #[inline(always)]
    pub(super) fn turned<S: Simd, const N: usize, const R: usize>(
        &self,
        simd: S,
        texels: &Texels<f32, N, R>,
        first: [u32; 2],
    ) -> [Sum<S>; N] {
        let Shape { width, height } = self.shape;
        let mut sums = [Sum::zero(simd); N];
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
                for (image, (sum, samples)) in sums.iter_mut().zip(columns).enumerate() {
                    let way = way::<N, R>(image);
                    let first = if way == 0 { row } else { height - BLOCK - row };
                    let texels = f32x16::from_slice(simd, &samples[SAMPLES * first..][..BLOCK_SAMPLES]);
                    sum.blocks += texels * weights[way];
                    sum.bound(texels, is_beside[way]);
                }
            }
            for row in whole..height {
                let weight = f32::from_bits(self.weights[self.shape.index(row, column)]);
                let is_beside = mask32x16::splat(simd, self.mark(row, column) == 0);
                for (image, (sum, samples)) in sums.iter_mut().zip(columns).enumerate() {
                    let at = if way::<N, R>(image) == 0 { row } else { height - 1 - row };
                    let texel = f32x4::from_slice(simd, &samples[SAMPLES * at..][..SAMPLES]);
                    sum.last += texel * weight;
                    // Blocks of the same texel.
                    sum.bound(f32x16::block_splat(texel), is_beside);
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
