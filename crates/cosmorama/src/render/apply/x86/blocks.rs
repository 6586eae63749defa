//! Operations on blocks of four mirror images that are one instruction of AVX-512 and have no portable equivalent.

use std::arch::x86_64::{
    __m512i, _mm512_dpwssds_epi32, _mm512_permutex2var_epi16, _mm512_shuffle_i64x2, _mm512_unpackhi_epi16,
    _mm512_unpacklo_epi16,
};

use fearless_simd::kernel;

kernel!(
    /// Adds the weighted sums of pairs to sums that began with half of their divisor. No sum overflows 32 bits, because
    /// of how `quantize.rs` scales weights. This is the saturating one of the instruction's two forms: compilers split
    /// the other into a product and a sum.
    #[inline(always)]
    pub(crate) fn add_products(token: Avx512, sums: __m512i, texels: __m512i, weights: __m512i) -> __m512i {
        _mm512_dpwssds_epi32(sums, texels, weights)
    }
);

kernel!(
    /// Picks samples out of two vectors by their places. Places in the second vector count from 32 on.
    #[inline(always)]
    pub(crate) fn chosen(token: Avx512, a: __m512i, places: __m512i, b: __m512i) -> __m512i {
        _mm512_permutex2var_epi16(a, places, b)
    }
);

/// Places of the samples of pairs among four texels of each of four mirror images, the last two of which are reversed.
/// Pairs begin in the first texel, the second and the third.
pub(crate) static PAIRS: [[i16; 32]; 3] = {
    let mut places = [[0; 32]; 3];
    let mut at = 0;
    while at < 3 * 32 {
        let (first, place) = (at / 32, at % 32);
        let (image, channel, texel) = (place / 8, place % 8 / 2, first + place % 2);
        let texel = if image < 2 { texel } else { 3 - texel };
        places[first][place] = (16 * image + 4 * texel + channel) as i16;
        at += 1;
    }
    places
};

kernel!(
    /// Picks the first of two pairs in each of four mirror images. In two of the images it lies first, and in two last.
    #[inline(always)]
    pub(crate) fn first_pairs(token: Avx512, forward: __m512i, reversed: __m512i) -> __m512i {
        _mm512_shuffle_i64x2::<0b11_01_10_00>(forward, reversed)
    }
);

kernel!(
    /// Picks the second of two pairs in each of four mirror images. In two of the images it lies last, and in two
    /// first.
    #[inline(always)]
    pub(crate) fn second_pairs(token: Avx512, forward: __m512i, reversed: __m512i) -> __m512i {
        _mm512_shuffle_i64x2::<0b10_00_11_01>(forward, reversed)
    }
);

kernel!(
    /// Pairs the first texels of each block, one from each vector.
    #[inline(always)]
    pub(crate) fn zip_first(token: Avx512, a: __m512i, b: __m512i) -> __m512i {
        _mm512_unpacklo_epi16(a, b)
    }
);

kernel!(
    /// Pairs the second texels of each block, one from each vector.
    #[inline(always)]
    pub(crate) fn zip_second(token: Avx512, a: __m512i, b: __m512i) -> __m512i {
        _mm512_unpackhi_epi16(a, b)
    }
);
