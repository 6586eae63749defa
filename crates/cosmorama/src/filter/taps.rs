use fearless_simd::{Level, Simd, dispatch, f32x4, prelude::*};

use super::rim::rim_extrapolation::{Bounds, Rim, TexelLight};
use crate::raster::Rgba;

/// Number of texels that are summed in single precision before the sum continues in double. A pixel of thousands of
/// texels loses no digits, and a common pixel costs nothing more.
pub(crate) const BLOCK: usize = 32;

/// Part of one texel in an output pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tap {
    /// Index of the texel in the world's buffer.
    pub(crate) texel: u32,
    /// Weight of the texel.
    pub(crate) weight: f32,
}

/// Texels of an output pixel with their weights, as a filter finds them for a footprint.
#[derive(Clone, Debug, Default)]
pub(crate) struct Taps {
    taps: Vec<Tap>,
    /// Number of taps under the pixel, which are the first ones.
    under: usize,
    /// Offsets from the pixel's centre, in screen pixels; filled only if every tap lies to one side of it.
    places: Vec<[f32; 2]>,
}

/// Texels of an output pixel with their weights, borrowed from where they are kept.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TapList<'a> {
    /// All taps, those under the pixel first.
    pub(crate) taps: &'a [Tap],
    /// Number of taps under the pixel; anti-ringing clamps the average to them.
    pub(crate) under: usize,
    /// Place of each tap if all lie to one side of the pixel's centre, where a slope is continued beyond them.
    /// Otherwise empty.
    pub(crate) places: &'a [[f32; 2]],
}

impl Taps {
    /// Forgets all taps but keeps the memory.
    pub(crate) fn clear(&mut self) {
        self.taps.clear();
        self.under = 0;
        self.places.clear();
    }

    /// Returns all taps, those under the pixel first.
    pub(crate) fn as_slice(&self) -> &[Tap] {
        &self.taps
    }

    /// Returns the taps with their places and the number under the pixel.
    pub(crate) fn list(&self) -> TapList<'_> {
        TapList { taps: &self.taps, under: self.under, places: &self.places }
    }

    /// Returns whether there is no tap.
    pub(crate) fn is_empty(&self) -> bool {
        self.taps.is_empty()
    }

    /// Adds a tap under the pixel; call before any tap outside it.
    pub(crate) fn push_under(&mut self, texel: u32, weight: f32) {
        self.taps.push(Tap { texel, weight });
        self.under = self.taps.len();
    }

    /// Replaces the taps by `count` others, of which `under` lie under the pixel. A flag with each tap tells whether it
    /// does.
    pub(crate) fn fill(&mut self, taps: impl Iterator<Item = (bool, Tap)>, count: usize, under: usize) {
        self.clear();
        self.taps.resize(count, Tap { texel: 0, weight: 0.0 });
        // Where none lies under the pixel, beyond a view's edge, all of them bound it.
        self.under = if under == 0 { count } else { under };
        // Each tap goes to the end of its own part.
        let mut ends = [under, 0];
        for (is_under, tap) in taps {
            let end = &mut ends[usize::from(is_under)];
            self.taps[*end] = tap;
            *end += 1;
        }
    }

    /// Sets the places of all taps, in their order, where all lie to one side of the pixel's centre.
    pub(crate) fn set_places(&mut self, places: impl Iterator<Item = [f32; 2]>) {
        self.places.clear();
        self.places.extend(places);
    }

    /// Scales the weights to a sum of one.
    pub(crate) fn normalise(&mut self) {
        let sum: f64 = self.taps.iter().map(|tap| f64::from(tap.weight)).sum();
        for tap in &mut self.taps {
            tap.weight = (f64::from(tap.weight) / sum) as f32;
        }
    }
}

/// Averages taps by their weights; `light` returns the light of a texel. With `anti_ringing` the average is clamped to
/// the taps under the pixel.
pub(crate) fn average(list: TapList, light: impl Fn(u32) -> Rgba, anti_ringing: bool) -> Rgba {
    let mut sum = [0f64; 4];
    let mut bounds = Bounds { least: [f32::INFINITY; 4], greatest: [f32::NEG_INFINITY; 4] };
    let (inner, outer) = list.taps.split_at(list.under);
    add(&mut sum, inner, |texel| {
        let texel = light(texel);
        for c in 0..4 {
            bounds.least[c] = bounds.least[c].min(texel.0[c]);
            bounds.greatest[c] = bounds.greatest[c].max(texel.0[c]);
        }
        texel
    });
    add(&mut sum, outer, &light);
    let average = Rgba(sum.map(|value| value as f32));
    if !anti_ringing || list.under == 0 {
        return average;
    }
    let (rim, texels) = (Rim::new(list.places), TapLight { taps: list.taps, light });
    dispatch!(Level::new(), simd => rim.hold(simd, average, &bounds, &texels))
}

/// Adds the light of taps, block by block.
fn add(sum: &mut [f64; 4], taps: &[Tap], mut light: impl FnMut(u32) -> Rgba) {
    for block in taps.chunks(BLOCK) {
        let mut part = Rgba::TRANSPARENT;
        for tap in block {
            part += light(tap.texel) * tap.weight;
        }
        (0..4).for_each(|c| sum[c] += f64::from(part.0[c]));
    }
}

/// Light of taps, in their order.
struct TapLight<'a, F> {
    taps: &'a [Tap],
    light: F,
}

impl<F: Fn(u32) -> Rgba> TexelLight for TapLight<'_, F> {
    fn light<S: Simd>(&self, simd: S, index: usize) -> f32x4<S> {
        f32x4::load_array_ref(simd, &(self.light)(self.taps[index].texel).0)
    }
}
