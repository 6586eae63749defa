//! Plans in integers: for opaque pictures of 8 bits.
//!
//! Light has 15 bits and weights 16; their products are added in 32, so that the result is the same on every machine. Two texels
//! beside each other are worked on together, red, green, blue and nothing of each, in a block of 128 bits for each mirror: the
//! product of pairs is then a weighted sum of two texels, and weights are spread once for all mirrors.

pub(crate) mod blocks;
pub(crate) mod encode_u8;
pub(crate) mod patch_texels;
pub(crate) mod quantize;
pub(crate) mod texels;
pub(crate) mod turned;
pub(crate) mod view_texels;
pub(crate) mod weights;
pub(crate) mod window;

use fearless_simd::{Level, Simd, dispatch, f32x4, i16x8, i16x16, i16x32, i32x4, prelude::*};

use super::fixed::blocks::Blocks;
#[cfg(target_arch = "x86_64")]
use super::fixed::encode_u8::{Compute, LookUp};
use super::fixed::patch_texels::PatchTexels;
use super::fixed::texels::{Texels, prefetch};
use super::fixed::view_texels::ViewTexels;
use super::fixed::weights::{FixedWeights, Header, Shape};
use super::fixed::window::Window;
use super::pack::GroupLight;
use super::prefetch::{prefetch_pass, prefetch_runs, prefetch_weights};
use super::tile_writer::Canvas;
use crate::raster::{FixedCodec, FixedLight, Rgba};
use crate::render::apply::tap_lists::Palette;
use crate::render::plan::band::Band;
use crate::render::plan::span::Run;
use crate::render::plan::symmetry::{Mirrors, TOGETHER, Ways};
use crate::render::plan::traversal::{Pass, passes};
use crate::render::plan::window_order::{Place, window_count};
use crate::render::scan::tile::SIDE;

/// Makes the pixels of a band.
pub(crate) struct FixedFilter<'a> {
    pub(crate) level: Level,
    pub(crate) mirrors: &'a Mirrors,
    pub(crate) light: &'a FixedLight,
    pub(crate) codec: &'a FixedCodec,
    pub(crate) anti_ringing: bool,
}

impl FixedFilter<'_> {
    pub(crate) fn fill(&self, band: &Band<FixedWeights>, canvas: &mut Canvas<[u8; 3]>) {
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
        let texels = self.light.as_laid_out();
        let views = ViewTexels::all(self.mirrors, self.light.samples());
        let mut light: GroupLight<[i32; 4]> = [[[[0; 4]; TOGETHER]; SIDE]; SIDE];
        let mut patch = PatchTexels::new();
        let mut after = 0;
        for (pass, next) in passes(band.groups(), self.mirrors.images.len()) {
            if let Some(next) = next {
                prefetch_pass(texels, self.mirrors, &next);
            }
            if pass.ways.start == 0 {
                after += pass.group.len();
                prefetch_runs(&band.runs, after + SIDE);
            }
            let run = &pass.group[0];
            let (view, numbers) = (usize::from(run.view), &band.weights.numbers[run.weights as usize..]);
            self.weigh(simd, &pass, (&views[view], &mut patch), numbers, &mut light);
            self.put(simd, &pass, self.mirrors.ways(view), &light, canvas);
        }
    }

    /// Adds up the light of a pass's windows. What is called from here on is compiled by itself: among all that makes a band its loop
    /// would lack registers.
    #[inline(never)]
    fn weigh<S: Simd>(
        &self,
        simd: S,
        Pass { group, ways }: &Pass,
        (texels, patch): (&ViewTexels<i16>, &mut PatchTexels),
        numbers: &[u32],
        light: &mut GroupLight<[i32; 4]>,
    ) {
        let group = GroupFilter { simd, group, numbers, anti_ringing: self.anti_ringing };
        // A function for each number of mirrors: all in one would take the compiler minutes.
        match texels {
            ViewTexels::Turned([_, turned]) if ways.start > 0 => simd.vectorize(
                #[inline(always)]
                || group.weigh::<i16x32<S>, 4, 2, true>((turned, patch), 0, light),
            ),
            ViewTexels::Four(texels) | ViewTexels::Turned([texels, _]) => simd.vectorize(
                #[inline(always)]
                || group.weigh::<i16x32<S>, 4, 2, false>((texels, patch), 0, light),
            ),
            ViewTexels::Eight(texels) => simd.vectorize(
                #[inline(always)]
                || group.weigh::<i16x32<S>, 4, 2, false>((&texels[ways.start / TOGETHER], patch), 0, light),
            ),
            ViewTexels::Two(texels) => simd.vectorize(
                #[inline(always)]
                || group.weigh::<i16x16<S>, 2, 1, false>((texels, patch), 0, light),
            ),
            ViewTexels::OneByOne { forward, reversed } => simd.vectorize(
                #[inline(always)]
                || {
                    for (image, texels) in forward.iter().enumerate() {
                        group.weigh::<i16x8<S>, 1, 0, false>((texels, patch), image, light);
                    }
                    for (image, texels) in (forward.len()..).zip(reversed) {
                        group.weigh::<i16x8<S>, 1, 1, false>((texels, patch), image, light);
                    }
                },
            ),
        }
    }

    /// Puts the pixels of a pass's light; apart from what weighs, for the same reason.
    #[inline(never)]
    fn put<S: Simd>(
        &self,
        simd: S,
        pass: &Pass,
        ways: &Ways,
        light: &GroupLight<[i32; 4]>,
        canvas: &mut Canvas<[u8; 3]>,
    ) {
        let codes = LookUp(self.codec.codes());
        #[cfg(target_arch = "x86_64")]
        if let Some(level) = simd.level().as_avx512()
            && codes.0.are_srgb()
        {
            let compute = Compute { level, codes };
            simd.vectorize(
                #[inline(always)]
                || canvas.put(pass, ways, light, &compute),
            );
            return;
        }
        canvas.put(pass, ways, light, &codes);
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
    /// The light in N mirrors from one of them on; in the last R windows are walked through from right to left, in all of them, if they
    /// are `TURNED`, with columns for rows.
    #[inline(always)]
    fn weigh<V: Blocks<S, N>, const N: usize, const R: usize, const TURNED: bool>(
        self,
        (texels, patch): (&Texels<i16, N, R>, &mut PatchTexels),
        image: usize,
        light: &mut GroupLight<[i32; 4]>,
    ) {
        let Self { simd, group, mut numbers, anti_ringing } = self;
        let mut count = window_count(group);
        patch.clear();
        while count > 0 {
            prefetch_weights(numbers);
            let header = Header(numbers[0]);
            let Place { run, lane } = Place::of(header.0);
            let light = &mut light[run][lane][image..][..N];
            let run = &group[run];
            let first = run.first(lane);
            if header.is_small() {
                patch.hold::<S, V, N, R, TURNED>(simd, texels, group, first);
            }
            let window = Window { simd, patch, first, numbers, is_bounded: anti_ringing };
            let (average, length) = match header.shape() {
                0 => window.small::<V, N, 4, 4, 0>(),
                1 => window.small::<V, N, 4, 4, 1>(),
                2 => window.small::<V, N, 4, 5, 1>(),
                3 => window.small::<V, N, 6, 4, 0>(),
                4 => window.small::<V, N, 6, 4, 1>(),
                5 => window.small::<V, N, 6, 5, 1>(),
                _ => window.large::<V, N, R, TURNED>(texels, Shape::of_run(run), run.rows_under()),
            };
            (numbers, count) = (&numbers[length..], count - 1);
            average.store_slice(light.as_flattened_mut());
        }
    }
}
