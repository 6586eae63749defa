//! Geometry compiled once for any number of frames.

pub(crate) mod band;
pub(crate) mod recorder;
pub(crate) mod span;
pub(crate) mod symmetry;
pub(crate) mod tap_lists;
#[cfg(test)]
mod tests;
pub(crate) mod transpose;
pub(crate) mod traversal;
pub(crate) mod weights;
pub(crate) mod window_format;
pub(crate) mod window_order;

use std::ops::Range;

use bytemuck::NoUninit;
use rayon::prelude::*;

use crate::render::apply::driver::{BandFilter, WindowArithmetic};
use crate::render::apply::fixed::FixedArithmetic;
use crate::render::apply::fixed::weights::FixedFormat;
use crate::render::apply::float::weights::FloatFormat;
use crate::render::apply::float::{FloatArithmetic, Uncoded};
use crate::render::apply::tile_writer::Canvas;
use band::Band;
use recorder::{Maker, Outlet, Painter, Recorder};
use symmetry::{MirrorImage, Mirrors, exchanged};
use window_format::Format;

use super::Resampler;
use super::batch::window::Level;
use super::progress::Watch;
use super::pyramid::PyramidPlan;
use super::scan::sampling::Sampling;
use super::scan::tile::SIDE;
use super::scan::wanted::Wanted;
use super::scan::{Area, Scan};
use crate::camera::PixelRect;
use crate::filter::FilterKind;
use crate::filter::kernel::KernelTable;
use crate::filter::taps::Taps;
use crate::raster::{Encoder, FixedCodec, FixedLight, Image, Rgba};

/// Number of rows of a target that are processed together, in tiles: those of a few patches.
const BAND: usize = 4 * SIDE;

/// Geometry of a conversion: the texels and the weights that make each pixel of the target.
///
/// It depends on the views, the target and the filter, but not on the light: one plan serves all frames of a sequence.
#[derive(Clone, Debug)]
pub struct Plan(Geometry);

/// Type of number in which a plan holds weights and takes light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arithmetic {
    /// Floats: light of any range, with alpha.
    Float,
    /// Integers of 15 bits: opaque pictures of 8-bit files.
    Fixed,
}

impl Arithmetic {
    /// Returns whether there are plans of a filter in these numbers. The reference has too many samples to keep, labels are
    /// chosen by their values, other filters work pixel by pixel, and the levels of a pyramid are floats.
    pub fn has_plan_of(self, filter: FilterKind) -> bool {
        match filter {
            FilterKind::Ewa | FilterKind::Point | FilterKind::Bilinear => true,
            FilterKind::EwaPyramid => self == Self::Float,
            FilterKind::Labels(_) | FilterKind::Classic(_) | FilterKind::Reference { .. } => false,
        }
    }
}

#[derive(Clone, Debug)]
enum Geometry {
    Float(Compiled<FloatFormat>),
    Fixed(Compiled<FixedFormat>),
    /// Plan in floats, by level.
    Pyramid(PyramidPlan),
}

#[derive(Clone, Debug)]
pub(crate) struct Compiled<F> {
    width: usize,
    height: usize,
    anti_ringing: bool,
    mirrors: Mirrors,
    bands: Vec<Band<F>>,
}

impl Plan {
    /// Compiles the geometry of a conversion; `None` for filters that have no plan in these numbers.
    pub(crate) fn new(resampler: &Resampler, arithmetic: Arithmetic, watch: Watch) -> Option<Self> {
        if !arithmetic.has_plan_of(resampler.filter.kind) {
            return None;
        }
        let geometry = match (arithmetic, resampler.filter.kind) {
            (Arithmetic::Float, FilterKind::EwaPyramid) => Geometry::Pyramid(PyramidPlan::new(resampler, watch)),
            (Arithmetic::Float, _) => {
                Geometry::Float(Compiled::new((resampler, Sampling::default()), Level::new(), watch))
            }
            (Arithmetic::Fixed, _) => {
                Geometry::Fixed(Compiled::new((resampler, Sampling::default()), Level::new(), watch))
            }
        };
        Some(Self(geometry))
    }

    /// Compiles the wanted patches alone, in floats; other pixels become transparent.
    pub(crate) fn of_part(resampler: &Resampler, wanted: &Wanted, watch: Watch) -> Self {
        Self(Geometry::Float(Compiled::new((resampler, Sampling::only(wanted)), Level::new(), watch)))
    }

