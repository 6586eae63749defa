//! Windows of floats of any size, in mirror images of either direction.

use fearless_simd::{Simd, f32x4, f32x16, mask32x16, prelude::*};

use super::weights::{BLOCK, in_blocks, weight_index};
use super::window::{BLOCK_SAMPLES, Marks, SAMPLES, Sum, spread, way};
use crate::render::apply::texels::Texels;
use crate::render::plan::window_format::{Kept, Shape};

/// A row of a window in N mirror images. In the last R of them, texels run from right to left.
#[derive(Clone, Copy)]
struct Row<'a, const N: usize, const R: usize> {
    /// Texels as they lie in memory, first those that are in blocks.
    blocks: [&'a [[f32; BLOCK_SAMPLES]]; N],
    others: [&'a [[f32; SAMPLES]]; N],
    weights: &'a [[u32; BLOCK]],
    other_weights: &'a [u32],
}

impl<'a, const N: usize, const R: usize> Row<'a, N, R> {
    /// Takes `width` texels of a row in each mirror image.
    #[inline(always)]
    fn new(
        texels: &Texels<'a, f32, N, R>,
        (corner, width): ([u32; 2], usize),
        weights: &'a [u32],
        other_weights: &'a [u32],
    ) -> Self {
        let weights = weights.as_chunks().0;
        let (mut blocks, mut others): ([&[[f32; BLOCK_SAMPLES]]; N], [&[f32]; N]) = ([&[]; N], [&[]; N]);
        for image in 0..N {
            let samples = texels.row(image, corner, width);
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

    /// Adds the row, if none of its texels lies under the pixel.
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

    /// Adds the row, given which of its texels lie under the pixel.
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
                    // A block that repeats the texel.
                    sum.bound(f32x16::block_splat(texel), mask32x16::splat(simd, false));
                }
            }
        }
    }
}

impl Kept<'_> {
    /// Sums over the window, in mirror images that are not transposed.
    #[inline(always)]
    pub(crate) fn upright<S: Simd, const N: usize, const R: usize>(
        &self,
        simd: S,
        texels: &Texels<f32, N, R>,
        first: [u32; 2],
    ) -> [Sum<S>; N] {
        let Shape { width, height, .. } = self.shape;
        let whole = in_blocks(self.shape);
        let (mut weights, mut other_weights) = self.weights.split_at(whole * height);
        let mut sums = [Sum::zero(simd); N];
        for row in 0..height {
            let (these, others);
            (these, weights) = weights.split_at(whole);
            (others, other_weights) = other_weights.split_at(width - whole);
            let next = Row::<N, R>::new(texels, ([first[0], first[1] + row as u32], width), these, others);
            match self.marks_of(row) {
                Some(marks) => next.add_bounding(simd, &mut sums, marks),
                None => next.add(simd, &mut sums),
            }
        }
        sums
    }

    /// Sums over the window, in transposed mirror images.
    #[inline(always)]
    pub(crate) fn turned<S: Simd, const N: usize, const R: usize>(
        &self,
        simd: S,
        texels: &Texels<f32, N, R>,
        first: [u32; 2],
    ) -> [Sum<S>; N] {
        let Shape { width, height, .. } = self.shape;
        let mut sums = [Sum::zero(simd); N];
        let whole = height / BLOCK * BLOCK;
        for column in 0..width {
            let mut columns: [&[f32]; N] = [&[]; N];
            for (image, samples) in columns.iter_mut().enumerate() {
                *samples = texels.row(image, [first[1], first[0] + column as u32], height);
            }
            for row in (0..whole).step_by(BLOCK) {
                let weights =
                    spread(simd, &std::array::from_fn(|at| self.weights[weight_index(self.shape, [row + at, column])]));
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
                let weight = f32::from_bits(self.weights[weight_index(self.shape, [row, column])]);
                let is_beside = mask32x16::splat(simd, self.mark(row, column) == 0);
                for (image, (sum, samples)) in sums.iter_mut().zip(columns).enumerate() {
                    let at = if way::<N, R>(image) == 0 { row } else { height - 1 - row };
                    let texel = f32x4::from_slice(simd, &samples[SAMPLES * at..][..SAMPLES]);
                    sum.last += texel * weight;
                    // A block that repeats the texel.
                    sum.bound(f32x16::block_splat(texel), is_beside);
                }
            }
        }
        sums
    }

    /// Returns 1 if a texel lies under the pixel, else 0.
    #[inline(always)]
    fn mark(&self, row: usize, column: usize) -> u32 {
        self.marks_of(row).map_or(0, |marks| marks[column / 32] >> (column % 32) & 1)
    }
}

#[cfg(test)]
mod tests {
    use std::ops::Range;

    use fearless_simd::{Level, dispatch};

    use super::*;
    use crate::render::plan::symmetry::Walk;

    /// Side of a square view, in which columns and rows can be exchanged.
    const SIDE: usize = 40;

    /// Walks of texels as they lie, upside down, and both of these from right to left.
    const WALKS: [Walk; 4] = [
        Walk { first: 0, is_turned: false, is_reversed: false, down: SIDE as i32 },
        Walk { first: (SIDE * (SIDE - 1)) as u32, is_turned: false, is_reversed: false, down: -(SIDE as i32) },
        Walk { first: SIDE as u32 - 1, is_turned: false, is_reversed: true, down: SIDE as i32 },
        Walk { first: (SIDE * SIDE) as u32 - 1, is_turned: false, is_reversed: true, down: -(SIDE as i32) },
    ];

