//! Pixels by plans in single precision: light of any range.

pub(crate) mod lanes;
pub(crate) mod large;
pub(crate) mod shape;
pub(crate) mod turned;
pub(crate) mod weights;
pub(crate) mod window;

use fearless_simd::{Level, Simd, dispatch, f32x4, prelude::*};

use super::fixed::texels::{Texels, prefetch};
use super::fixed::view_texels::ViewTexels;
use super::float::shape::{Header, Shape};
use super::float::weights::FloatWeights;
use super::float::window::Window;
use super::pack::{Develop, GroupLight};
use super::prefetch::{prefetch_pass, prefetch_runs, prefetch_weights};
use super::tile_writer::Canvas;
use crate::raster::Rgba;
use crate::render::apply::tap_lists::Palette;
use crate::render::plan::band::Band;
use crate::render::plan::span::Run;
use crate::render::plan::symmetry::{Mirrors, TOGETHER};
use crate::render::plan::tap_lists::Singles;
use crate::render::plan::traversal::{Pass, passes};
use crate::render::plan::window_order::{Place, window_count};
use crate::render::scan::tile::SIDE;

/// Makes the pixels of a band.
pub(crate) struct FloatFilter<'a> {
    pub(crate) level: Level,
    pub(crate) mirrors: &'a Mirrors,
    pub(crate) texels: &'a [Rgba],
    pub(crate) anti_ringing: bool,
    /// What pixels are laid in front of.
    pub(crate) background: Rgba,
}

impl FloatFilter<'_> {
    pub(crate) fn fill(&self, band: &Band<FloatWeights>, canvas: &mut Canvas<Rgba>) {
        let level = self.level;
        dispatch!(level, simd => self.runs(simd, band, canvas));
        self.fill_singles(&band.singles, canvas);
    }

    /// Makes the pixels that come by themselves.
    pub(crate) fn fill_singles(&self, singles: &Singles, canvas: &mut Canvas<Rgba>) {
        let level = self.level;
        dispatch!(level, simd => singles.fill(simd, self.mirrors, (self, self.anti_ringing), canvas));
    }

    // No closures below but those that `vectorize` takes: the compiler gives others no leave to use the level's instructions.
    #[inline(always)]
    fn runs<S: Simd>(&self, simd: S, band: &Band<FloatWeights>, canvas: &mut Canvas<Rgba>) {
        if band.runs.is_empty() {
            return;
        }
        let views = ViewTexels::all(self.mirrors, bytemuck::cast_slice(self.texels));
        let mut light: GroupLight<Rgba> = [[[Rgba::TRANSPARENT; TOGETHER]; SIDE]; SIDE];
        let mut after = 0;
        for (pass, next) in passes(band.groups(), self.mirrors.images.len()) {
            if let Some(next) = next {
                prefetch_pass(self.texels, self.mirrors, &next);
            }
            if pass.ways.start == 0 {
                after += pass.group.len();
                prefetch_runs(&band.runs, after + SIDE);
            }
            let view = usize::from(pass.group[0].view);
            self.weigh(simd, &pass, &views[view], &band.weights, &mut light);
            canvas.put(&pass, self.mirrors.ways(view), &light, self);
        }
    }

    /// Adds up the light of a pass's windows.
    #[inline(always)]
    fn weigh<S: Simd>(
        &self,
        simd: S,
        Pass { group, ways }: &Pass,
        texels: &ViewTexels<f32>,
        weights: &FloatWeights,
        light: &mut GroupLight<Rgba>,
    ) {
        let numbers = &weights.numbers[group[0].weights as usize..];
        let group = GroupFilter { simd, group, numbers, anti_ringing: self.anti_ringing };
        // A function for each number of mirrors: all in one would take the compiler minutes.
        match texels {
            ViewTexels::Turned([_, turned]) if ways.start > 0 => simd.vectorize(
                #[inline(always)]
                || group.weigh::<TOGETHER, 2, true>(turned, 0, light),
            ),
            ViewTexels::Four(texels) | ViewTexels::Turned([texels, _]) => simd.vectorize(
                #[inline(always)]
                || group.weigh::<TOGETHER, 2, false>(texels, 0, light),
            ),
            ViewTexels::Eight(texels) => simd.vectorize(
                #[inline(always)]
                || group.weigh::<TOGETHER, 2, false>(&texels[ways.start / TOGETHER], 0, light),
            ),
            ViewTexels::Two(texels) => simd.vectorize(
                #[inline(always)]
                || group.weigh::<2, 1, false>(texels, 0, light),
            ),
            ViewTexels::OneByOne { forward, reversed } => simd.vectorize(
                #[inline(always)]
                || {
                    for (image, texels) in forward.iter().enumerate() {
                        group.weigh::<1, 0, false>(texels, image, light);
                    }
                    for (image, texels) in (forward.len()..).zip(reversed) {
                        group.weigh::<1, 1, false>(texels, image, light);
                    }
                },
            ),
        }
    }
}

impl Develop for FloatFilter<'_> {
    type Light = Rgba;
    type Pixel = Rgba;

    #[inline(always)]
    fn one(&self, light: Rgba) -> Rgba {
        if self.background == Rgba::TRANSPARENT { light } else { light.over(self.background) }
    }

    #[inline(always)]
    fn eight(&self, light: [&Rgba; SIDE]) -> [Rgba; SIDE] {
        let mut pixels = [Rgba::TRANSPARENT; SIDE];
        for (pixel, light) in pixels.iter_mut().zip(light) {
            *pixel = self.one(*light);
        }
        pixels
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

/// What makes the light of a group's windows.
#[derive(Clone, Copy)]
struct GroupFilter<'a, S> {
    simd: S,
    group: &'a [Run],
    /// Its weights, and more.
    numbers: &'a [u32],
    anti_ringing: bool,
}

impl<S: Simd> GroupFilter<'_, S> {
    /// The light in N mirrors from one of them on; in the last R of them windows are walked through from right to left, if they are
    /// `TURNED` with columns for rows.
    #[inline(always)]
    fn weigh<const N: usize, const R: usize, const TURNED: bool>(
        self,
        texels: &Texels<f32, N, R>,
        image: usize,
        light: &mut GroupLight<Rgba>,
    ) {
        let Self { simd, group, mut numbers, anti_ringing } = self;
        let mut count = window_count(group);
        while count > 0 {
            prefetch_weights(numbers);
            let header = Header(numbers[0]);
            let Place { run, lane } = Place::of(header.0);
            let light = &mut light[run][lane][image..];
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
            for (light, sum) in light.iter_mut().zip(sums) {
                *light = Rgba(sum.average(anti_ringing).to_array());
            }
        }
    }
}
