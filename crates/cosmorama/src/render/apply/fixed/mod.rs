//! Plans in integers, for opaque pictures of 8 bits.
//!
//! Light has 15 bits and weights have 16. Their products are added in 32 bits, so that the result is the same on every
//! machine. Two neighbouring texels are processed together: red, green, blue and zero of each, in a block of 128 bits
//! for each mirror image. The product of pairs is then a weighted sum of two texels, and weights are spread once for
//! all mirror images.

pub(crate) mod at_once;
pub(crate) mod blocks;
pub(crate) mod encode_u8;
pub(crate) mod patch_texels;
pub(crate) mod quantize;
pub(crate) mod turned;
pub(crate) mod unmirrored;
pub(crate) mod weights;
pub(crate) mod window;

use fearless_simd::{Simd, f32x4, i32x4, prelude::*};

use super::driver::{Fresh, Window, WindowArithmetic, WindowSums};
use super::fixed::at_once::FreshWeights;
use super::fixed::blocks::Mirrored;
#[cfg(target_arch = "x86_64")]
use super::fixed::encode_u8::Compute;
use super::fixed::encode_u8::LookUp;
use super::fixed::patch_texels::PatchTexels;
use super::fixed::weights::{FixedFormat, SMALL};
use super::tap_lists::Palette;
use super::tile_writer::{Canvas, GroupLight};
use crate::raster::{FixedCodec, FixedLight, Rgba};
use crate::render::plan::symmetry::Ways;
use crate::render::plan::traversal::Pass;

/// Arithmetic in integers: light of 15 bits makes codes of 8 bits.
#[derive(Clone, Copy)]
pub(crate) struct FixedArithmetic<'a> {
    pub(crate) light: &'a FixedLight,
    pub(crate) codec: &'a FixedCodec,
}

/// Sums of integers.
pub(crate) struct FixedSums;

impl WindowSums for FixedSums {
    type Sample = i16;
    type Light = [i32; 4];
    type Shared = PatchTexels;

    #[inline(always)]
    fn begin(patch: &mut PatchTexels) {
        patch.clear();
    }

    #[inline(always)]
    fn weigh<S: Mirrored<N>, const N: usize, const R: usize, const TURNED: bool>(
        window: Window<S, i16, N, R>,
        patch: &mut PatchTexels,
        light: &mut [[i32; 4]],
    ) -> usize {
        let shape = window.header().shape();
        if N == 1 && R == 0 && (shape as usize) < SMALL.len() {
            let (average, length) = match shape {
                0 => window.unmirrored::<4, 4, 0>(),
                1 => window.unmirrored::<4, 4, 1>(),
                2 => window.unmirrored::<4, 5, 1>(),
                3 => window.unmirrored::<6, 4, 0>(),
                4 => window.unmirrored::<6, 4, 1>(),
                _ => window.unmirrored::<6, 5, 1>(),
            };
            light[0] = average;
            return length;
        }
        if (shape as usize) < SMALL.len() {
            patch.hold::<S, N, R, TURNED>(window.simd, window.texels, window.group, window.first);
        }
        let (average, length) = match shape {
            0 => window.small::<4, 4, 0>(patch),
            1 => window.small::<4, 4, 1>(patch),
            2 => window.small::<4, 5, 1>(patch),
            3 => window.small::<6, 4, 0>(patch),
            4 => window.small::<6, 4, 1>(patch),
            5 => window.small::<6, 5, 1>(patch),
            _ => window.large::<TURNED>(),
        };
        average.store_slice(light.as_flattened_mut());
        length
    }
}

impl WindowArithmetic for FixedArithmetic<'_> {
    type Format = FixedFormat;
    type Sums = FixedSums;
    type Fresh = FreshWeights;

    fn background(&self) -> [u8; 3] {
        self.codec.background()
    }

    /// Writes the pixels. It is compiled apart from the sums, whose loop would otherwise lack registers.
    #[inline(never)]
    fn put<S: Simd>(
        &self,
        simd: S,
        pass: &Pass,
        ways: &Ways,
        light: &GroupLight<[i32; 4]>,
        canvas: &mut Canvas<[u8; 3]>,
    ) {
        let codes = LookUp(self.codec.codes());
        // Other processors have no faster way to write.
        #[cfg(not(target_arch = "x86_64"))]
        let _ = simd;
        #[cfg(target_arch = "x86_64")]
        if let Some(level) = simd.level().as_avx512()
            && codes.0.are_srgb()
        {
            let compute = Compute { level, codes };
            simd.vectorize(
                #[inline(always)]
                || canvas.put(pass, ways, light, &compute),
            );
            return;
        }
        canvas.put(pass, ways, light, &codes);
    }

    #[inline(always)]
    fn put_at_once<S: Simd>(
        &self,
        simd: S,
        weights: &mut FreshWeights,
        Fresh { texels, windows, pixel, lanes, is_bounded }: &Fresh<i16>,
        canvas: &mut Canvas<[u8; 3]>,
    ) -> bool {
        if !weights.take(simd, texels, (*lanes, windows)) {
            return false;
        }
        let light = weights.light(simd, texels, (*lanes, windows), *is_bounded);
        let codes = LookUp(self.codec.codes());
        #[cfg(target_arch = "x86_64")]
        if let Some(level) = simd.level().as_avx512()
            && codes.0.are_srgb()
        {
            canvas.put_run(*pixel, *lanes, &light, &Compute { level, codes });
            return true;
        }
        canvas.put_run(*pixel, *lanes, &light, &codes);
        true
    }
}

impl Palette for FixedArithmetic<'_> {
    type Pixel = [u8; 3];
    type Sample = i16;

    #[inline(always)]
    fn texels(&self) -> &[[i16; 4]] {
        self.light.as_laid_out()
    }

    #[inline(always)]
    fn light<S: Simd>(&self, simd: S, texel: u32) -> f32x4<S> {
        let [red, green, blue, _] = self.light.as_laid_out()[texel as usize];
        let samples = i32x4::load_array(simd, [red, green, blue, 0].map(i32::from));
        let light = f32x4::float_from(samples) / FixedLight::WHITE;
        light + f32x4::load_array(simd, [0.0, 0.0, 0.0, 1.0])
    }

    fn pixel(&self, light: Rgba, coverage: f32) -> [u8; 3] {
        self.codec.codes_of((light * coverage).over(self.codec.background_light()))
    }
}
