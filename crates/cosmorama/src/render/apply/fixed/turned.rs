//! Large windows of integers in transposed mirror images, where the two texels of a pair lie above each other.

use fearless_simd::{Simd, i16x8, prelude::*};

use super::blocks::Blocks;
use super::window::Sums;
use crate::render::apply::texels::Texels;
use crate::render::plan::window_format::{Kept, Shape};

impl Kept<'_> {
    /// Adds the products of a window of any size, transposed.
    #[inline(always)]
    pub(crate) fn add_turned<S: Simd, V: Blocks<S, N>, const N: usize, const R: usize>(
        &self,
        simd: S,
        texels: &Texels<i16, N, R>,
        first: [u32; 2],
        sums: &mut Sums<S, V, N>,
    ) {
        let Shape { width, height, .. } = self.shape;
        for pair in 0..width / 2 {
            let mut rows: [[&[i16]; 2]; N] = [[&[]; 2]; N];
            for (image, rows) in rows.iter_mut().enumerate() {
                for (below, samples) in rows.iter_mut().enumerate() {
                    *samples = texels.row(image, [first[1], first[0] + (2 * pair + below) as u32], height);
                }
            }
            for row in 0..height {
                let mut blocks = [i16x8::splat(simd, 0); N];
                for (image, block) in blocks.iter_mut().enumerate() {
                    let column = if image < N - R { row } else { height - 1 - row };
                    let [above, below] = rows[image].map(|samples| first_half(simd, &samples[4 * column..]));
                    *block = above.zip_low(below);
                }
                self.add_pair(simd, sums, [row, pair], V::join(blocks));
            }
        }
    }
}

/// Returns the samples of a texel, followed by as many zeros.
#[inline(always)]
fn first_half<S: Simd>(simd: S, samples: &[i16]) -> i16x8<S> {
    let mut all = [0; 8];
    all[..4].copy_from_slice(&samples[..4]);
    i16x8::load_array(simd, all)
}
