//! Pixels by plans in single precision: light of any range.

use fearless_simd::{Level, Simd, dispatch, f32x4, prelude::*};

use super::band::{Band, Run};
use super::canvas::Canvas;
use super::float_shape::{Header, Shape};
use super::float_weights::FloatWeights;
use super::float_window::Window;
use super::groups::{Place, window_count};
use super::mirrors::{Mirrors, TOGETHER};
use super::patch_pixels::PatchPixels;
use super::prefetch::{prefetch_patch, prefetch_runs, prefetch_weights};
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
        let mut ahead = band.groups().skip(1);
        let views = ViewTexels::all(self.mirrors, bytemuck::cast_slice(self.texels));
        let mut after = 0;
        for group in band.groups() {
            let next = ahead.next().unwrap_or(&[]);
            prefetch_patch(self.texels, self.mirrors, next);
            canvas.prefetch(next);
            after += group.len();
            prefetch_runs(&band.runs, after + SIDE);
            self.pixels(simd, group, &views[usize::from(group[0].view)], &band.weights, canvas.pixels());
            canvas.put(group);
        }
    }

    /// Makes the pixels of a group in each mirror.
    #[inline(always)]
    fn pixels<S: Simd>(
        &self,
        simd: S,
        group: &[Run],
        texels: &ViewTexels<f32>,
        weights: &FloatWeights,
        pixels: &mut PatchPixels<Rgba>,
    ) {
        let order = &self.mirrors.ways(usize::from(group[0].view)).order;
        let numbers = &weights.numbers[group[0].weights as usize..];
        let group = GroupFilter { simd, filter: self, group, numbers };
        // A function for each number of mirrors: all in one would take the compiler minutes.
        match texels {
            ViewTexels::Eight([first, second]) => {
                let (order, others) = order.split_at(TOGETHER);
                simd.vectorize(
                    #[inline(always)]
                    || group.pixels::<TOGETHER, 2, false>(first, order, pixels),
                );
                simd.vectorize(
                    #[inline(always)]
                    || group.pixels::<TOGETHER, 2, false>(second, others, pixels),
                );
            }
            ViewTexels::Turned([upright, turned]) => {
                let (order, others) = order.split_at(TOGETHER);
                simd.vectorize(
                    #[inline(always)]
                    || group.pixels::<TOGETHER, 2, false>(upright, order, pixels),
                );
                simd.vectorize(
                    #[inline(always)]
                    || group.pixels::<TOGETHER, 2, true>(turned, others, pixels),
                );
            }
            ViewTexels::Four(texels) => simd.vectorize(
                #[inline(always)]
                || group.pixels::<TOGETHER, 2, false>(texels, order, pixels),
            ),
            ViewTexels::Two(texels) => simd.vectorize(
                #[inline(always)]
                || group.pixels::<2, 1, false>(texels, order, pixels),
            ),
            ViewTexels::OneByOne { forward, reversed } => simd.vectorize(
                #[inline(always)]
                || {
                    for (texels, order) in forward.iter().zip(order) {
                        group.pixels::<1, 0, false>(texels, std::slice::from_ref(order), pixels);
                    }
                    for (texels, order) in reversed.iter().zip(&order[forward.len()..]) {
                        group.pixels::<1, 1, false>(texels, std::slice::from_ref(order), pixels);
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

/// What makes the pixels of a group.
#[derive(Clone, Copy)]
struct GroupFilter<'a, S> {
    simd: S,
    filter: &'a FloatFilter<'a>,
    group: &'a [Run],
    /// Its weights, and more.
    numbers: &'a [u32],
}

impl<S: Simd> GroupFilter<'_, S> {
    /// The pixels in N mirrors, which `order` tells; in the last R of them windows are walked through from right to left, if they are
    /// `TURNED` with columns for rows.
    #[inline(always)]
    fn pixels<const N: usize, const R: usize, const TURNED: bool>(
        self,
        texels: &Texels<f32, N, R>,
        order: &[(usize, usize)],
        pixels: &mut PatchPixels<Rgba>,
    ) {
        let Self { simd, filter, group, mut numbers } = self;
        let mut count = window_count(group);
        while count > 0 {
            prefetch_weights(numbers);
            let header = Header(numbers[0]);
            let Place { run, lane } = Place::of(header.0);
            let run = &group[run];
            let window = Window::<S, N, R, TURNED> { simd, texels, first: run.first(lane) };
            let (sums, length) = match header.index() {
                0 => window.small::<4, 4, 0>(header, numbers),
                1 => window.small::<4, 4, 1>(header, numbers),
                2 => window.small::<4, 5, 1>(header, numbers),
                3 => window.small::<5, 4, 0>(header, numbers),
                4 => window.small::<5, 4, 1>(header, numbers),
                5 => window.small::<5, 5, 1>(header, numbers),
                _ => window.large(Shape::of_run(run), run.rows_under(), numbers),
            };
            (numbers, count) = (&numbers[length..], count - 1);
            for (image, (index, flip)) in order.iter().enumerate().take(N) {
                let light = Rgba(sums.average(image, filter.anti_ringing).to_array());
                *pixels.pixel(*index, [lane, run.row_in_patch()], *flip) =
                    if filter.background == Rgba::TRANSPARENT { light } else { light.over(filter.background) };
            }
        }
    }
}
