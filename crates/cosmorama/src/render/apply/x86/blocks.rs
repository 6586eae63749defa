//! What AVX-512 does in one instruction for blocks of four mirrors, and portable vectors have no word for.

use std::arch::x86_64::{
    __m512i, _mm512_dpwssds_epi32, _mm512_permutex2var_epi16, _mm512_shuffle_i64x2, _mm512_unpackhi_epi16,
    _mm512_unpacklo_epi16,
};

use fearless_simd::kernel;

kernel!(
    /// Adds the weighted sums of pairs to sums that began with half of what they are divided by: none leaves the 32 bits (by how
    /// `quantize.rs` scales weights). Of its two ways that which would stop
    /// there: the other one compilers take apart again, into a product and a sum.
    #[inline(always)]
    pub(crate) fn add_products(token: Avx512, sums: __m512i, texels: __m512i, weights: __m512i) -> __m512i {
        _mm512_dpwssds_epi32(sums, texels, weights)
    }
);

kernel!(
    /// Picks samples out of two vectors by their places; those of the second vector count from 32 on.
    #[inline(always)]
    pub(crate) fn chosen(token: Avx512, a: __m512i, places: __m512i, b: __m512i) -> __m512i {
        _mm512_permutex2var_epi16(a, places, b)
    }
);

/// Where the samples of pairs are, among four texels of each of four mirrors, of which the last two run the other way: of the pair that
/// begins in the first texel, in the second and in the third.
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
    /// Of two pairs of each of four mirrors the first ones, given two mirrors in which they lie first and two in which they lie
    /// last.
    #[inline(always)]
    pub(crate) fn first_pairs(token: Avx512, forward: __m512i, reversed: __m512i) -> __m512i {
        _mm512_shuffle_i64x2::<0b11_01_10_00>(forward, reversed)
    }
);

kernel!(
    /// The second ones.
    #[inline(always)]
    pub(crate) fn second_pairs(token: Avx512, forward: __m512i, reversed: __m512i) -> __m512i {
        _mm512_shuffle_i64x2::<0b10_00_11_01>(forward, reversed)
    }
);

kernel!(
    /// Pairs of the first texels of each block, one of either.
    #[inline(always)]
    pub(crate) fn zip_first(token: Avx512, a: __m512i, b: __m512i) -> __m512i {
        _mm512_unpacklo_epi16(a, b)
    }
);

kernel!(
    /// Pairs of the second ones.
    #[inline(always)]
    pub(crate) fn zip_second(token: Avx512, a: __m512i, b: __m512i) -> __m512i {
        _mm512_unpackhi_epi16(a, b)
    }
);
