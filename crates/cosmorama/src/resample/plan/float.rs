//! Pixels by plans in single precision: light of any range.

use fearless_simd::{Level, Simd, dispatch, f32x4, prelude::*};

use super::band::{Band, Run};
use super::canvas::Canvas;
use super::float_shape::{Header, Shape};
use super::float_weights::FloatWeights;
use super::float_window::Window;
use super::mirrors::{Mirrors, TOGETHER};
use super::prefetch::{prefetch_patch, prefetch_runs, prefetch_weights};
use super::run_pixels::RunPixels;
use super::singles::{Palette, Singles};
use super::texels::{Texels, prefetch};
use super::view_texels::ViewTexels;
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
        if band.runs.is_empty() {
            return;
        }
        let mut ahead = band.patches().skip(1);
        let views = ViewTexels::all(self.mirrors, bytemuck::cast_slice(self.texels));
        for (at, run) in band.runs.iter().enumerate() {
            if at % SIDE == 0 {
                let next = ahead.next().unwrap_or(&[]);
                prefetch_patch(self.texels, self.mirrors, next);
                canvas.prefetch(next);
                prefetch_runs(&band.runs, at);
            }
            let numbers = &band.weights.numbers[run.weights as usize..];
            self.pixels(simd, run, &views[usize::from(run.view)], numbers, canvas.pixels(run));
            canvas.put(run);
        }
    }

    /// Makes the pixels of a run in each mirror.
    #[inline(always)]
    fn pixels<S: Simd>(
        &self,
        simd: S,
        run: &Run,
        texels: &ViewTexels<f32>,
        numbers: &[u32],
        pixels: &mut RunPixels<Rgba>,
    ) {
        let order = &self.mirrors.ways(usize::from(run.view)).order;
        let run_filter = RunFilter { simd, filter: self, run, numbers };
        // A function for each number of mirrors: all in one would take the compiler minutes.
        match texels {
            ViewTexels::Eight([first, second]) => {
                let (order, others) = order.split_at(TOGETHER);
                simd.vectorize(
                    #[inline(always)]
                    || run_filter.pixels::<TOGETHER, 2, false>(first, order, pixels),
                );
                simd.vectorize(
                    #[inline(always)]
                    || run_filter.pixels::<TOGETHER, 2, false>(second, others, pixels),
                );
            }
            ViewTexels::Turned([upright, turned]) => {
                let (order, others) = order.split_at(TOGETHER);
                simd.vectorize(
                    #[inline(always)]
                    || run_filter.pixels::<TOGETHER, 2, false>(upright, order, pixels),
                );
                simd.vectorize(
                    #[inline(always)]
                    || run_filter.pixels::<TOGETHER, 2, true>(turned, others, pixels),
                );
            }
            ViewTexels::Four(texels) => simd.vectorize(
                #[inline(always)]
                || run_filter.pixels::<TOGETHER, 2, false>(texels, order, pixels),
            ),
            ViewTexels::Two(texels) => simd.vectorize(
                #[inline(always)]
                || run_filter.pixels::<2, 1, false>(texels, order, pixels),
            ),
            ViewTexels::OneByOne { forward, reversed } => simd.vectorize(
                #[inline(always)]
                || {
                    for (texels, order) in forward.iter().zip(order) {
                        run_filter.pixels::<1, 0, false>(texels, std::slice::from_ref(order), pixels);
                    }
                    for (texels, order) in reversed.iter().zip(&order[forward.len()..]) {
                        run_filter.pixels::<1, 1, false>(texels, std::slice::from_ref(order), pixels);
                    }
                },
            ),
        }
    }
}

impl Palette for FloatFilter<'_> {
    type Pixel = Rgba;

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

/// What makes the pixels of a run.
#[derive(Clone, Copy)]
struct RunFilter<'a, S> {
    simd: S,
    filter: &'a FloatFilter<'a>,
    run: &'a Run,
    /// Its weights, and more.
    numbers: &'a [u32],
}

impl<S: Simd> RunFilter<'_, S> {
    /// The pixels in N mirrors, which `order` tells; in the last R of them windows are walked through from right to left, if they are
    /// `TURNED` with columns for rows.
    #[inline(always)]
    fn pixels<const N: usize, const R: usize, const TURNED: bool>(
        self,
        texels: &Texels<f32, N, R>,
        order: &[(usize, usize)],
        pixels: &mut RunPixels<Rgba>,
    ) {
        let Self { simd, filter, run, mut numbers } = self;
        let large = Shape { width: usize::from(run.width), height: usize::from(run.height) };
        for lane in run.lanes() {
            let window = Window::<S, N, R, TURNED> { simd, texels, first: run.first(lane) };
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
            for (image, (index, flip)) in order.iter().enumerate().take(N) {
                let light = Rgba(sums.average(image, filter.anti_ringing).to_array());
                *pixels.pixel(*index, lane, *flip) =
                    if filter.background == Rgba::TRANSPARENT { light } else { light.over(filter.background) };
            }
        }
    }
}
