//! Blocks of 128 bits, one for each mirror image. Weights, which mirrored pixels share, are spread once for all of
//! them.

#[cfg(target_arch = "x86_64")]
use fearless_simd::i32x16;
use fearless_simd::{Simd, i16x8, i16x16, i16x32, prelude::*, u16x8, u16x16, u16x32};

#[cfg(target_arch = "x86_64")]
use crate::render::apply::x86::blocks as blocks_x86;

/// Two texels in each of N mirror images, each as red, green, blue and zero.
pub(crate) trait Blocks<S: Simd, const N: usize>:
    SimdInt<S, Element = i16>
    + SimdIntWiden<S, Widened: SimdInt<S, Element = i32, ByteVector = <Self as SimdBase<S>>::ByteVector>>
{
    /// Unsigned type with the same number of elements.
    type Unsigned: SimdInt<S, Element = u16, ByteVector = <Self as SimdBase<S>>::ByteVector>;

    fn join(blocks: [i16x8<S>; N]) -> Self;

    /// Returns the three pairs of neighbours among four texels in each mirror image, the leftmost pair first. A pair
    /// holds two samples of each channel. Texels run from left to right in all mirror images but the last R.
    #[inline(always)]
    fn three_pairs<const R: usize>(simd: S, rows: [&[i16; 16]; N]) -> [Self; 3] {
        portable::three_pairs::<S, Self, N, R>(simd, rows)
    }

    /// Returns four pairs of texels above each other, from two rows of four texels in each mirror image, the leftmost
    /// pair first. Texels run from left to right in all mirror images but the last R.
    #[inline(always)]
    fn four_upright<const R: usize>(simd: S, rows: [[&[i16; 16]; N]; 2]) -> [Self; 4] {
        portable::four_upright::<S, Self, N, R>(simd, rows)
    }

    /// Adds the weighted sum of each pair to `sums`.
    #[inline(always)]
    fn add_products(sums: Self::Widened, texels: Self, weights: Self) -> Self::Widened {
        portable::add_products(sums, texels, weights)
    }

    /// Returns whether [`Blocks::add_products`] is one instruction.
    #[inline(always)]
    fn are_products_added(simd: S) -> bool {
        let _ = simd;
        false
    }

    /// Repeats two numbers of 16 bits, weights or marks, for all channels.
    #[inline(always)]
    fn pair(simd: S, numbers: u32) -> Self {
        Self::Widened::splat(simd, numbers as i32).bitcast()
    }
}

/// SIMD instruction set, with its type of blocks for N mirror images.
pub(crate) trait Mirrored<const N: usize>: Simd {
    type Blocks: Blocks<Self, N>;
}

impl<S: Simd> Mirrored<1> for S {
    type Blocks = i16x8<S>;
}

impl<S: Simd> Mirrored<2> for S {
    type Blocks = i16x16<S>;
}

impl<S: Simd> Mirrored<4> for S {
    type Blocks = i16x32<S>;
}

impl<S: Simd> Blocks<S, 1> for i16x8<S> {
    type Unsigned = u16x8<S>;

    #[inline(always)]
    fn join([block]: [i16x8<S>; 1]) -> Self {
        block
    }
}

impl<S: Simd> Blocks<S, 2> for i16x16<S> {
    type Unsigned = u16x16<S>;

    #[inline(always)]
    fn join([a, b]: [i16x8<S>; 2]) -> Self {
        a.combine(b)
    }
}

impl<S: Simd> Blocks<S, 4> for i16x32<S> {
    type Unsigned = u16x32<S>;

