use std::ops::Range;

use rayon::prelude::*;

use super::kernel::KernelTable;
use super::pixel_taps::PixelTaps;
use super::taps::average;
use super::{Filter, FilterKind, Tap, Taps, reference};
use crate::raster::{Image, Rgba};
use crate::world::{ScreenPixel, View, World};

/// Rows of a target that are worked on together.
const BAND: usize = 8;

/// The geometry of a conversion: which texels, with which weights, make each pixel of the target.
///
/// It depends on the views, the target and the filter, not on the light: one plan serves all frames of a sequence.
#[derive(Clone, Debug)]
pub struct Plan {
    width: usize,
    height: usize,
    anti_ringing: bool,
    bands: Vec<Band>,
}

/// The taps of a few rows, one pixel after the other.
#[derive(Clone, Debug, Default)]
struct Band {
    pixels: Vec<PlannedPixel>,
    taps: Vec<Tap>,
}

#[derive(Clone, Copy, Debug, Default)]
struct PlannedPixel {
    /// Taps of this pixel, and how many of them, the first ones, lie under it.
    taps: u32,
    under: u32,
    /// The part of the pixel inside the field of view.
    coverage: f32,
}

/// A conversion from a world to a target view.
#[derive(Clone, Copy, Debug)]
pub struct Resampler<'a> {
    /// Where light comes from.
    pub world: &'a World,
    /// Where it goes.
    pub target: &'a View,
    /// How.
    pub filter: Filter,
}

impl Resampler<'_> {
    /// One frame, computed without storing the geometry. `texels` is the world's buffer of light.
    ///
    /// Pixels are premultiplied by their coverage: transparent outside the lens. A pixel just beyond the world's last texel
    /// takes what its kernel still reaches; [`super::ScreenMask`] tells which pixels see nothing.
    ///
    /// # Panics
    /// If `texels` is not as long as [`World::texel_count`] says.
    pub fn render(&self, texels: &[Rgba]) -> Image<Rgba> {
        assert_eq!(texels.len(), self.world.texel_count(), "one texel of light for each texel of the world");
        if let FilterKind::Reference { samples } = self.filter.kind {
            return reference::render(self.world, self.target, &self.filter, samples, texels);
        }
        let mut image = Image::filled(self.target.width(), self.target.height(), Rgba::TRANSPARENT);
        let width = self.target.width().max(1);
        let table = KernelTable::new(&self.filter.kernel);
        image.pixels_mut().par_chunks_mut(width * BAND).enumerate().for_each(|(index, rows)| {
            let top = index * BAND;
            self.for_each_pixel(&table, top..top + rows.len() / width, |position, screen, taps| {
                let colour = average(taps.as_slice(), taps.under(), texels, self.filter.anti_ringing);
                rows[position] = colour * screen.coverage as f32;
            });
        });
        image
    }

    /// The geometry, for any number of frames; `None` for the reference filter, which has too many samples to store.
    pub fn plan(&self) -> Option<Plan> {
        self.plan_rows(0..self.target.height())
    }

    /// The geometry of some rows: a still can be made strip by strip, in little memory.
    pub fn plan_rows(&self, rows: Range<usize>) -> Option<Plan> {
        if matches!(self.filter.kind, FilterKind::Reference { .. }) {
            return None;
        }
        let table = KernelTable::new(&self.filter.kernel);
        let tops: Vec<usize> = rows.clone().step_by(BAND).collect();
        let band = |&top: &usize| self.plan_band(&table, top..rows.end.min(top + BAND));
        let bands = tops.par_iter().map(band).collect();
        Some(Plan { width: self.target.width(), height: rows.len(), anti_ringing: self.filter.anti_ringing, bands })
    }

    /// About how many bytes [`Resampler::plan`] would hold: found from every sixteenth band of rows.
    pub fn plan_bytes_estimate(&self) -> usize {
        const STRIDE: usize = 16;
        if matches!(self.filter.kind, FilterKind::Reference { .. }) {
            return 0;
        }
        let table = KernelTable::new(&self.filter.kernel);
        let bands = self.target.height().div_ceil(BAND);
        // From the middle of the first stride, so that a low image is not judged by its first rows.
        let first = STRIDE.min(bands) / 2;
        let sampled: Vec<usize> = (first..bands).step_by(STRIDE).collect();
        let rows = |band: usize| band * BAND..self.target.height().min((band + 1) * BAND);
        let bytes: usize = sampled.par_iter().map(|&band| self.plan_band(&table, rows(band)).bytes()).sum();
        bytes * bands / sampled.len().max(1)
    }

    fn plan_band(&self, table: &KernelTable, rows: Range<usize>) -> Band {
        let pixels = vec![PlannedPixel::default(); rows.len() * self.target.width()];
        let mut band = Band { pixels, taps: Vec::new() };
        self.for_each_pixel(table, rows, |position, screen, taps| {
            band.taps.extend_from_slice(taps.as_slice());
            band.pixels[position] = PlannedPixel {
                taps: taps.as_slice().len() as u32,
                under: taps.under() as u32,
                coverage: screen.coverage as f32,
            };
        });
        band.taps.shrink_to_fit();
        band
    }

    /// Calls `visit` with the position within the rows, the pixel and its taps, for every pixel that shows something.
    fn for_each_pixel(
        &self,
        table: &KernelTable,
        rows: Range<usize>,
        mut visit: impl FnMut(usize, &ScreenPixel, &Taps),
    ) {
        let mut pixel_taps = PixelTaps::new(self.world, self.target, &self.filter, table);
        let (width, top) = (self.target.width(), rows.start);
        for j in rows {
            for i in 0..width {
                let Some(screen) = self.target.screen_pixel(i, j) else { continue };
                let Some(taps) = pixel_taps.taps(&screen) else { continue };
                visit((j - top) * width + i, &screen, taps);
            }
        }
    }
}

impl Plan {
    /// One frame, or as many of its rows as were planned. `texels` is the world's buffer of light.
    pub fn apply(&self, texels: &[Rgba]) -> Image<Rgba> {
        let mut image = Image::filled(self.width, self.height, Rgba::TRANSPARENT);
        self.apply_to(texels, image.pixels_mut());
        image
    }

    /// The same, into the place of the rows that were planned.
    ///
    /// # Panics
    /// If `pixels` are not as many as those rows have.
    pub fn apply_to(&self, texels: &[Rgba], pixels: &mut [Rgba]) {
        assert_eq!(pixels.len(), self.width * self.height, "the rows that were planned");
        let rows = pixels.par_chunks_mut(self.width.max(1) * BAND);
        rows.zip(&self.bands).for_each(|(rows, band)| {
            let mut rest = band.taps.as_slice();
            for (pixel, planned) in rows.iter_mut().zip(&band.pixels) {
                let taps;
                (taps, rest) = rest.split_at(planned.taps as usize);
                *pixel = average(taps, planned.under as usize, texels, self.anti_ringing) * planned.coverage;
            }
        });
    }

    /// Bytes that a plan of so many pixels and taps holds.
    pub(crate) fn bytes_for(pixels: usize, taps: usize) -> usize {
        pixels * size_of::<PlannedPixel>() + taps * size_of::<Tap>()
    }

    /// Bytes of memory that the plan holds.
    pub fn bytes(&self) -> usize {
        self.bands.iter().map(Band::bytes).sum()
    }
}

impl Band {
    fn bytes(&self) -> usize {
        self.taps.capacity() * size_of::<Tap>() + self.pixels.capacity() * size_of::<PlannedPixel>()
    }
}
