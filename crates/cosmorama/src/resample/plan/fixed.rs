//! Plans in integers: for opaque pictures of 8 bits.
//!
//! Light has 15 bits and weights 16; their products are added in 32, so that the result is the same on every machine. Two texels
//! beside each other are worked on together, red, green, blue and nothing of each, in a block of 128 bits for each mirror: the
//! product of pairs is then a weighted sum of two texels, and weights are spread once for all mirrors.

use fearless_simd::{Level, Simd, dispatch, f32x4, i16x8, i16x16, i16x32, i32x4, prelude::*};

use super::band::{Band, Run};
use super::blocks::{self, Blocks};
use super::canvas::Canvas;
use super::fixed_weights::{FixedWeights, Header, Shape};
use super::fixed_window::Window;
use super::mirrors::{MOST_IMAGES, Mirrors};
use super::prefetch::{prefetch_patch, prefetch_runs, prefetch_weights};
use super::run_pixels::{Places, RunPixels};
use super::singles::Palette;
use super::texels::{Texels, prefetch};
use super::view_texels::ViewTexels;
use crate::raster::{FixedCodec, FixedLight, Rgba};
use crate::resample::patch::SIDE;

/// Makes the pixels of a band.
pub(super) struct FixedFilter<'a> {
    pub(super) level: Level,
    pub(super) mirrors: &'a Mirrors,
    pub(super) light: &'a FixedLight,
    pub(super) codec: &'a FixedCodec,
    pub(super) anti_ringing: bool,
}

impl FixedFilter<'_> {
    pub(super) fn fill(&self, band: &Band<FixedWeights>, canvas: &mut Canvas<[u8; 3]>) {
        let level = self.level;
        dispatch!(level, simd => {
            self.runs(simd, band, canvas);
            band.singles.fill(simd, self.mirrors, (self, self.anti_ringing), canvas);
        });
    }

    // No closures below but those that `vectorize` takes: the compiler gives others no leave to use the level's instructions.
    #[inline(always)]
    fn runs<S: Simd>(&self, simd: S, band: &Band<FixedWeights>, canvas: &mut Canvas<[u8; 3]>) {
        if band.runs.is_empty() {
            return;
        }
        let mut ahead = band.patches().skip(1);
        let texels = self.light.as_laid_out();
        let views = ViewTexels::all(self.mirrors, self.light.samples());
        for (at, run) in band.runs.iter().enumerate() {
            if at % SIDE == 0 {
                let next = ahead.next().unwrap_or(&[]);
                prefetch_patch(texels, self.mirrors, next);
                // Of a frame by plan this gains nothing, of a single picture a fiftieth.
                canvas.prefetch(next);
                prefetch_runs(&band.runs, at);
            }
            let numbers = &band.weights.numbers[run.weights as usize..];
            self.pixels(simd, run, &views[usize::from(run.view)], numbers, canvas.pixels(run));
            canvas.put(run);
        }
    }

    /// Makes the pixels of a run in each mirror. What is called from here on is compiled by itself: among all that makes a band its loop
    /// would lack registers.
    #[inline(never)]
    fn pixels<S: Simd>(&self, simd: S, run: &Run, texels: &ViewTexels<i16>, numbers: &[u32], pixels: &mut Pixels) {
        let order = &self.mirrors.ways(usize::from(run.view)).order;
        let run_filter = RunFilter { simd, filter: self, run, numbers };
        // A function for each number of mirrors: all in one would take the compiler minutes.
        match texels {
            ViewTexels::Eight(texels) => simd.vectorize(
                #[inline(always)]
                || run_filter.pixels::<i16x32<S>, 4, 2, 2, false>(texels, order, pixels),
            ),
            ViewTexels::Turned(texels) => simd.vectorize(
                #[inline(always)]
                || run_filter.pixels::<i16x32<S>, 4, 2, 2, true>(texels, order, pixels),
            ),
            ViewTexels::Four(texels) => simd.vectorize(
                #[inline(always)]
                || run_filter.pixels::<i16x32<S>, 4, 2, 1, false>(std::array::from_ref(texels), order, pixels),
            ),
            ViewTexels::Two(texels) => simd.vectorize(
                #[inline(always)]
                || run_filter.pixels::<i16x16<S>, 2, 1, 1, false>(std::array::from_ref(texels), order, pixels),
            ),
            ViewTexels::OneByOne { forward, reversed } => simd.vectorize(
                #[inline(always)]
                || {
                    for (texels, order) in forward.iter().zip(order) {
                        let (texels, order) = (std::array::from_ref(texels), std::slice::from_ref(order));
                        run_filter.pixels::<i16x8<S>, 1, 0, 1, false>(texels, order, pixels);
                    }
                    for (texels, order) in reversed.iter().zip(&order[forward.len()..]) {
                        let (texels, order) = (std::array::from_ref(texels), std::slice::from_ref(order));
                        run_filter.pixels::<i16x8<S>, 1, 1, 1, false>(texels, order, pixels);
                    }
                },
            ),
        }
    }
}

