//! Pixels by plans in single precision: light of any range.

use fearless_simd::{Level, Simd, dispatch, f32x4, f32x8, i32x8, prelude::*};

use super::band::{Band, Run};
use super::canvas::Canvas;
use super::float_weights::FloatWeights;
use super::mirrors::{MOST_IMAGES, Mirrors, Walk, Ways};
use super::prefetch::prefetch;
use crate::raster::Rgba;
use crate::resample::patch::SIDE;
use crate::resample::taps::average;

/// Makes the pixels of a band.
pub(super) struct FloatFilter<'a> {
    pub(super) level: Level,
    pub(super) mirrors: &'a Mirrors,
    pub(super) texels: &'a [Rgba],
    pub(super) anti_ringing: bool,
    /// What pixels are laid in front of.
    pub(super) background: Rgba,
}

impl FloatFilter<'_> {
    pub(super) fn fill(&self, band: &Band<FloatWeights>, canvas: &mut Canvas<Rgba>) {
        let level = self.level;
        dispatch!(level, simd => self.runs(simd, band, canvas));
        for single in &band.singles {
            let colour = average(band.taps(single), |texel| self.texels[texel as usize], self.anti_ringing);
            let image = &self.mirrors.images[usize::from(single.image)];
            *canvas.pixel(image, [single.column as usize, usize::from(single.row)]) =
                (colour * single.coverage).over(self.background);
        }
    }

    // No closures below but those that `vectorize` takes: the compiler gives others no leave to use the level's instructions.
    #[inline(always)]
    fn runs<S: Simd>(&self, simd: S, band: &Band<FloatWeights>, canvas: &mut Canvas<Rgba>) {
        let mut ahead = band.patches().skip(1);
        for (at, run) in band.runs.iter().enumerate() {
            if at % SIDE == 0 {
                prefetch(self.texels, self.mirrors, ahead.next().unwrap_or(&[]));
            }
            let mut pixels = self.pixels(simd, band, run);
            for (image, pixels) in self.mirrors.images.iter().zip(&mut pixels) {
                if self.background != Rgba::TRANSPARENT {
                    for pixel in pixels.iter_mut() {
                        *pixel = pixel.over(self.background);
                    }
                }
                canvas.put(image, run, pixels);
            }
        }
    }

    /// The pixels of a run in each mirror.
    #[inline(always)]
    fn pixels<S: Simd>(&self, simd: S, band: &Band<FloatWeights>, run: &Run) -> Pixels {
        let (width, height) = (usize::from(run.width), usize::from(run.height));
        let weights = &band.weights.0[run.weights as usize..][..width * height];
        let ways = self.mirrors.ways(usize::from(run.view));
        let run_filter = RunFilter { simd, filter: self, ways, run, weights };
        let mut pixels = [[Rgba::TRANSPARENT; SIDE]; MOST_IMAGES];
        let is_made = match (ways.forward, ways.count) {
            (2, 4) => run_filter.twins_of::<2>(width, &mut pixels),
            (1, 2) => run_filter.twins_of::<1>(width, &mut pixels),
            _ => false,
        };
        if !is_made {
            simd.vectorize(
                #[inline(always)]
                || run_filter.images(&mut pixels),
            );
        }
        pixels
    }
}

/// The pixels of a run in each mirror, from left to right as that shows them.
type Pixels = [[Rgba; SIDE]; MOST_IMAGES];

/// What makes the pixels of a run.
#[derive(Clone, Copy)]
struct RunFilter<'a, S> {
    simd: S,
    filter: &'a FloatFilter<'a>,
    ways: &'a Ways,
    run: &'a Run,
    /// Those of its windows, row by row.
    weights: &'a [[f32; SIDE]],
}

