//! Small windows of a picture without mirror images: several rows at once, straight from the light.

use fearless_simd::{Simd, i16x8, i16x16, i16x32, i32x4, i32x16, prelude::*, u8x64, u16x16, u32x4};

use super::blocks::Blocks;
use super::weights::{PAIRS_UNDER, bits};
use super::window::halves;
use crate::render::apply::driver::Window;
use crate::render::plan::window_format::ROWS_UNDER;

/// Order of the bytes of two texels as pairs of one channel.
static PAIRS: [u8; 16] = [0, 1, 8, 9, 2, 3, 10, 11, 4, 5, 12, 13, 6, 7, 14, 15];

/// Orders of the bytes of four pairs' weights, each once for each channel, from the first of them on, the second, and
/// the third.
static SPREAD: [[u8; 64]; 3] = {
    let (mut bytes, mut at) = ([[0; 64]; 3], 0);
    while at < 3 * 64 {
        bytes[at / 64][at % 64] = ((at % 64 / 16 + at / 64) % 4 * 4 + at % 4) as u8;
        at += 1;
    }
    bytes
};

/// Factors that move the marks of four texels to the sign, for each row that may lie under the pixel.
static FACTORS: [[i16; 16]; ROWS_UNDER] = {
    let (mut factors, mut at) = ([[0; 16]; ROWS_UNDER], 0);
    while at < ROWS_UNDER * 16 {
        let (row, pair) = (at / 16, at % 16 / 8);
        factors[row][at % 16] = 1 << (15 - (row * PAIRS_UNDER + pair));
        at += 1;
    }
    factors
};

impl<S: Simd, const N: usize, const R: usize> Window<'_, S, i16, N, R> {
    /// Sums the light of a window of one of the small sizes. Returns the light, and how many numbers the window takes.
    #[inline(always)]
    pub(crate) fn unmirrored<const WIDTH: usize, const HEIGHT: usize, const UNDER: usize>(self) -> ([i32; 4], usize) {
        let Self { simd, texels, first, numbers, is_bounded, .. } = self;
        let window = texels.windows::<WIDTH, HEIGHT>(first)[0];
        let (bits, length) = (bits(self.header()), 1 + WIDTH / 2 * HEIGHT);
        let weights = &numbers[1..length];
        let order = u8x64::block_splat(PAIRS.simd_into(simd));
        let marks: i16x16<S> = Blocks::<S, 2>::pair(simd, numbers[0]);
        let [least, greatest] = if is_bounded { [i16::MAX, 0] } else { [0, i16::MAX] };
        let (mut least, mut greatest) = (u16x16::splat(simd, least.cast_unsigned()), i16x16::splat(simd, greatest));
        let mut sums = i32x16::splat(simd, 0);
        macro_rules! bound {
            ($row:expr, $texels:ident) => {
                if UNDER <= $row && $row < UNDER + ROWS_UNDER {
                    // A sign makes samples less than all those under the pixel, or greater in unsigned numbers.
                    let samples = $texels | marks * i16x16::load_array_ref(simd, &FACTORS[$row - UNDER]) & i16::MIN;
                    greatest = greatest.max(samples);
                    least = least.min(samples.bitcast::<u16x16<S>>());
                }
            };
        }
        // Unrolled by hand: the compiler would keep the loop.
        macro_rules! rows {
            ($row:literal) => {
                let upper = i16x16::load_array_ref(simd, window.samples($row, 0));
                let lower = i16x16::load_array_ref(simd, window.samples($row + 1, 0));
                let texels = upper.combine(lower).swizzle_dyn_within_blocks(order);
                sums = add(sums, texels, spread(simd, &weights[2 * $row..], 0));
                let (upper, lower) = texels.split();
                bound!($row, upper);
                bound!($row + 1, lower);
            };
        }
        rows!(0);
        rows!(2);
        if WIDTH == 6 {
            let first = i16x8::load_array_ref(simd, window.samples(0, 4));
            let second = i16x8::load_array_ref(simd, window.samples(1, 4));
            let third = i16x8::load_array_ref(simd, window.samples(2, 4));
            let fourth = i16x8::load_array_ref(simd, window.samples(3, 4));
            let texels = first.combine(second).combine(third.combine(fourth)).swizzle_dyn_within_blocks(order);
            sums = add(sums, texels, spread(simd, &weights[8..], 0));
        }
        if HEIGHT == 5 {
            let first = i16x16::load_array_ref(simd, window.samples(4, 0));
            let none = i16x8::splat(simd, 0);
            let second = if WIDTH == 6 { i16x8::load_array_ref(simd, window.samples(4, 4)) } else { none };
            let texels = first.combine(second.combine(none)).swizzle_dyn_within_blocks(order);
            // Weights of texels that are none do not matter.
            let weights = &weights[WIDTH / 2 * HEIGHT - 4..];
            sums = add(sums, texels, spread(simd, weights, if WIDTH == 6 { 1 } else { 2 }));
        }
        let (a, b) = sums.split();
        let (a, b) = (a + b).split();
        let sum: i32x4<S> = (a + b + (1 << (bits - 1))) >> bits;
        let (a, b) = greatest.split();
        let [most, many]: [i32x4<S>; 2] = halves(a.max(b));
        let (a, b) = least.split();
        let [fewest, few]: [i32x4<S>; 2] = halves(a.min(b));
        (sum.max(fewest.min(few)).min(most.max(many)).to_array(), length)
    }
}

/// Adds the weighted sums of pairs.
#[inline(always)]
fn add<S: Simd>(sums: i32x16<S>, texels: i16x32<S>, weights: i16x32<S>) -> i32x16<S> {
    <i16x32<S> as Blocks<S, 4>>::add_products(sums, texels, weights)
}

/// Repeats each of four weights for the channels of a pair, beginning with this one.
#[inline(always)]
fn spread<S: Simd>(simd: S, weights: &[u32], first: usize) -> i16x32<S> {
    let weights = u32x4::from_slice(simd, &weights[..4]);
    u8x64::block_splat(weights.bitcast())
        .swizzle_dyn_within_blocks(u8x64::load_array_ref(simd, &SPREAD[first]))
        .bitcast()
}
