//! Pixels that come by themselves, each with a list of its texels: on the edges between views, at rims, and wherever windows
//! cannot be held. What is the same in all mirrors is kept once, and done once.

use super::symmetry::Mirrors;
use crate::filter::taps::Taps;
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
}
