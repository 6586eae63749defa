use std::ops::Range;

use rayon::prelude::*;

use super::kernel::KernelTable;
use super::patch::SIDE;
use super::scan::{Scan, Sink};
use super::taps::{Bound, average};
use super::window::Windows;
use super::{Filter, FilterKind, Tap, Taps, reference};
use crate::raster::{Image, Rgba};
use crate::world::{View, World};

/// Rows of a target that are worked on together: those of a patch.
const BAND: usize = SIDE;

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

/// The taps of a few rows.
#[derive(Clone, Debug, Default)]
struct Band {
    pixels: Vec<PlannedPixel>,
    taps: Vec<Tap>,
}

#[derive(Clone, Copy, Debug, Default)]
struct PlannedPixel {
    /// The first of its taps, how many there are, and what holds their average.
    first: u32,
    taps: u32,
    bound: Bound,
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
    /// A [`Plan`] adds the same weights in another order: equal but for the last digits of single precision.
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
            let taken = top..top + rows.len() / width;
            let mut painter = Painter { texels, anti_ringing: self.filter.anti_ringing, rows };
            Scan::new(self, &table).rows(taken, &mut painter);
        });
        image
    }

    /// The geometry, for any number of frames; `None` for the reference filter, which has too many samples to store.
    pub fn plan(&self) -> Option<Plan> {
        if matches!(self.filter.kind, FilterKind::Reference { .. }) {
            return None;
        }
        let table = KernelTable::new(&self.filter.kernel);
        let (width, height) = (self.target.width(), self.target.height());
        let tops: Vec<usize> = (0..height).step_by(BAND).collect();
        let bands = tops.par_iter().map(|&top| self.plan_band(&table, top..height.min(top + BAND))).collect();
        Some(Plan { width, height, anti_ringing: self.filter.anti_ringing, bands })
    }

    /// About how many bytes [`Resampler::plan`] would hold: found from every sixteenth band of rows, keeping nothing.
    pub fn plan_bytes_estimate(&self) -> usize {
        const STRIDE: usize = 16;
        if matches!(self.filter.kind, FilterKind::Reference { .. }) {
            return 0;
        }
        let table = KernelTable::new(&self.filter.kernel);
        let (width, height) = (self.target.width(), self.target.height());
        let bands = height.div_ceil(BAND);
        // From the middle of the first stride, so that a low image is not judged by its first rows.
        let first = STRIDE.min(bands) / 2;
        let sampled: Vec<usize> = (first..bands).step_by(STRIDE).collect();
        let taps = |band: &usize| {
            let mut counter = Counter { taps: 0 };
            Scan::new(self, &table).rows(band * BAND..height.min((band + 1) * BAND), &mut counter);
            counter.taps
        };
        let taps: usize = sampled.par_iter().map(taps).sum();
        Plan::bytes_for(width * height, taps * bands / sampled.len().max(1))
    }

    fn plan_band(&self, table: &KernelTable, rows: Range<usize>) -> Band {
        let pixels = vec![PlannedPixel::default(); rows.len() * self.target.width()];
        let mut recorder = Recorder { band: Band { pixels, taps: Vec::new() }, taps: Taps::default() };
        Scan::new(self, table).rows(rows, &mut recorder);
        recorder.band.taps.shrink_to_fit();
        recorder.band
    }
}

/// Makes pixels as they come.
pub(super) struct Painter<'a> {
    pub(super) texels: &'a [Rgba],
    pub(super) anti_ringing: bool,
    pub(super) rows: &'a mut [Rgba],
}

impl Sink for Painter<'_> {
    fn pixel(&mut self, position: usize, coverage: f32, taps: &Taps) {
        self.rows[position] = average(taps.as_slice(), taps.bound(), self.texels, self.anti_ringing) * coverage;
    }

    fn windows(&mut self, position: usize, count: usize, windows: &Windows) {
        let colours = windows.average(self.texels, self.anti_ringing);
        self.rows[position..position + count].copy_from_slice(&colours[..count]);
    }
}

/// Counts their taps.
struct Counter {
    taps: usize,
}

impl Sink for Counter {
    fn pixel(&mut self, _: usize, _: f32, taps: &Taps) {
        self.taps += taps.as_slice().len();
    }

    fn windows(&mut self, _: usize, count: usize, windows: &Windows) {
        self.taps += (0..count).map(|lane| windows.tap_count(lane)).sum::<usize>();
    }
}

/// Writes down what makes them.
struct Recorder {
    band: Band,
    taps: Taps,
}

impl Sink for Recorder {
    fn pixel(&mut self, position: usize, coverage: f32, taps: &Taps) {
        self.band.add(position, coverage, taps);
    }

    fn windows(&mut self, position: usize, count: usize, windows: &Windows) {
        for lane in (0..count).filter(|&lane| windows.holds(lane)) {
            windows.taps(lane, &mut self.taps);
            self.band.add(position + lane, 1.0, &self.taps);
        }
    }
}

impl Plan {
    /// One frame. `texels` is the world's buffer of light.
    pub fn apply(&self, texels: &[Rgba]) -> Image<Rgba> {
        let mut image = Image::filled(self.width, self.height, Rgba::TRANSPARENT);
        let rows = image.pixels_mut().par_chunks_mut(self.width.max(1) * BAND);
        rows.zip(&self.bands).for_each(|(rows, band)| {
            for (pixel, planned) in rows.iter_mut().zip(&band.pixels) {
                let taps = &band.taps[planned.first as usize..][..planned.taps as usize];
                *pixel = average(taps, planned.bound, texels, self.anti_ringing) * planned.coverage;
            }
        });
        image
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
    fn add(&mut self, position: usize, coverage: f32, taps: &Taps) {
        self.pixels[position] = PlannedPixel {
            first: self.taps.len() as u32,
            taps: taps.as_slice().len() as u32,
            bound: taps.bound(),
            coverage,
        };
        self.taps.extend_from_slice(taps.as_slice());
    }

    fn bytes(&self) -> usize {
        self.taps.capacity() * size_of::<Tap>() + self.pixels.capacity() * size_of::<PlannedPixel>()
    }
}