    /// Makes one frame from `texels`, the world's buffer of light.
    ///
    /// # Panics
    /// If there are fewer texels than in the world, or the plan is one of integers.
    pub fn apply(&self, texels: &[Rgba]) -> Image<Rgba> {
        self.apply_over(texels, Rgba::TRANSPARENT)
    }

    /// Makes one frame in front of a background, in linear, premultiplied light.
    ///
    /// # Panics
    /// As [`Plan::apply`].
    pub fn apply_over(&self, texels: &[Rgba], background: Rgba) -> Image<Rgba> {
        let (width, height) = self.size();
        let mut image = Image::zeroed(width, height);
        self.apply_into(texels, background, &mut image);
        image
    }

    /// Makes one frame in an existing image: fresh memory may cost as much time as the frame's pixels.
    ///
    /// # Panics
    /// As [`Plan::apply`], or if the image is not of the target's size.
    pub fn apply_into(&self, texels: &[Rgba], background: Rgba, image: &mut Image<Rgba>) {
        match &self.0 {
            Geometry::Float(compiled) => {
                compiled.fill(FloatArithmetic { texels, background, pixels: Uncoded }, Level::new(), image)
            }
            Geometry::Pyramid(plan) => plan.apply_into(texels, background, image),
            Geometry::Fixed(_) => panic!("a plan of integers takes light of 15 bits"),
        }
    }

    /// Returns whether it makes the samples of an encoder at once: it is one of floats, not of a pyramid, and the samples are opaque
    /// pixels of 8 bits.
    pub fn encodes(&self, encoder: &Encoder) -> bool {
        matches!(self.0, Geometry::Float(_)) && encoder.rgb_codes().is_some()
    }

    /// Makes the samples of one frame in front of a background in an existing image: those that the encoder makes of
    /// [`apply_over`](Self::apply_over), without a picture of light, five times as large, between.
    ///
    /// # Panics
    /// As [`Plan::apply_into`], or if [`encodes`](Self::encodes) says that it cannot.
    pub fn apply_encoded_into(&self, texels: &[Rgba], background: Rgba, encoder: &Encoder, image: &mut Image<[u8; 3]>) {
        let (Geometry::Float(compiled), Some(pixels)) = (&self.0, encoder.rgb_codes()) else {
            panic!("a plan of floats and samples of 8 bits")
        };
        compiled.fill(FloatArithmetic { texels, background, pixels }, Level::new(), image);
    }

    /// Makes the code values of one frame by a plan of integers. `light` holds all the world's texels.
    ///
    /// # Panics
    /// If the light is of other views than the world's, or the plan is not one of integers.
    pub fn apply_fixed(&self, light: &FixedLight, codec: &FixedCodec) -> Image<[u8; 3]> {
        let (width, height) = self.size();
        let mut image = Image::zeroed(width, height);
        self.apply_fixed_into(light, codec, &mut image);
        image
    }

    /// Makes one frame by a plan of integers in an existing image: fresh memory may cost a third of a frame's time.
    ///
    /// # Panics
    /// As [`Plan::apply_fixed`], or if the image is not of the target's size.
    pub fn apply_fixed_into(&self, light: &FixedLight, codec: &FixedCodec, image: &mut Image<[u8; 3]>) {
        let Geometry::Fixed(compiled) = &self.0 else { panic!("a plan of floats takes light of any range") };
        assert!(compiled.mirrors.layout().eq(light.layout()), "light of the world's views");
        compiled.fill(FixedArithmetic { light, codec }, Level::new(), image);
    }

    /// Returns the number of bytes that the plan holds.
    pub fn bytes(&self) -> usize {
        match &self.0 {
            Geometry::Float(compiled) => compiled.bytes(),
            Geometry::Fixed(compiled) => compiled.bytes(),
            Geometry::Pyramid(plan) => plan.bytes(),
        }
    }

    fn size(&self) -> (usize, usize) {
        match &self.0 {
            Geometry::Float(Compiled { width, height, .. }) | Geometry::Fixed(Compiled { width, height, .. }) => {
                (*width, *height)
            }
            Geometry::Pyramid(plan) => plan.size(),
        }
    }
}

