//! Windows of integers, in mirror images of either direction, pair by pair.

use fearless_simd::{Simd, i16x8, prelude::*};

use super::blocks::{self, Blocks, Mirrored};
use super::patch_texels::{self, PatchTexels};
use super::weights::{FixedFormat, PAIRS_UNDER, SMALL, bits, weight_index};
use crate::render::apply::driver::Window;
use crate::render::apply::texels::Texels;
use crate::render::plan::window_format::{Kept, ROWS_UNDER, Shape};

impl<S: Mirrored<N>, const N: usize, const R: usize> Window<'_, S, i16, N, R> {
    /// Sums the light of a window of one of the sizes of [`SMALL`], given the texels of all small windows of its group.
    /// Returns the light, and how many numbers the window takes. The code is unrolled by hand: the compiler would keep
    /// loops.
    #[inline(always)]
    pub(crate) fn small<const WIDTH: usize, const HEIGHT: usize, const UNDER: usize>(
        self,
        patch: &PatchTexels,
    ) -> (Light<S, N>, usize) {
        let Self { simd, first, numbers, is_bounded, .. } = self;
        debug_assert_eq!(
            SMALL.get(self.header().shape() as usize),
            Some(&Shape { width: WIDTH, height: HEIGHT, under: UNDER }),
            "the table's order is that of the match"
        );
        let mut sums = Sums::<S, S::Blocks, N>::new(simd, bits(self.header()), is_bounded);
        let length = 1 + WIDTH / 2 * HEIGHT;
        let (texels, marks) = (patch.window::<N, WIDTH, HEIGHT>(first), S::Blocks::pair(simd, numbers[0]));
        SmallWindow { simd, texels, weights: &numbers[1..length], marks }.add::<UNDER>(&mut sums);
        (sums.average(bits(self.header())), length)
    }

    /// Sums the light of a window of any size. Returns the light, and how many numbers the window takes. If `TURNED`,
    /// all mirror images read the window transposed.
    #[inline(always)]
    pub(crate) fn large<const TURNED: bool>(self) -> (Light<S, N>, usize) {
        let Self { simd, texels, first, is_bounded, .. } = self;
        let mut sums = Sums::<S, S::Blocks, N>::new(simd, bits(self.header()), is_bounded);
        let kept = Kept::large::<FixedFormat>(self.run, self.numbers);
        if TURNED {
            kept.add_turned(simd, texels, first, &mut sums);
        } else {
            kept.add(simd, texels, first, &mut sums);
        }
        (sums.average(bits(self.header())), kept.length())
    }
}

/// Light of a window in N mirror images.
pub(crate) type Light<S, const N: usize> = <<S as Mirrored<N>>::Blocks as SimdWiden<S>>::Widened;

/// Sums over large windows.
impl Kept<'_> {
    #[inline(always)]
    fn add<S: Simd, V: Blocks<S, N>, const N: usize, const R: usize>(
        &self,
        simd: S,
        texels: &Texels<i16, N, R>,
        first: [u32; 2],
        sums: &mut Sums<S, V, N>,
    ) {
        let Shape { width, height, .. } = self.shape;
        let pairs = width / 2;
        let order = V::Bytes::from_slice(simd, blocks::order::<N, R>());
        for row in 0..height {
            let mut rows: [&[i16]; N] = [&[]; N];
            for (image, samples) in rows.iter_mut().enumerate() {
                *samples = texels.row(image, [first[0], first[1] + row as u32], width);
            }
            for pair in 0..pairs {
                let mut blocks = [i16x8::splat(simd, 0); N];
                for image in 0..N {
                    let pair = if image < N - R { pair } else { pairs - 1 - pair };
                    blocks[image] = i16x8::from_slice(simd, &rows[image][8 * pair..][..8]);
                }
                self.add_pair(simd, sums, [row, pair], V::join(blocks).swizzle_dyn_within_blocks(order));
            }
        }
    }

    /// Adds a pair of texels of a row.
    #[inline(always)]
    pub(crate) fn add_pair<S: Simd, V: Blocks<S, N>, const N: usize>(
        &self,
        simd: S,
        sums: &mut Sums<S, V, N>,
        [row, pair]: [usize; 2],
        texels: V,
    ) {
        sums.add(texels, V::pair(simd, self.weights[row * (self.shape.width / 2) + pair]), 0);
        if let Some(marks) = self.marks_of(row) {
            sums.bound(simd, texels, V::pair(simd, marks[pair / 16]) << (15 - pair as u32 % 16));
        }
    }
}

/// A window of a small size.
#[derive(Clone, Copy)]
struct SmallWindow<'a, S: Simd, V: Blocks<S, N>, const N: usize, const WIDTH: usize, const HEIGHT: usize> {
    simd: S,
    texels: patch_texels::Window<'a, N, WIDTH, HEIGHT>,
    weights: &'a [u32],
    marks: V,
}

