//! Pixels by plans in single precision: light of any range.

use fearless_simd::{Level, Simd, dispatch, f32x4, prelude::*};

use super::band::{Band, Run};
use super::canvas::Canvas;
use super::float_shape::{Header, Shape};
use super::float_weights::FloatWeights;
use super::float_window::Window;
use super::mirrors::{MOST_IMAGES, Mirrors, Walk, Ways};
use super::prefetch::{prefetch_patch, prefetch_weights};
use super::singles::{Palette, Singles};
use super::texels::{Texels, prefetch};
use crate::raster::Rgba;
use crate::resample::patch::SIDE;

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
        self.fill_singles(&band.singles, canvas);
    }

    /// Makes the pixels that come by themselves.
    pub(super) fn fill_singles(&self, singles: &Singles, canvas: &mut Canvas<Rgba>) {
        let level = self.level;
        dispatch!(level, simd => singles.fill(simd, self.mirrors, (self, self.anti_ringing), canvas));
    }

    // No closures below but those that `vectorize` takes: the compiler gives others no leave to use the level's instructions.
    #[inline(always)]
    fn runs<S: Simd>(&self, simd: S, band: &Band<FloatWeights>, canvas: &mut Canvas<Rgba>) {
        let mut ahead = band.patches().skip(1);
        for (at, run) in band.runs.iter().enumerate() {
            if at % SIDE == 0 {
                prefetch_patch(self.texels, self.mirrors, ahead.next().unwrap_or(&[]));
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
        let numbers = &band.weights.numbers[run.weights as usize..];
        let ways = self.mirrors.ways(usize::from(run.view));
        let run_filter = RunFilter { simd, filter: self, ways, run, numbers };
        let mut pixels = [[Rgba::TRANSPARENT; SIDE]; MOST_IMAGES];
        if (ways.forward, ways.count) == (2, 4) {
            // A function for each way: all in one would take the compiler minutes.
            simd.vectorize(
                #[inline(always)]
                || run_filter.pixels::<2, 0>(0, &mut pixels),
            );
            simd.vectorize(
                #[inline(always)]
                || run_filter.pixels::<2, 2>(2, &mut pixels),
            );
            return pixels;
        }
        for at in 0..ways.forward {
            simd.vectorize(
                #[inline(always)]
                || run_filter.pixels::<1, 0>(at, &mut pixels),
            );
        }
        for at in ways.forward..ways.count {
            simd.vectorize(
                #[inline(always)]
                || run_filter.pixels::<1, 1>(at, &mut pixels),
            );
        }
        pixels
    }
}

impl Palette for FloatFilter<'_> {
    type Pixel = Rgba;

    #[inline(always)]
    fn rgba(&self, texel: u32) -> Rgba {
        self.texels[texel as usize]
    }

    #[inline(always)]
    fn light<S: Simd>(&self, simd: S, texel: u32) -> f32x4<S> {
        f32x4::load_array_ref(simd, &self.texels[texel as usize].0)
    }

    fn pixel(&self, light: Rgba, coverage: f32) -> Rgba {
        (light * coverage).over(self.background)
    }

    #[inline(always)]
    fn prefetch(&self, texel: u32) {
        prefetch(self.texels, texel);
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
    /// Its weights, and more.
    numbers: &'a [u32],
}

impl<S: Simd> RunFilter<'_, S> {
    /// The pixels in N mirrors from this one on; R of them, all or none, walk through windows from right to left.
    #[inline(always)]
    fn pixels<const N: usize, const R: usize>(self, start: usize, pixels: &mut Pixels) {
        let Self { simd, filter, ways, run, mut numbers } = self;
        let (mut order, mut walks, mut size) = ([(0, 0); N], [Walk::default(); N], [0; 2]);
        for image in 0..N {
            order[image] = ways.order[start + image];
            let seen = filter.mirrors.images[order[image].0].view(usize::from(run.view));
            (walks[image], size) = (seen.walk([0; 2]), seen.size());
        }
        let texels = Texels::<f32, N, R>::new(bytemuck::cast_slice(filter.texels), walks, size);
        let large = Shape { width: usize::from(run.width), height: usize::from(run.height) };
        for lane in run.lanes() {
            let window = Window::<S, N, R> { simd, texels: &texels, first: run.first(lane) };
            prefetch_weights(numbers);
            let header = Header(numbers[0]);
            let (sums, length) = match header.index() {
                0 => window.small::<4, 4, 0>(header, numbers),
                1 => window.small::<4, 4, 1>(header, numbers),
                2 => window.small::<4, 5, 1>(header, numbers),
                3 => window.small::<5, 4, 0>(header, numbers),
                4 => window.small::<5, 4, 1>(header, numbers),
                5 => window.small::<5, 5, 1>(header, numbers),
                _ => window.large(large, run.rows_under(), numbers),
            };
            numbers = &numbers[length..];
            for (image, (index, flip)) in order.iter().enumerate() {
                let average = sums.average(image, filter.anti_ringing);
                pixels[index % MOST_IMAGES][(lane ^ flip) % SIDE] = Rgba(average.to_array());
            }
        }
    }
}