impl<S: Simd> RunFilter<'_, S> {
    /// How a window at the run's corner is walked through in a mirror, by its place in the order of the ways.
    #[inline(always)]
    fn corner(&self, at: usize) -> Walk {
        let view = usize::from(self.run.view);
        self.filter.mirrors.images[self.ways.order[at].0].view(view).walk(self.run.corner())
    }

    /// Whether a row of the windows holds texels that a pixel is held to.
    #[inline(always)]
    fn is_under(&self, row: usize) -> bool {
        self.filter.anti_ringing && self.run.rows_under().contains(&row)
    }

    /// Where a pixel belongs.
    #[inline(always)]
    fn put(&self, pixels: &mut Pixels, at: usize, lane: usize, pixel: Rgba) {
        let (index, flip) = self.ways.order[at];
        pixels[index % MOST_IMAGES][(lane ^ flip) % SIDE] = pixel;
    }

    /// The pixels in P pairs of mirrors, of windows of the usual widths: a function for each, in which rows are written out. False,
    /// making none, for others.
    #[inline(always)]
    fn twins_of<const P: usize>(self, width: usize, pixels: &mut Pixels) -> bool {
        match width {
            4 => self.simd.vectorize(
                #[inline(always)]
                || self.twins::<P, 4>(pixels),
            ),
            5 => self.simd.vectorize(
                #[inline(always)]
                || self.twins::<P, 5>(pixels),
            ),
            6 => self.simd.vectorize(
                #[inline(always)]
                || self.twins::<P, 6>(pixels),
            ),
            7 => self.simd.vectorize(
                #[inline(always)]
                || self.twins::<P, 7>(pixels),
            ),
            _ => return false,
        }
        true
    }

    /// The pixels in P pairs of mirrors, whose windows are W texels wide; of each pair one goes from left to right, the other from
    /// right to left.
    #[inline(always)]
    fn twins<const P: usize, const W: usize>(self, pixels: &mut Pixels) {
        let mut corners = [[Walk::default(); 2]; P];
        for (pair, corners) in corners.iter_mut().enumerate() {
            *corners = [self.corner(pair), self.corner(P + pair)];
        }
        for lane in self.run.lanes() {
            let averages = self.averages::<P, W>(&corners, lane);
            for (pair, average) in averages.iter().enumerate() {
                let (forward, backward) = average.split();
                self.put(pixels, pair, lane, Rgba(forward.to_array()));
                self.put(pixels, P + pair, lane, Rgba(backward.to_array()));
            }
        }
    }

    #[inline(always)]
    fn averages<const P: usize, const W: usize>(&self, corners: &[[Walk; 2]; P], lane: usize) -> [f32x8<S>; P] {
        let (simd, texels) = (self.simd, self.filter.texels);
        let mut sums = [Sums::zero(simd); P];
        let mut walks = [[Walk::default(); 2]; P];
        for (walks, corners) in walks.iter_mut().zip(corners) {
            *walks = [self.run.walk(corners[0], lane), self.run.walk(corners[1], lane)];
        }
        for (row, weights) in self.weights.as_chunks::<W>().0.iter().enumerate() {
            let is_under = self.is_under(row);
            for (sums, walks) in sums.iter_mut().zip(&mut walks) {
                let row = TwinRows { texels: [row_at(texels, walks[0]), row_at(texels, walks[1])], weights, lane };
                if is_under {
                    row.add::<S, true>(simd, sums);
                } else {
                    row.add::<S, false>(simd, sums);
                }
                *walks = [walks[0].one_down(), walks[1].one_down()];
            }
        }
        let mut averages = [f32x8::splat(simd, 0.0); P];
        for (average, sums) in averages.iter_mut().zip(&sums) {
            *average = sums.average(self.filter.anti_ringing);
        }
        averages
    }

    /// The pixels in all mirrors, one by one, of windows of any width.
    #[inline(always)]
    fn images(self, pixels: &mut Pixels) {
        for at in 0..self.ways.forward {
            self.image::<false>(at, pixels);
        }
        for at in self.ways.forward..self.ways.count {
            self.image::<true>(at, pixels);
        }
    }

    /// The same in one of them.
    #[inline(always)]
    fn image<const REVERSED: bool>(self, at: usize, pixels: &mut Pixels) {
        let corner = self.corner(at);
        for lane in self.run.lanes() {
            let pixel = self.average::<REVERSED>(self.run.walk(corner, lane), lane);
            self.put(pixels, at, lane, pixel);
        }
    }

    #[inline(always)]
    fn average<const REVERSED: bool>(&self, walk: Walk, lane: usize) -> Rgba {
        let (simd, width) = (self.simd, usize::from(self.run.width));
        let mut sum = f32x4::splat(simd, 0.0);
        let mut least = f32x4::splat(simd, f32::INFINITY);
        let mut greatest = f32x4::splat(simd, f32::NEG_INFINITY);
        let first = walk.first as usize;
        let mut first = if REVERSED { first + 1 - width } else { first };
        for (row, weights) in self.weights.chunks_exact(width).enumerate() {
            let texels = &self.filter.texels[first..][..width];
            let is_under = self.is_under(row);
            let mut part = f32x4::splat(simd, 0.0);
            for column in 0..width {
                let texel = texels[if REVERSED { width - 1 - column } else { column }];
                let (texel, weight) = (f32x4::load_array(simd, texel.0), f32x8::splat(simd, weights[column][lane]));
                part += texel * weight.split().0;
                if is_under {
                    let beyond = beyond(weight).split().0;
                    least = least.min(texel + beyond);
                    greatest = greatest.max(texel - beyond);
                }
            }
            sum += part;
            first = first.wrapping_add_signed(walk.down as isize);
        }
        if self.filter.anti_ringing {
            sum = sum.max(least).min(greatest);
        }
        Rgba(sum.to_array())
    }
}

