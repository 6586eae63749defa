//! A block of 128 bits for each mirror: what mirrored pixels have in common is done once for all of them.

use fearless_simd::{Simd, i16x8, i16x16, i16x32, prelude::*};

/// Two texels of each of N mirrors, red, green, blue and nothing of each.
pub(super) trait Blocks<S: Simd, const N: usize>:
    SimdInt<S, Element = i16, Mask: Select<Self>>
    + SimdIntWiden<S, Widened: SimdInt<S, Element = i32, ByteVector = <Self as SimdBase<S>>::ByteVector>>
{
    fn join(blocks: [i16x8<S>; N]) -> Self;

    /// Two numbers of 16 bits, weights or marks, for all channels.
    #[inline(always)]
    fn pair(simd: S, numbers: u32) -> Self {
        Self::Widened::splat(simd, numbers as i32).bitcast()
    }
}

impl<S: Simd> Blocks<S, 1> for i16x8<S> {
    #[inline(always)]
    fn join([block]: [i16x8<S>; 1]) -> Self {
        block
    }
}

impl<S: Simd> Blocks<S, 2> for i16x16<S> {
    #[inline(always)]
    fn join([a, b]: [i16x8<S>; 2]) -> Self {
        a.combine(b)
    }
}

impl<S: Simd> Blocks<S, 4> for i16x32<S> {
    #[inline(always)]
    fn join([a, b, c, d]: [i16x8<S>; 4]) -> Self {
        a.combine(b).combine(c.combine(d))
    }
}

/// From two texels in each block to pairs of one channel each: as texels run in the first of N blocks, the other way in the last
/// R.
#[inline(always)]
pub(super) fn order<const N: usize, const R: usize>() -> &'static [u8] {
    &ORDER[16 * (2 + R - N)..][..16 * N]
}

/// Two blocks as texels run, and two the other way.
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