impl<S: Simd, V: Blocks<S, N>, const N: usize, const WIDTH: usize, const HEIGHT: usize>
    SmallWindow<'_, S, V, N, WIDTH, HEIGHT>
{
    #[inline(always)]
    fn add<const UNDER: usize>(&self, sums: &mut Sums<S, V, N>) {
        // The last pair comes first, since its mark is next to the sign bit.
        let mut marks = self.marks << (16 - ROWS_UNDER * PAIRS_UNDER) as u32;
        if HEIGHT == 5 {
            self.add_row::<UNDER>(sums, &mut marks, 4);
        }
        self.add_row::<UNDER>(sums, &mut marks, 3);
        self.add_row::<UNDER>(sums, &mut marks, 2);
        self.add_row::<UNDER>(sums, &mut marks, 1);
        self.add_row::<UNDER>(sums, &mut marks, 0);
    }

    #[inline(always)]
    fn add_row<const UNDER: usize>(&self, sums: &mut Sums<S, V, N>, marks: &mut V, row: usize) {
        if WIDTH == 6 {
            self.add_pair::<UNDER>(sums, marks, row, 2);
        }
        self.add_pair::<UNDER>(sums, marks, row, 1);
        self.add_pair::<UNDER>(sums, marks, row, 0);
    }

    #[inline(always)]
    fn add_pair<const UNDER: usize>(&self, sums: &mut Sums<S, V, N>, marks: &mut V, row: usize, pair: usize) {
        let texels: V = self.texels.pair(self.simd, row, 2 * pair);
        let at = weight_index(WIDTH / 2, row, pair);
        sums.add(texels, V::pair(self.simd, self.weights[at]), at);
        if (UNDER..UNDER + ROWS_UNDER).contains(&row) && pair < PAIRS_UNDER {
            sums.bound(self.simd, texels, *marks);
            // Moves the next pair's mark to the sign bit: adding takes half the time of a shift.
            *marks = *marks + *marks;
        }
    }
}

/// Number of independent sums where a multiplication and an addition are one instruction, so that none waits for the
/// one before. Elsewhere additions alone are fast and registers few, so that one sum serves.
const CHAINS: usize = 2;

/// Sums over a window.
#[derive(Clone, Copy)]
pub(crate) struct Sums<S: Simd, V: Blocks<S, N>, const N: usize> {
    sums: [V::Widened; CHAINS],
    /// Largest samples under the pixel, and the smallest.
    greatest: V,
    least: V::Unsigned,
}

impl<S: Simd, V: Blocks<S, N>, const N: usize> Sums<S, V, N> {
    /// Starts sums of no texels. Weights are scaled by 2 to the power of `bits`. `is_bounded` tells whether the sum is
    /// clamped to the texels under the pixel.
    #[inline(always)]
    pub(crate) fn new(simd: S, bits: u32, is_bounded: bool) -> Self {
        let half = V::Widened::splat(simd, 1 << (bits - 1));
        // Without bounds, these are so wide that no texel changes them.
        let [least, greatest] = if is_bounded { [i16::MAX, 0] } else { [0, i16::MAX] };
        Self {
            sums: [half, V::Widened::splat(simd, 0)],
            greatest: V::splat(simd, greatest),
            least: V::Unsigned::splat(simd, least.cast_unsigned()),
        }
    }

    /// Adds pairs of texels; successive pairs go to different chains.
    #[inline(always)]
    pub(crate) fn add(&mut self, texels: V, weights: V, chain: usize) {
        let sum = &mut self.sums[if V::are_products_added(texels.token()) { chain % CHAINS } else { 0 }];
        *sum = V::add_products(*sum, texels, weights);
    }

    /// Updates the bounds by texels of a pair that lie under the pixel, whose mark (a sign) is not set.
    #[inline(always)]
    pub(crate) fn bound(&mut self, simd: S, texels: V, marks: V) {
        // The sign bit makes the other texels less than all those under the pixel, or greater in unsigned numbers.
        let samples = texels | marks & V::splat(simd, i16::MIN);
        self.greatest = self.greatest.max(samples);
        self.least = self.least.min(samples.bitcast::<V::Unsigned>());
    }

    /// Returns the sum as light, within its bounds.
    #[inline(always)]
    pub(crate) fn average(self, bits: u32) -> V::Widened {
        let [a, b] = self.sums;
        let least: [V::Widened; 2] = halves(self.least);
        let greatest: [V::Widened; 2] = halves(self.greatest);
        let ([fewest, few], [most, many]) = (least, greatest);
        ((a + b) >> bits).max(fewest.min(few)).min(most.max(many))
    }
}

/// Splits each pair into its two samples, neither of which is negative.
#[inline(always)]
pub(crate) fn halves<S: Simd, V: SimdInt<S>, W: SimdInt<S, Element = i32, ByteVector = V::ByteVector>>(
    samples: V,
) -> [W; 2] {
    let pairs: W = samples.bitcast();
    [pairs & i32::from(i16::MAX), pairs >> 16]
}