    #[inline(always)]
    fn join([a, b, c, d]: [i16x8<S>; 4]) -> Self {
        a.combine(b).combine(c.combine(d))
    }

    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    fn three_pairs<const R: usize>(simd: S, rows: [&[i16; 16]; 4]) -> [Self; 3] {
        match simd.level().as_avx512() {
            Some(level) if R == 2 => {
                let [a, b, c, d] = rows;
                let forward = i16x16::load_array_ref(simd, a).combine(i16x16::load_array_ref(simd, b));
                let reversed = i16x16::load_array_ref(simd, c).combine(i16x16::load_array_ref(simd, d));
                let mut pairs = [forward; 3];
                for (pairs, places) in pairs.iter_mut().zip(&blocks_x86::PAIRS) {
                    let places = i16x32::load_array_ref(simd, places);
                    let chosen = blocks_x86::chosen(level, forward.into(), places.into(), reversed.into());
                    *pairs = chosen.simd_into(simd);
                }
                pairs
            }
            _ => portable::three_pairs::<S, Self, 4, R>(simd, rows),
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    fn four_upright<const R: usize>(simd: S, rows: [[&[i16; 16]; 4]; 2]) -> [Self; 4] {
        match simd.level().as_avx512() {
            Some(level) if R == 2 => {
                let [[a, b, c, d], [e, f, g, h]] = rows;
                let two = |left, right| i16x16::load_array_ref(simd, left).combine(i16x16::load_array_ref(simd, right));
                let [forward, below] = [two(a, b), two(e, f)].map(Into::into);
                let [reversed, below_reversed] = [two(c, d), two(g, h)].map(Into::into);
                let (even, odd) =
                    (blocks_x86::zip_first(level, forward, below), blocks_x86::zip_second(level, forward, below));
                // From right to left, the first texel is the second one of a block, and lies in the second block.
                let (even_reversed, odd_reversed) = (
                    blocks_x86::zip_second(level, reversed, below_reversed),
                    blocks_x86::zip_first(level, reversed, below_reversed),
                );
                [
                    blocks_x86::first_pairs(level, even, even_reversed),
                    blocks_x86::first_pairs(level, odd, odd_reversed),
                    blocks_x86::second_pairs(level, even, even_reversed),
                    blocks_x86::second_pairs(level, odd, odd_reversed),
                ]
                .map(|pairs| pairs.simd_into(simd))
            }
            _ => portable::four_upright::<S, Self, 4, R>(simd, rows),
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    fn are_products_added(simd: S) -> bool {
        simd.level().as_avx512().is_some()
    }

    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    fn add_products(sums: i32x16<S>, texels: Self, weights: Self) -> i32x16<S> {
        let simd = sums.token();
        match simd.level().as_avx512() {
            Some(level) => blocks_x86::add_products(level, sums.into(), texels.into(), weights.into()).simd_into(simd),
            None => portable::add_products(sums, texels, weights),
        }
    }
}

/// Portable versions, for instruction sets without the special instructions.
mod portable {
    use fearless_simd::{Simd, i16x8, i16x16, prelude::*};

    use crate::render::apply::fixed::blocks::Blocks;

    #[inline(always)]
    pub(crate) fn three_pairs<S: Simd, V: Blocks<S, N>, const N: usize, const R: usize>(
        simd: S,
        rows: [&[i16; 16]; N],
    ) -> [V; 3] {
        let order = V::Bytes::from_slice(simd, super::order::<N, R>());
        let mut pairs = [[i16x8::splat(simd, 0); N]; 3];
        for (at, pairs) in pairs.iter_mut().enumerate() {
            for (image, pairs) in pairs.iter_mut().enumerate() {
                let texel = if image < N - R { at } else { 2 - at };
                *pairs = i16x8::from_slice(simd, &rows[image][4 * texel..][..8]);
            }
        }
        let [a, b, c] = pairs;
        let mut pairs = [V::join(a), V::join(b), V::join(c)];
        for pairs in &mut pairs {
            *pairs = pairs.swizzle_dyn_within_blocks(order);
        }
        pairs
    }

    #[inline(always)]
    pub(crate) fn four_upright<S: Simd, V: Blocks<S, N>, const N: usize, const R: usize>(
        simd: S,
        [above, below]: [[&[i16; 16]; N]; 2],
    ) -> [V; 4] {
        let mut pairs = [[i16x8::splat(simd, 0); N]; 4];
        for image in 0..N {
            let (left, right) = i16x16::load_array_ref(simd, above[image]).split();
            let (left_below, right_below) = i16x16::load_array_ref(simd, below[image]).split();
            let (first, second) = (left.zip_low(left_below), left.zip_high(left_below));
            let (third, fourth) = (right.zip_low(right_below), right.zip_high(right_below));
            let is_forward = image < N - R;
            pairs[0][image] = if is_forward { first } else { fourth };
            pairs[1][image] = if is_forward { second } else { third };
            pairs[2][image] = if is_forward { third } else { second };
            pairs[3][image] = if is_forward { fourth } else { first };
        }
        let [a, b, c, d] = pairs;
        [V::join(a), V::join(b), V::join(c), V::join(d)]
    }

    #[inline(always)]
    pub(crate) fn add_products<S: Simd, V: Blocks<S, N>, const N: usize>(
        sums: V::Widened,
        texels: V,
        weights: V,
    ) -> V::Widened {
        sums + texels.pairwise_dot_product(weights)
    }
}

/// Returns the byte order that makes pairs of one channel from two texels in each of N blocks. The texels of a pair are
/// reversed in the last R blocks.
#[inline(always)]
pub(crate) fn order<const N: usize, const R: usize>() -> &'static [u8] {
    &ORDER[16 * (2 + R - N)..][..16 * N]
}

/// Byte orders for two blocks that keep the order of texels, then for two that reverse it.
static ORDER: [u8; 64] = {
    let pairs = [0, 1, 8, 9, 2, 3, 10, 11, 4, 5, 12, 13, 6, 7, 14, 15];
    let mut order = [0; 64];
    let mut at = 0;
    while at < 64 {
        order[at] = if at < 32 { pairs[at % 16] } else { pairs[at % 16] ^ 8 };
        at += 1;
    }
    order
};
