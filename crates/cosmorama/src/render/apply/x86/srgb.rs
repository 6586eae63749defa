//! Codes of sRGB by AVX-512: a polynomial and a factor for each power of two.

use std::arch::x86_64::{
    __m512i, _MM_MANT_NORM_1_2, _MM_MANT_SIGN_ZERO, _mm512_castps_si512, _mm512_castsi512_si256,
    _mm512_cmplt_epi32_mask, _mm512_cvtepi32_ps, _mm512_cvtps_epi32, _mm512_fmadd_ps, _mm512_getmant_ps,
    _mm512_mask_mul_ps, _mm512_permutex2var_epi8, _mm512_permutexvar_ps, _mm512_set1_epi32, _mm512_set1_ps,
    _mm512_srli_epi32,
};

use fearless_simd::{f32x16, kernel, prelude::*, u8x32, u8x64};

use crate::render::scan::tile::SIDE;

/// Light from which on the curve is a power, and codes for one step of light below it (IEC 61966-2-1: 12.92 up to
/// 0.0031308).
const BEND: i32 = 103;
const LINEAR: f32 = (12.92 * 255.0 / 32767.0) as f32;

/// Codes where the power is zero: 255 × -0.055.
const OFFSET: f32 = -14.025;

/// Coefficients of a polynomial for m^(1/2.4), m from 1 to 2, the highest power first. Its error is less than a
/// millionth.
const POWER: [f32; 6] = [0.004_578_923_3, -0.044_878_658, 0.188_872_17, -0.462_495_4, 0.931_453_2, 0.382_471_86];

/// Factors 255 × 1.055 × (2^e / 32767)^(1/2.4) for each exponent e of light that is a power, indexed by the last bits
/// of a float's exponent.
///
/// Some are changed in their last digits, until the codes of all light are rounded correctly. The light nearest to half
/// way between two codes is 0.00001 codes away from there.
static SCALES: [f32; 16] = {
    let known = [19.995_657, 26.691, 35.628_212, 47.557_957, 63.482_254, 84.738_64, 113.112_5, 150.987_09, 201.543_52];
    let (mut scales, mut at) = ([0.0; 16], 0);
    while at < known.len() {
        let exponent = BEND.ilog2() as usize + at;
        scales[(exponent + 127) % 16] = known[at];
        at += 1;
    }
    scales
};

/// Places of the bytes that are kept, of twice four pixels: a 32-bit number for each sample, and an unused one.
static BYTES: [u8; 64] = {
    let (mut bytes, mut at) = ([0; 64], 0);
    while at < 3 * SIDE {
        bytes[at] = 4 * (at / 3 * 4 + at % 3) as u8;
        at += 1;
    }
    bytes
};

kernel!(
    /// Computes the codes of light from 0 to 32767, as numbers.
    #[inline(always)]
    fn codes(token: Avx512, light: __m512i) -> __m512i {
        let samples = _mm512_cvtepi32_ps(light);
        let scales = f32x16::load_array_ref(token, &SCALES).into();
        let scale = _mm512_permutexvar_ps(_mm512_srli_epi32::<23>(_mm512_castps_si512(samples)), scales);
        let mantissa = _mm512_getmant_ps::<_MM_MANT_NORM_1_2, _MM_MANT_SIGN_ZERO>(samples);
        let mut power = _mm512_set1_ps(POWER[0]);
        for coefficient in &POWER[1..] {
            power = _mm512_fmadd_ps(power, mantissa, _mm512_set1_ps(*coefficient));
        }
        let codes = _mm512_fmadd_ps(scale, power, _mm512_set1_ps(OFFSET));
        let is_linear = _mm512_cmplt_epi32_mask(light, _mm512_set1_epi32(BEND));
        _mm512_cvtps_epi32(_mm512_mask_mul_ps(codes, is_linear, samples, _mm512_set1_ps(LINEAR)))
    }
);

kernel!(
    /// Computes the codes of the light of eight pixels, given as two vectors of four.
    #[inline(always)]
    pub(crate) fn eight_codes(token: Avx512, first: __m512i, last: __m512i) -> [[u8; 3]; SIDE] {
        let bytes = u8x64::load_array_ref(token, &BYTES).into();
        let all = _mm512_permutex2var_epi8(codes(token, first), bytes, codes(token, last));
        let all: u8x32<_> = _mm512_castsi512_si256(all).simd_into(token);
        let mut eight = [[0; 3]; SIDE];
        eight.as_flattened_mut().copy_from_slice(&all.to_array()[..3 * SIDE]);
        eight
    }
);