/// Estimates the bytes that the plan of a conversion would hold, from some bands of rows and without keeping anything.
/// It is 0 where there is no plan.
pub(crate) fn bytes_estimate(resampler: &Resampler, arithmetic: Arithmetic) -> usize {
    if !arithmetic.has_plan_of(resampler.filter.kind) {
        return 0;
    }
    match (arithmetic, resampler.filter.kind) {
        (Arithmetic::Float, FilterKind::EwaPyramid) => PyramidPlan::bytes_estimate(resampler),
        (Arithmetic::Float, _) => part_bytes_estimate::<FloatFormat>(resampler, Sampling::default()),
        (Arithmetic::Fixed, _) => part_bytes_estimate::<FixedFormat>(resampler, Sampling::default()),
    }
}

/// Estimates the bytes that the plan of wanted patches would hold.
pub(crate) fn float_bytes_estimate(resampler: &Resampler, wanted: &Wanted) -> usize {
    part_bytes_estimate::<FloatFormat>(resampler, Sampling::only(wanted))
}

/// Renders a frame without keeping a plan: each band's geometry is dropped when its pixels are made. If only some
/// patches are wanted, the rest is background.
pub(crate) fn render<A: WindowArithmetic>(
    (resampler, sampling): (&Resampler, Sampling),
    arithmetic: A,
    level: Level,
    watch: Watch,
) -> Image<A::Pixel> {
    let mirrors = match sampling.lens {
        // What lies around a lens has no symmetry with it.
        Some(_) => &Mirrors::none::<A::Format>(resampler),
        None => &Mirrors::of::<A::Format>(resampler),
    };
    let mut image = Image::zeroed(resampler.target.width(), resampler.target.height());
    let pixels = (image.pixels_mut(), arithmetic.background());
    let filter = BandFilter { level, mirrors, anti_ringing: resampler.filter.anti_ringing, arithmetic };
    each_band((resampler, sampling), mirrors, pixels, (level, watch), &filter);
    image
}

/// Estimates the bytes that the plan of a conversion would hold, from a row of patches in each band, keeping none of
/// them. A small picture is measured whole, in hundredths of a second: it has few bands, and a pole in one of them
/// holds most of the bytes.
fn part_bytes_estimate<F: Format>(resampler: &Resampler, sampling: Sampling) -> usize {
    const SMALL: usize = 512 * 512;
    let mirrors = &Mirrors::of::<F>(resampler);
    let table = KernelTable::new(&resampler.filter.kernel);
    let is_small = mirrors.rows * mirrors.columns <= SMALL;
    let bytes = |index: usize| {
        let band = mirrors.band(index);
        // Not the same patches in all bands, since the edge of the picture would count too often.
        let top = band.start + index % (BAND / SIDE) * SIDE;
        let rows = if top < band.end && !is_small { top..band.end.min(top + SIDE) } else { band };
        let (mut kept, mut bytes, count) = (Band::<F>::default(), 0, rows.len());
        record((resampler, sampling), mirrors, &table, rows, Level::new(), &mut kept, |band: &mut Band<F>| {
            bytes += band.used_bytes();
            band.clear();
        });
        (bytes + kept.used_bytes(), count)
    };
    let sampled = (0..mirrors.rows.div_ceil(BAND)).into_par_iter().map(bytes);
    let (bytes, rows) = sampled.reduce(|| (0, 0), |a, b| (a.0 + b.0, a.1 + b.1));
    bytes * mirrors.rows / rows.max(1) + mirrors.rows.div_ceil(BAND) * size_of::<Band<F>>()
}

impl<F: Format> Compiled<F> {
    fn new((resampler, sampling): (&Resampler, Sampling), level: Level, watch: Watch) -> Self {
        let Resampler { target, filter, .. } = resampler;
        let mirrors = Mirrors::of::<F>(resampler);
        let table = KernelTable::new(&filter.kernel);
        let compile = |index| {
            let mut band = Band::default();
            record(
                (resampler, sampling),
                &mirrors,
                &table,
                mirrors.band(index),
                level,
                &mut band,
                |_: &mut Band<F>| {},
            );
            band.settle();
            band
        };
        let count = mirrors.rows.div_ceil(BAND);
        let parts = watch.parts(count);
        // Bands go to threads one by one, as below. A plan that is stopped lacks bands, but nobody sees it.
        let bands = (0..count).into_par_iter().with_max_len(1);
        let bands = bands.map(|index| parts.part(|| compile(index)).unwrap_or_default()).collect();
        let (width, height) = (target.width(), target.height());
        Self { width, height, anti_ringing: filter.anti_ringing, mirrors, bands }
    }

