//! Single pixels, each with a list of its texels: on the edges between views, at rims, and wherever windows do not fit.
//! What all mirror images share is stored and computed once.

use super::symmetry::Mirrors;
use crate::filter::taps::Taps;
use crate::world::{TexelPlace, World};

/// Single pixels of a band, as lists of taps.
#[derive(Clone, Debug, Default)]
pub(crate) struct Singles {
    pixels: Vec<Single>,
    /// Weight of each texel of each pixel.
    weights: Vec<f32>,
    /// Texels of each weight in all mirror images, side by side.
    texels: Vec<u32>,
    /// Offsets of texels from the pixel.
    places: Vec<[f32; 2]>,
}

/// A single pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Single {
    /// Index of its first weight, the number of weights, and the number of its texels that lie under it.
    first: usize,
    taps: u32,
    under: u32,
    /// Index of its first texel's place, and the number of places that are kept.
    first_place: usize,
    places: u32,
    /// Part of the pixel inside the field of view.
    pub(crate) coverage: f32,
    pub(crate) column: u32,
    pub(crate) row: u8,
}

/// Texels of a pixel with their weights, those under it first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SingleTaps<'a> {
    pub(crate) weights: &'a [f32],
    /// Texels in all mirror images, for each weight.
    pub(crate) texels: &'a [u32],
    pub(crate) under: usize,
    /// Places of the texels, if all lie to one side of the pixel's centre.
    pub(crate) places: &'a [[f32; 2]],
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

    /// Returns the number of bytes that the pixels take.
    pub(crate) fn bytes(&self) -> usize {
        self.pixels.capacity() * size_of::<Single>()
            + self.weights.capacity() * size_of::<f32>()
            + self.texels.capacity() * size_of::<u32>()
            + self.places.capacity() * size_of::<[f32; 2]>()
    }

    /// Returns the number of bytes in use, without spare capacity.
    pub(crate) fn used_bytes(&self) -> usize {
        size_of_val(&*self.pixels)
            + size_of_val(&*self.weights)
            + size_of_val(&*self.texels)
            + size_of_val(&*self.places)
    }

    /// Returns the number of texels in all mirror images.
    pub(crate) fn texel_count(&self) -> usize {
        self.texels.len()
    }

    pub(crate) fn pixels(&self) -> &[Single] {
        &self.pixels
    }

    /// Returns the taps of a pixel, in this number of mirror images.
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

    /// Adds a pixel, in all mirror images. `seen` is working memory for the places of its texels.
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
        // Places relative to the pixel's own axes are equal in all mirror images.
        self.places.extend_from_slice(list.places);
        if mirrors.is_packed && mirrors.images.len() == 1 {
            self.texels.extend(list.taps.iter().map(|tap| tap.texel));
            return;
        }
        seen.clear();
        seen.extend(list.taps.iter().map(|tap| world.texel(tap.texel)));
        // Resized once, since growing for each texel would take longer than the rest.
        let (first, images) = (self.texels.len(), mirrors.images.len());
        self.texels.resize(first + images * seen.len(), 0);
        for (image, at) in mirrors.images.iter().zip(first..) {
            let texels = self.texels.iter_mut().skip(at).step_by(images);
            texels.zip(&*seen).for_each(|(texel, &place)| *texel = image.texel(place));
        }
    }
}
