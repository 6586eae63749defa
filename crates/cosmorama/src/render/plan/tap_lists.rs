//! Pixels that come by themselves, each with a list of its texels: on the edges between views, at rims, and wherever windows
//! cannot be held. What is the same in all mirrors is kept once, and done once.

use bytemuck::NoUninit;
use fearless_simd::{Simd, f32x4, prelude::*};

use super::symmetry::Mirrors;
use crate::filter::rim::rim_extrapolation::{Bounds, Rim, TexelLight};
use crate::filter::taps::{BLOCK, Taps};
use crate::raster::Rgba;
use crate::render::apply::tile_writer::Canvas;
use crate::world::{TexelPlace, World};

/// Single pixels of a band, as lists of taps.
#[derive(Clone, Debug, Default)]
pub(crate) struct Singles {
    pixels: Vec<Single>,
    /// What each texel of each counts.
    weights: Vec<f32>,
    /// Of each weight the texels in all mirrors, beside each other.
    texels: Vec<u32>,
    /// Where texels lie from the pixel.
    places: Vec<[f32; 2]>,
}

/// A pixel by itself.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Single {
    /// The first of its weights, how many there are, and how many of its texels lie under it.
    first: usize,
    taps: u32,
    under: u32,
    /// The first of their places, and how many are kept.
    first_place: usize,
    places: u32,
    /// The part of the pixel inside the field of view.
    pub(crate) coverage: f32,
    pub(crate) column: u32,
    pub(crate) row: u8,
}

/// What is known of a pixel's texels, those under it first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SingleTaps<'a> {
    pub(crate) weights: &'a [f32],
    /// For each of them those in all mirrors.
    pub(crate) texels: &'a [u32],
    pub(crate) under: usize,
    /// Where they lie, if all lie to one side of the pixel's centre.
    pub(crate) places: &'a [[f32; 2]],
}

/// What makes colours of texels, and pixels of colours.
pub(crate) trait Palette {
    type Pixel: NoUninit;

    /// The light of a texel.
    fn light<S: Simd>(&self, simd: S, texel: u32) -> f32x4<S>;

    /// What is written where light covers this part of a pixel.
    fn pixel(&self, light: Rgba, coverage: f32) -> Self::Pixel;

    /// Asks for a texel that will be read soon.
    fn prefetch(&self, texel: u32);
}

impl Singles {
    pub(crate) fn clear(&mut self) {
        self.pixels.clear();
        self.weights.clear();
        self.texels.clear();
        self.places.clear();
    }

    pub(crate) fn shrink(&mut self) {
        self.pixels.shrink_to_fit();
        self.weights.shrink_to_fit();
        self.texels.shrink_to_fit();
        self.places.shrink_to_fit();
    }

    /// Bytes that they take.
    pub(crate) fn bytes(&self) -> usize {
        self.pixels.capacity() * size_of::<Single>()
            + self.weights.capacity() * size_of::<f32>()
            + self.texels.capacity() * size_of::<u32>()
            + self.places.capacity() * size_of::<[f32; 2]>()
    }

    /// Bytes of what they hold, without room for more.
    pub(crate) fn used_bytes(&self) -> usize {
        size_of_val(&*self.pixels)
            + size_of_val(&*self.weights)
            + size_of_val(&*self.texels)
            + size_of_val(&*self.places)
    }

    /// How many texels they have, in all mirrors.
    pub(crate) fn texel_count(&self) -> usize {
        self.texels.len()
    }

    pub(crate) fn pixels(&self) -> &[Single] {
        &self.pixels
    }

    /// What one is made of, in so many mirrors.
    #[inline(always)]
    pub(crate) fn taps(&self, single: &Single, images: usize) -> SingleTaps<'_> {
        let taps = single.taps as usize;
        SingleTaps {
            weights: &self.weights[single.first..][..taps],
            texels: &self.texels[images * single.first..][..images * taps],
            under: single.under as usize,
            places: &self.places[single.first_place..][..single.places as usize],
        }
    }

    /// Adds a pixel, in all mirrors. `seen` is memory for where its texels are.
    pub(crate) fn push(
        &mut self,
        (world, mirrors): (&World, &Mirrors),
        [column, row]: [usize; 2],
        coverage: f32,
        taps: &Taps,
        seen: &mut Vec<TexelPlace>,
    ) {
        let list = taps.list();
        self.pixels.push(Single {
            first: self.weights.len(),
            taps: list.taps.len() as u32,
            under: list.under as u32,
            first_place: self.places.len(),
            places: list.places.len() as u32,
            coverage,
            column: column as u32,
            row: row as u8,
        });
        self.weights.extend(list.taps.iter().map(|tap| tap.weight));
        // Mirrored, texels lie otherwise, but not in relation to each other.
        self.places.extend_from_slice(list.places);
        if mirrors.is_packed && mirrors.images.len() == 1 {
            self.texels.extend(list.taps.iter().map(|tap| tap.texel));
            return;
        }
        seen.clear();
        seen.extend(list.taps.iter().map(|tap| world.texel(tap.texel)));
        // Room for all of them first: asked for one by one it would take longer than they do.
        let (first, images) = (self.texels.len(), mirrors.images.len());
        self.texels.resize(first + images * seen.len(), 0);
        for (image, at) in mirrors.images.iter().zip(first..) {
            let texels = self.texels.iter_mut().skip(at).step_by(images);
            texels.zip(&*seen).for_each(|(texel, &place)| *texel = image.texel(place));
        }
    }

    /// Makes their pixels in all mirrors.
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
        let mut ahead = self.pixels.iter().skip(AHEAD);
        for single in &self.pixels {
            let later = ahead.next().map_or(&[][..], |later| self.taps(later, N).texels);
            later.iter().for_each(|texel| palette.prefetch(*texel));
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

/// The light of a pixel's texels in one of N mirrors.
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

/// Pixels that are made between asking for one's texels and reading them.
const AHEAD: usize = 1;

/// The weighted average of a pixel's texels in each of N mirrors, held to what those under the pixel hold if there is to be no
/// ringing.
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
