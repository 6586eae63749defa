//! Single pixels of a band, computed from the lists of their texels.

use bytemuck::NoUninit;
use fearless_simd::{Simd, f32x4, prelude::*};

use super::texels::prefetch;
use super::tile_writer::Canvas;
use crate::filter::rim::rim_extrapolation::{Bounds, Rim, TexelLight};
use crate::filter::taps::BLOCK;
use crate::raster::Rgba;
use crate::render::plan::symmetry::Mirrors;
use crate::render::plan::tap_lists::{SingleTaps, Singles};

/// Conversion of texels to colours, and of colours to pixels.
pub(crate) trait Palette {
    type Pixel: NoUninit;
    type Sample: Copy;

    /// Returns the texels as they lie in memory.
    fn texels(&self) -> &[[Self::Sample; 4]];

    /// Returns the light of a texel.
    fn light<S: Simd>(&self, simd: S, texel: u32) -> f32x4<S>;

    /// Returns the pixel for light that covers this part of it.
    fn pixel(&self, light: Rgba, coverage: f32) -> Self::Pixel;
}

impl Singles {
    /// Makes the pixels in all mirror images.
    #[inline(always)]
    pub(crate) fn fill<S: Simd, P: Palette>(
        &self,
        simd: S,
        mirrors: &Mirrors,
        (palette, anti_ringing): (&P, bool),
        canvas: &mut Canvas<P::Pixel>,
    ) {
        match mirrors.images.len() {
            8 => self.fill_all::<S, P, 8>(simd, (palette, anti_ringing), canvas),
            4 => self.fill_all::<S, P, 4>(simd, (palette, anti_ringing), canvas),
            2 => self.fill_all::<S, P, 2>(simd, (palette, anti_ringing), canvas),
            images => {
                assert_eq!(images, 1, "a picture is mirrored in each direction or not");
                self.fill_all::<S, P, 1>(simd, (palette, anti_ringing), canvas);
            }
        }
    }

    #[inline(always)]
    fn fill_all<S: Simd, P: Palette, const N: usize>(
        &self,
        simd: S,
        (palette, anti_ringing): (&P, bool),
        canvas: &mut Canvas<P::Pixel>,
    ) {
        let mut ahead = self.pixels().iter().skip(AHEAD);
        for single in self.pixels() {
            let later = ahead.next().map_or(&[][..], |later| self.taps(later, N).texels);
            later.iter().for_each(|texel| prefetch(palette.texels(), *texel));
            let taps = self.taps(single, N);
            let averages = simd.vectorize(
                #[inline(always)]
                || averages::<S, P, N>(simd, &taps, palette, anti_ringing),
            );
            let pixel = [single.column as usize, usize::from(single.row)];
            for (image, light) in averages.into_iter().enumerate().take(canvas.images_of(pixel).len()) {
                *canvas.pixel(image, pixel) = palette.pixel(light, single.coverage);
            }
        }
    }
}

/// Light of a pixel's texels in one of N mirror images.
struct ImageLight<'a, P, const N: usize> {
    palette: &'a P,
    texels: &'a [[u32; N]],
    image: usize,
}

impl<P: Palette, const N: usize> TexelLight for ImageLight<'_, P, N> {
    #[inline(always)]
    fn light<S: Simd>(&self, simd: S, index: usize) -> f32x4<S> {
        self.palette.light(simd, self.texels[index][self.image])
    }
}

/// Number of pixels that are made between the prefetch of a pixel's texels and their use.
const AHEAD: usize = 1;

/// Averages a pixel's texels by their weights in each of N mirror images. With `anti_ringing` the average is clamped to
/// the texels under the pixel.
#[inline(always)]
fn averages<S: Simd, P: Palette, const N: usize>(
    simd: S,
    taps: &SingleTaps,
    palette: &P,
    anti_ringing: bool,
) -> [Rgba; N] {
    let mut sums = [[0f64; 4]; N];
    let (mut least, mut greatest) =
        ([f32x4::splat(simd, f32::INFINITY); N], [f32x4::splat(simd, f32::NEG_INFINITY); N]);
    let texels = taps.texels.as_chunks::<N>().0;
    let ((inner, outer), (inner_texels, outer_texels)) =
        (taps.weights.split_at(taps.under), texels.split_at(taps.under));
    for (weights, texels) in inner.chunks(BLOCK).zip(inner_texels.chunks(BLOCK)) {
        let mut parts = [f32x4::splat(simd, 0.0); N];
        for (weight, texels) in weights.iter().zip(texels) {
            for image in 0..N {
                let light = palette.light(simd, texels[image]);
                parts[image] += light * *weight;
                least[image] = least[image].min(light);
                greatest[image] = greatest[image].max(light);
            }
        }
        add(&mut sums, parts);
    }
    for (weights, texels) in outer.chunks(BLOCK).zip(outer_texels.chunks(BLOCK)) {
        let mut parts = [f32x4::splat(simd, 0.0); N];
        for (weight, texels) in weights.iter().zip(texels) {
            for image in 0..N {
                parts[image] += palette.light(simd, texels[image]) * *weight;
            }
        }
        add(&mut sums, parts);
    }
    let mut averages = [Rgba::TRANSPARENT; N];
    let rim = Rim::new(taps.places);
    for image in 0..N {
        let average = Rgba(sums[image].map(|value| value as f32));
        averages[image] = if anti_ringing && taps.under > 0 {
            let bounds = Bounds { least: least[image].to_array(), greatest: greatest[image].to_array() };
            rim.hold(simd, average, &bounds, &ImageLight { palette, texels, image })
        } else {
            average
        };
    }
    averages
}

#[inline(always)]
fn add<S: Simd, const N: usize>(sums: &mut [[f64; 4]; N], parts: [f32x4<S>; N]) {
    for (sum, part) in sums.iter_mut().zip(parts) {
        for (sum, part) in sum.iter_mut().zip(part.to_array()) {
            *sum += f64::from(part);
        }
    }
}