    fn fill<A: WindowArithmetic<Format = F>>(&self, arithmetic: A, level: Level, image: &mut Image<A::Pixel>) {
        let (found, expected) = ((image.width(), image.height()), (self.width, self.height));
        assert_eq!(found, expected, "an image as large as the target");
        let Self { anti_ringing, ref mirrors, .. } = *self;
        let canvases = Canvas::bands(image.pixels_mut(), self.width, BAND, mirrors, arithmetic.background());
        let filter = BandFilter { level, mirrors, anti_ringing, arithmetic };
        // Bands go to threads one by one: with mirror images about the diagonals, the first bands have far more pixels
        // than the last.
        let bands = canvases.into_par_iter().zip(&self.bands).with_max_len(1);
        bands.for_each(|(mut canvas, band)| filter.fill(band, &mut canvas));
    }

    fn bytes(&self) -> usize {
        // Of narrow pictures, bands are most of it, though little may be in them.
        self.bands.capacity() * size_of::<Band<F>>() + self.bands.iter().map(Band::bytes).sum::<usize>()
    }
}

/// Records each band, makes its pixels and drops it. All pixels are zeros before.
fn each_band<F: Format, P: NoUninit + Send + Sync, M: Maker<F, P>>(
    (resampler, sampling): (&Resampler, Sampling),
    mirrors: &Mirrors,
    (pixels, background): (&mut [P], P),
    (level, watch): (Level, Watch),
    maker: &M,
) {
    let table = &KernelTable::new(&resampler.filter.kernel);
    let is_blank = bytemuck::bytes_of(&background).iter().all(|byte| *byte == 0);
    let canvases = Canvas::bands(pixels, resampler.target.width(), BAND, mirrors, background);
    let canvases: Vec<_> =
        canvases.into_iter().map(|canvas| if is_blank { canvas.on_blank() } else { canvas }).collect();
    let parts = watch.parts(canvases.len());
    let memory = <(Band<F>, M::Memory)>::default;
    canvases.into_par_iter().enumerate().for_each_init(memory, |(band, memory), (index, mut canvas)| {
        parts.part(|| {
            band.clear();
            let painter = Painter { maker, memory, canvas: &mut canvas };
            record((resampler, sampling), mirrors, table, mirrors.band(index), level, band, painter);
            maker.fill(band, &mut canvas);
        });
    });
}

/// Records some rows.
fn record<F: Format>(
    (resampler, sampling): (&Resampler, Sampling),
    mirrors: &Mirrors,
    table: &KernelTable,
    rows: Range<usize>,
    level: Level,
    band: &mut Band<F>,
    outlet: impl Outlet<F>,
) {
    let mut recorder =
        Recorder { world: resampler.world, mirrors, band, taps: Taps::default(), places: Vec::new(), outlet };
    let area = Area { columns: mirrors.columns, rows, skips_left_of_diagonal: mirrors.has_diagonals() };
    Scan::new((resampler, sampling), table, level).pixels(&area, &mut recorder);
}

/// Returns the patches that must be computed: those that show something wanted in any mirror image. `is_wanted` tests a
/// rectangle of the target.
pub(crate) fn wanted(resampler: &Resampler, is_wanted: impl Fn(PixelRect) -> bool + Sync) -> Wanted {
    // Mirror images do not depend on the format of light.
    let mirrors = Mirrors::of::<FloatFormat>(resampler);
    let size = [resampler.target.width(), resampler.target.height()];
    Wanted::new([mirrors.columns, mirrors.rows], |patch| {
        mirrors.images.iter().any(|image| is_wanted(image.shown(patch, size)))
    })
}

impl MirrorImage {
    /// Returns the rectangle in which a target of this size shows a patch.
    fn shown(&self, first: [usize; 2], size: [usize; 2]) -> PixelRect {
        let first = exchanged(first, self.is_turned);
        let along = |axis: usize| {
            let (from, to) = (first[axis], size[axis].min(first[axis] + SIDE));
            if self.flips[axis] { [size[axis] - to, size[axis] - from] } else { [from, to] }
        };
        let ([left, right], [top, bottom]) = (along(0), along(1));
        PixelRect { left, top, right, bottom }
    }
}

impl Mirrors {
    /// Returns the rows of a band.
    fn band(&self, index: usize) -> Range<usize> {
        index * BAND..self.rows.min((index + 1) * BAND)
    }
}