impl Palette for FixedFilter<'_> {
    type Pixel = [u8; 3];

    #[inline(always)]
    fn light<S: Simd>(&self, simd: S, texel: u32) -> f32x4<S> {
        let [red, green, blue, _] = self.light.as_laid_out()[texel as usize];
        let samples = i32x4::load_array(simd, [red, green, blue, 0].map(i32::from));
        let light = f32x4::float_from(samples) / FixedLight::WHITE;
        light + f32x4::load_array(simd, [0.0, 0.0, 0.0, 1.0])
    }

    fn pixel(&self, light: Rgba, coverage: f32) -> [u8; 3] {
        self.codec.codes_of((light * coverage).over(self.codec.background_light()))
    }

    #[inline(always)]
    fn prefetch(&self, texel: u32) {
        prefetch(self.light.as_laid_out(), texel);
    }
}

/// The pixels of a run in each mirror.
type Pixels = RunPixels<[u8; 3]>;

/// What makes the pixels of a run.
#[derive(Clone, Copy)]
struct RunFilter<'a, S> {
    simd: S,
    filter: &'a FixedFilter<'a>,
    run: &'a Run,
    /// Its weights, and more.
    numbers: &'a [u32],
}

impl<S: Simd> RunFilter<'_, S> {
    /// The pixels in G times N mirrors, which `order` tells; in the last R of each N windows are walked through from right to left, in
    /// the last N, if these are `TURNED`, with columns for rows.
    #[inline(always)]
    fn pixels<V: Blocks<S, N>, const N: usize, const R: usize, const G: usize, const TURNED: bool>(
        self,
        texels: &[Texels<i16, N, R>; G],
        order: &[(usize, usize)],
        pixels: &mut Pixels,
    ) {
        let Self { simd, filter, run, mut numbers } = self;
        let large = Shape { pairs: usize::from(run.width).div_ceil(2), height: usize::from(run.height), under: 0 };
        let codes = filter.codec.tables();
        // Of each lane, in each mirror.
        let mut light = [[[0; 4]; MOST_IMAGES]; SIDE];
        let pairs = V::Bytes::from_slice(simd, blocks::order::<N, R>());
        for lane in run.lanes() {
            let window = Window::<S, V, N, R, G, TURNED> { simd, order: pairs, texels, first: run.first(lane) };
            prefetch_weights(numbers);
            let header = Header(numbers[0]);
            let (sums, length) = match header.shape() {
                0 => window.small::<4, 4, 0>(header, numbers),
                1 => window.small::<4, 4, 1>(header, numbers),
                2 => window.small::<4, 5, 1>(header, numbers),
                3 => window.small::<6, 4, 0>(header, numbers),
                4 => window.small::<6, 4, 1>(header, numbers),
                5 => window.small::<6, 5, 1>(header, numbers),
                _ => window.large(large, run.rows_under(), numbers),
            };
            numbers = &numbers[length..];
            for (sums, light) in sums.into_iter().zip(light[lane].as_chunks_mut::<N>().0) {
                let average = sums.average(simd, header.bits(), filter.anti_ringing);
                average.store_slice(light.as_flattened_mut());
            }
        }
        // Looked up together, from memory: taken out of vectors one by one, samples would wait for each pixel's sum.
        for (image, (index, flip)) in order.iter().enumerate().take(G * N) {
            match pixels.places(*index, *flip) {
                Places::Forward(pixels) => {
                    for (light, pixel) in light.iter().zip(pixels) {
                        *pixel = codes.of(light[image]);
                    }
                }
                Places::Reversed(pixels) => {
                    for (light, pixel) in light.iter().zip(pixels.iter_mut().rev()) {
                        *pixel = codes.of(light[image]);
                    }
                }
                Places::Lines(lines, at) => {
                    for (light, pixels) in light.iter().zip(lines) {
                        pixels[at] = codes.of(light[image]);
                    }
                }
            }
        }
    }
}
