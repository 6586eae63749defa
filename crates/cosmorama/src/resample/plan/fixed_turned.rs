//! Windows of integers in mirrors that show columns as rows: pairs of texels beside each other lie there above each other.

use fearless_simd::{Simd, i16x8, prelude::*};

use super::blocks::Blocks;
use super::fixed_weights::{PAIRS_UNDER, ROWS_UNDER, Shape};
use super::fixed_window::{Large, Sums};
use super::texels::{Texels, Window};

/// A window of a small size, so wide and high as all mirrors see it: in these as many rows and columns.
#[derive(Clone, Copy)]
pub(super) struct TurnedWindow<
    'a,
    S: Simd,
    V: Blocks<S, N>,
    const N: usize,
    const R: usize,
    const WIDTH: usize,
    const HEIGHT: usize,
    const UNDER: usize,
> {
    pub(super) simd: S,
    pub(super) texels: [Window<'a, i16, HEIGHT, WIDTH>; N],
    pub(super) weights: &'a [u32],
    pub(super) marks: V,
}

impl<
    S: Simd,
    V: Blocks<S, N>,
    const N: usize,
    const R: usize,
    const WIDTH: usize,
    const HEIGHT: usize,
    const UNDER: usize,
> TurnedWindow<'_, S, V, N, R, WIDTH, HEIGHT, UNDER>
{
    #[inline(always)]
    pub(super) fn add(&self, sums: &mut Sums<S, V, N>) {
        self.add_rows(sums, 0);
        self.add_rows(sums, 1);
        if WIDTH == 6 {
            self.add_rows(sums, 2);
        }
    }

    /// Adds two rows of texels: a pair of each row of the window.
    #[inline(always)]
    fn add_rows(&self, sums: &mut Sums<S, V, N>, pair: usize) {
        let Self { simd, texels, .. } = self;
        let mut rows = [[texels[0].samples::<16>(0, 0); N]; 2];
        for (below, rows) in rows.iter_mut().enumerate() {
            for (image, samples) in rows.iter_mut().enumerate() {
                *samples = texels[image].samples(2 * pair + below, if image < N - R { 0 } else { HEIGHT - 4 });
            }
        }
        let [first, second, third, fourth] = V::four_upright::<R>(*simd, rows);
        self.add_pair(sums, 0, pair, first);
        self.add_pair(sums, 1, pair, second);
        self.add_pair(sums, 2, pair, third);
        self.add_pair(sums, 3, pair, fourth);
        if HEIGHT == 5 {
            let mut last = [i16x8::splat(*simd, 0); N];
            for (image, last) in last.iter_mut().enumerate() {
                let column = if image < N - R { 3 } else { 0 };
                let [above, below] =
                    [0, 1].map(|row| i16x8::load_array_ref(*simd, texels[image].samples(2 * pair + row, column)));
                *last = if image < N - R { above.zip_high(below) } else { above.zip_low(below) };
            }
            self.add_pair(sums, 4, pair, V::join(last));
        }
    }

    #[inline(always)]
    fn add_pair(&self, sums: &mut Sums<S, V, N>, row: usize, pair: usize, texels: V) {
        let at = WIDTH / 2 * row + pair;
        sums.add(texels, V::pair(self.simd, self.weights[at]), at);
        if (UNDER..UNDER + ROWS_UNDER).contains(&row) && pair < PAIRS_UNDER {
            sums.bound(self.simd, texels, self.marks, (row - UNDER) * PAIRS_UNDER + pair);
        }
    }
}

impl Large<'_> {
    /// The same of a window of any size.
    #[inline(always)]
    pub(super) fn add_turned<S: Simd, V: Blocks<S, N>, const N: usize, const R: usize>(
        &self,
        simd: S,
        texels: &Texels<i16, N, R>,
        first: [u32; 2],
        sums: &mut Sums<S, V, N>,
    ) {
        let Shape { pairs, height, .. } = self.shape;
        for pair in 0..pairs {
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

/// The samples of a texel, and as many zeros.
#[inline(always)]
fn first_half<S: Simd>(simd: S, samples: &[i16]) -> i16x8<S> {
    let mut all = [0; 8];
    all[..4].copy_from_slice(&samples[..4]);
    i16x8::load_array(simd, all)
}
