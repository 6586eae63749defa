//! Pixels by plans in single precision, for light of any range.

pub(crate) mod large;
pub(crate) mod turned;
pub(crate) mod weights;
pub(crate) mod window;

use fearless_simd::{Simd, f32x4, prelude::*};

use super::driver::{Fresh, Window, WindowArithmetic};
use super::fixed::blocks::Mirrored;
use super::float::weights::FloatFormat;
use super::tap_lists::Palette;
use super::tile_writer::{Canvas, Develop, GroupLight};
use crate::raster::Rgba;
use crate::render::plan::symmetry::Ways;
use crate::render::plan::traversal::Pass;
use crate::render::scan::tile::SIDE;

/// Arithmetic in floats: light of any range, over a background.
#[derive(Clone, Copy)]
pub(crate) struct FloatArithmetic<'a> {
    pub(crate) texels: &'a [Rgba],
    pub(crate) background: Rgba,
}

impl WindowArithmetic for FloatArithmetic<'_> {
    type Format = FloatFormat;
    type Light = Rgba;
    type Shared = ();
    type Fresh = ();

    fn background(&self) -> Rgba {
        self.background
    }

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

    #[inline(always)]
    fn put<S: Simd>(&self, _: S, pass: &Pass, ways: &Ways, light: &GroupLight<Rgba>, canvas: &mut Canvas<Rgba>) {
        canvas.put(pass, ways, light, self);
    }

    #[inline(always)]
    fn put_at_once<S: Simd>(&self, _: S, (): &mut (), _: &Fresh<f32>, _: &mut Canvas<Rgba>) -> bool {
        false
    }
}

impl Develop for FloatArithmetic<'_> {
    type Light = Rgba;
    type Pixel = Rgba;

    #[inline(always)]
    fn one(&self, light: Rgba) -> Rgba {
        if self.background == Rgba::TRANSPARENT { light } else { light.over(self.background) }
    }

    #[inline(always)]
    fn eight(&self, light: [&Rgba; SIDE]) -> [Rgba; SIDE] {
        let mut pixels = [Rgba::TRANSPARENT; SIDE];
        for (pixel, light) in pixels.iter_mut().zip(light) {
            *pixel = self.one(*light);
        }
        pixels
    }
}

impl Palette for FloatArithmetic<'_> {
    type Pixel = Rgba;
    type Sample = f32;

    #[inline(always)]
    fn texels(&self) -> &[[f32; 4]] {
        bytemuck::cast_slice(self.texels)
    }

    #[inline(always)]
    fn light<S: Simd>(&self, simd: S, texel: u32) -> f32x4<S> {
        f32x4::load_array_ref(simd, &self.texels[texel as usize].0)
    }

    fn pixel(&self, light: Rgba, coverage: f32) -> Rgba {
        (light * coverage).over(self.background)
    }
}