    /// Returns a number between 0 and 1 that looks random.
    fn noise(at: usize) -> f32 {
        (at.wrapping_mul(2_654_435_761) >> 7 & 1023) as f32 / 1023.0
    }

    /// A window of noise, and its first texel.
    struct Case {
        shape: Shape,
        first: [u32; 2],
        under: Range<usize>,
        /// Number added to each weight, so that sums are beyond one bound or the other.
        bias: f32,
    }

    impl Case {
        fn weight(&self, row: usize, column: usize) -> f32 {
            noise(31 * row + column) - 0.5 + self.bias
        }

        fn is_under(&self, row: usize, column: usize) -> bool {
            // Some texels at random, and the last one of each row.
            let is_last = column + 1 == self.shape.width;
            self.under.contains(&row) && (noise(77 * row + 3 * column) < 0.3 || is_last)
        }

        /// Returns the light of a texel of the window in a mirror image.
        fn texel(&self, samples: &[f32], walk: &Walk, is_turned: bool, [row, column]: [usize; 2]) -> [f32; SAMPLES] {
            let (across, down) = if is_turned { (row, column) } else { (column, row) };
            let [first_across, first_down] = if is_turned { [self.first[1], self.first[0]] } else { self.first };
            let across = (first_across as usize + across) as i32 * if walk.is_reversed { -1 } else { 1 };
            let at = walk.first as i32 + across + walk.down * (first_down as usize + down) as i32;
            samples.as_chunks().0[at as usize]
        }

        /// Computes the sum in a mirror image by a plain loop, without and with its bounds.
        fn expected(&self, samples: &[f32], walk: &Walk, is_turned: bool) -> [[f32; SAMPLES]; 2] {
            let mut sum = [0f64; SAMPLES];
            let (mut least, mut greatest) = ([f32::INFINITY; SAMPLES], [f32::NEG_INFINITY; SAMPLES]);
            for row in 0..self.shape.height {
                for column in 0..self.shape.width {
                    let texel = self.texel(samples, walk, is_turned, [row, column]);
                    for sample in 0..SAMPLES {
                        sum[sample] += f64::from(texel[sample]) * f64::from(self.weight(row, column));
                        if self.is_under(row, column) {
                            least[sample] = least[sample].min(texel[sample]);
                            greatest[sample] = greatest[sample].max(texel[sample]);
                        }
                    }
                }
            }
            let sum = sum.map(|sum| sum as f32);
            [sum, std::array::from_fn(|sample| sum[sample].max(least[sample]).min(greatest[sample]))]
        }

        /// Checks the sums in all four mirror images at once.
        fn assert(&self, is_turned: bool) {
            let samples: Vec<f32> = (0..SAMPLES * SIDE * SIDE).map(noise).collect();
            let texels = Texels::<f32, 4, 2>::new(&samples, WALKS, [SIDE, SIDE]);
            let Shape { width, height, .. } = self.shape;
            let words = self.shape.mark_words();
            let mut marks = vec![0; words * self.under.len()];
            let mut weights = vec![0; self.shape.area()];
            for row in 0..height {
                for column in 0..width {
                    weights[weight_index(self.shape, [row, column])] = self.weight(row, column).to_bits();
                    if self.is_under(row, column) {
                        marks[(row - self.under.start) * words + column / 32] |= 1 << (column % 32);
                    }
                }
            }
            let under = self.under.clone();
            let kept = Kept { shape: self.shape, under, marks: &marks, weights: &weights };
            let found = averages(&kept, &texels, self.first, is_turned);
            for (found, walk) in found.iter().zip(&WALKS) {
                let expected = self.expected(&samples, walk, is_turned);
                for (found, expected) in found.as_flattened().iter().zip(expected.as_flattened()) {
                    let is_near = (found - expected).abs() < 1e-4 * (1.0 + expected.abs());
                    assert!(is_near, "{found} is not {expected}: {:?} {:?} {is_turned}", self.shape, self.under);
                }
            }
        }
    }

    /// Returns the sums in each mirror image, without and with their bounds.
    fn averages(
        large: &Kept,
        texels: &Texels<f32, 4, 2>,
        first: [u32; 2],
        is_turned: bool,
    ) -> [[[f32; SAMPLES]; 2]; 4] {
        let level = Level::new();
        dispatch!(level, simd => {
            let sums = if is_turned { large.turned(simd, texels, first) } else { large.upright(simd, texels, first) };
            sums.map(|sum| [sum.average(false), sum.average(true)].map(|light| {
                let mut samples = [0.0; SAMPLES];
                light.store_slice(&mut samples);
                samples
            }))
        })
    }

    /// Tests widths with and without texels beyond whole blocks, and beyond whole words of marks. Rows under the pixel
    /// lie at either end, between, or everywhere.
    #[test]
    fn sums_are_those_of_a_plain_loop() {
        for [width, height] in [[1, 1], [3, 9], [4, 4], [8, 3], [9, 5], [10, 8], [31, 6], [32, 7], [33, 5], [39, 33]] {
            let shape = Shape { width, height, under: 0 };
            let middle = height / 3;
            for under in [0..1, middle..height.min(middle + 2), height - 1..height, 0..height] {
                for bias in [0.0, -1.0, 1.0] {
                    let first = [(SIDE - width) as u32, (SIDE - height) as u32 / 2];
                    let case = Case { shape, first, under: under.clone(), bias };
                    case.assert(false);
                    // Transposed, `first` is a row and a column of the view.
                    case.assert(true);
                }
            }
        }
    }
}