/// The texels of a row of a window, from left to right as they lie.
#[inline(always)]
fn row_at<const W: usize>(texels: &[Rgba], walk: Walk) -> &[Rgba; W] {
    let first = walk.first as usize;
    let first = if walk.is_reversed { first + 1 - W } else { first };
    texels[first..].first_chunk().expect("a window lies among its texels")
}

/// A row of two windows that mirror each other, and its weights.
struct TwinRows<'a, const W: usize> {
    texels: [&'a [Rgba; W]; 2],
    weights: &'a [[f32; SIDE]; W],
    lane: usize,
}

impl<const W: usize> TwinRows<'_, W> {
    /// Adds it; `UNDER` if it holds texels that lie under the pixel.
    #[inline(always)]
    fn add<S: Simd, const UNDER: bool>(&self, simd: S, sums: &mut Sums<S>) {
        let mut part = f32x8::splat(simd, 0.0);
        for column in 0..W {
            let (forward, backward) = (self.texels[0][column].0, self.texels[1][W - 1 - column].0);
            let texel = f32x4::load_array(simd, forward).combine(f32x4::load_array(simd, backward));
            let weight = f32x8::splat(simd, self.weights[column][self.lane % SIDE]);
            part += texel * weight;
            if UNDER {
                let beyond = beyond(weight);
                sums.least = sums.least.min(texel + beyond);
                sums.greatest = sums.greatest.max(texel - beyond);
            }
        }
        sums.sum += part;
    }
}

/// Zero where a weight is marked as that of a texel under the pixel, infinity for one around it.
#[inline(always)]
fn beyond<S: Simd>(weight: f32x8<S>) -> f32x8<S> {
    let bits: i32x8<S> = weight.bitcast();
    (((bits & 1) - 1) & f32::INFINITY.to_bits() as i32).bitcast()
}

/// Sums over two windows that mirror each other, and the bounds of what lies under the pixels.
#[derive(Clone, Copy)]
struct Sums<S: Simd> {
    sum: f32x8<S>,
    least: f32x8<S>,
    greatest: f32x8<S>,
}

impl<S: Simd> Sums<S> {
    #[inline(always)]
    fn zero(simd: S) -> Self {
        Self {
            sum: f32x8::splat(simd, 0.0),
            least: f32x8::splat(simd, f32::INFINITY),
            greatest: f32x8::splat(simd, f32::NEG_INFINITY),
        }
    }

    #[inline(always)]
    fn average(&self, anti_ringing: bool) -> f32x8<S> {
        if anti_ringing { self.sum.max(self.least).min(self.greatest) } else { self.sum }
    }
}
