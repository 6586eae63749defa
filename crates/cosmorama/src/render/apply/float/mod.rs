//! Pixels by plans in single precision, for light of any range.

pub(crate) mod large;
pub(crate) mod turned;
pub(crate) mod weights;
pub(crate) mod window;

use bytemuck::{NoUninit, Zeroable};
use fearless_simd::{Simd, f32x4, prelude::*};

use super::driver::{Fresh, Window, WindowArithmetic, WindowSums};
use super::fixed::blocks::Mirrored;
use super::fixed::encode_u8::unpacked;
use super::float::weights::FloatFormat;
use super::tap_lists::Palette;
use super::tile_writer::{Canvas, Develop, GroupLight};
use crate::raster::Rgba;
use crate::raster::codec::encode::RgbCodes;
use crate::render::plan::symmetry::Ways;
use crate::render::plan::traversal::Pass;
use crate::render::scan::tile::SIDE;

/// Arithmetic in floats: light of any range, over a background.
#[derive(Clone, Copy)]
pub(crate) struct FloatArithmetic<'a, P = Uncoded> {
    pub(crate) texels: &'a [Rgba],
    pub(crate) background: Rgba,
    pub(crate) pixels: P,
}

/// Conversion of light, in front of the background, to pixels.
pub(crate) trait LightPixels: Copy + Sync {
    type Pixel: NoUninit + Zeroable + Send + Sync;

    /// Returns the pixel of some light.
    fn of(self, light: Rgba) -> Self::Pixel;

    /// Returns the pixels of eight lights.
    fn eight(self, light: [Rgba; SIDE]) -> [Self::Pixel; SIDE];
}

/// Pixels that are light themselves.
#[derive(Clone, Copy)]
pub(crate) struct Uncoded;

impl LightPixels for Uncoded {
    type Pixel = Rgba;

    #[inline(always)]
    fn of(self, light: Rgba) -> Rgba {
        light
    }

    #[inline(always)]
    fn eight(self, light: [Rgba; SIDE]) -> [Rgba; SIDE] {
        light
    }
}

impl LightPixels for RgbCodes<'_> {
    type Pixel = [u8; 3];

    #[inline(always)]
    fn of(self, light: Rgba) -> [u8; 3] {
        self.rgb(light)
    }

    #[inline(always)]
    fn eight(self, light: [Rgba; SIDE]) -> [[u8; 3]; SIDE] {
        unpacked(self.packed_eight(&light))
    }
}

/// Sums of floats.
pub(crate) struct FloatSums;

impl WindowSums for FloatSums {
    type Sample = f32;
    type Light = Rgba;
    type Shared = ();

    fn begin((): &mut ()) {}

    #[inline(always)]
    fn weigh<S: Mirrored<N>, const N: usize, const R: usize, const TURNED: bool>(
        window: Window<S, f32, N, R>,
        (): &mut (),
        light: &mut [Rgba],
    ) -> usize {
        let (sums, length) = match window.header().shape() {
            0 => window.small::<4, 4, 0, TURNED>(),
            1 => window.small::<4, 4, 1, TURNED>(),
            2 => window.small::<4, 5, 1, TURNED>(),
            3 => window.small::<5, 4, 0, TURNED>(),
            4 => window.small::<5, 4, 1, TURNED>(),
            5 => window.small::<5, 5, 1, TURNED>(),
            _ => window.large::<TURNED>(),
        };
        for (light, sum) in light.iter_mut().zip(sums) {
            *light = Rgba(sum.average(window.is_bounded).to_array());
        }
        length
    }
}

impl<P: LightPixels> WindowArithmetic for FloatArithmetic<'_, P> {
    type Format = FloatFormat;
    type Sums = FloatSums;
    type Fresh = ();

    fn background(&self) -> P::Pixel {
        self.pixels.of(self.background)
    }

    #[inline(always)]
    fn put<S: Simd>(&self, _: S, pass: &Pass, ways: &Ways, light: &GroupLight<Rgba>, canvas: &mut Canvas<P::Pixel>) {
        canvas.put(pass, ways, light, self);
    }

    #[inline(always)]
    fn put_at_once<S: Simd>(&self, _: S, (): &mut (), _: &Fresh<f32>, _: &mut Canvas<P::Pixel>) -> bool {
        false
    }
}

impl<P> FloatArithmetic<'_, P> {
    /// Returns light in front of the background.
    #[inline(always)]
    fn in_front(&self, light: Rgba) -> Rgba {
        if self.background == Rgba::TRANSPARENT { light } else { light.over(self.background) }
    }
}

impl<P: LightPixels> Develop for FloatArithmetic<'_, P> {
    type Light = Rgba;
    type Pixel = P::Pixel;

    #[inline(always)]
    fn one(&self, light: Rgba) -> P::Pixel {
        self.pixels.of(self.in_front(light))
    }

    #[inline(always)]
    fn eight(&self, light: [&Rgba; SIDE]) -> [P::Pixel; SIDE] {
        let mut shown = [Rgba::TRANSPARENT; SIDE];
        for (shown, light) in shown.iter_mut().zip(light) {
            *shown = self.in_front(*light);
        }
        self.pixels.eight(shown)
    }
}

impl<P: LightPixels> Palette for FloatArithmetic<'_, P> {
    type Pixel = P::Pixel;
    type Sample = f32;

    #[inline(always)]
    fn texels(&self) -> &[[f32; 4]] {
        bytemuck::cast_slice(self.texels)
    }

    #[inline(always)]
    fn light<S: Simd>(&self, simd: S, texel: u32) -> f32x4<S> {
        f32x4::load_array_ref(simd, &self.texels[texel as usize].0)
    }

    fn pixel(&self, light: Rgba, coverage: f32) -> P::Pixel {
        self.pixels.of((light * coverage).over(self.background))
    }
}
