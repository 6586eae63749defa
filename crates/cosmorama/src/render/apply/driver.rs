//! Computation of a band's pixels, in floats or integers: group by group, in several mirror images at once, window by
//! window.

use std::ops::Range;

use bytemuck::Zeroable;
use fearless_simd::{Level, Simd, dispatch};

use super::fixed::blocks::Mirrored;
use super::prefetch::{prefetch_pass, prefetch_runs, prefetch_weights};
use super::tap_lists::Palette;
use super::texels::Texels;
use super::tile_writer::{Canvas, GroupLight};
use super::view_texels::ViewTexels;
use crate::render::batch::window::Windows;
use crate::render::plan::band::Band;
use crate::render::plan::recorder::Maker;
use crate::render::plan::span::Run;
use crate::render::plan::symmetry::{Mirrors, TOGETHER, Ways};
use crate::render::plan::traversal::{Pass, passes};
use crate::render::plan::window_format::{Format, Header, Place};
use crate::render::plan::window_order::window_count;
use crate::render::scan::tile::SIDE;

/// Sums of windows of texels in one type of number, whatever pixels are made of them.
pub(crate) trait WindowSums {
    type Sample: Copy;
    /// Light of a window.
    type Light: Copy + Default;
    /// Working memory that the windows of a group share.
    type Shared: Default;

    /// Clears what the windows of the last group shared.
    fn begin(shared: &mut Self::Shared);

    /// Sums a window by its weights in N mirror images. In the last R of them, texels run from right to left. If
    /// `TURNED`, the window's rows are columns in all of them. Returns how many numbers, header and weights, the window
    /// takes.
    fn weigh<S: Mirrored<N>, const N: usize, const R: usize, const TURNED: bool>(
        window: Window<S, Self::Sample, N, R>,
        shared: &mut Self::Shared,
        light: &mut [Self::Light],
    ) -> usize;
}

/// Arithmetic in one type of number, which makes pixels of the sums of windows.
pub(crate) trait WindowArithmetic: Palette<Pixel: Zeroable + Send + Sync> + Sync {
    /// Format of windows' weights.
    type Format: Format;
    /// Sums of windows.
    type Sums: WindowSums<Sample = Self::Sample>;
    /// Working memory of windows that are applied as soon as they are weighed.
    type Fresh: Default;

    /// Returns the pixel that is shown where the target sees nothing.
    fn background(&self) -> Self::Pixel;

    /// Converts the light of a pass to pixels, and writes them.
    fn put<S: Simd>(
        &self,
        simd: S,
        pass: &Pass,
        ways: &Ways,
        light: &GroupLight<LightOf<Self>>,
        canvas: &mut Canvas<Self::Pixel>,
    );

    /// Makes the pixels of windows that have just been weighed; false if they are to be recorded.
    fn put_at_once<S: Simd>(
        &self,
        simd: S,
        memory: &mut Self::Fresh,
        fresh: &Fresh<Self::Sample>,
        canvas: &mut Canvas<Self::Pixel>,
    ) -> bool;
}

/// Light of a window.
pub(crate) type LightOf<A> = <<A as WindowArithmetic>::Sums as WindowSums>::Light;

/// Windows that have just been weighed, in a picture without mirror images.
pub(crate) struct Fresh<'a, T> {
    pub(crate) texels: &'a Texels<'a, T, 1, 0>,
    pub(crate) windows: &'a Windows,
    /// First of the pixels, and the bits of those that the windows make.
    pub(crate) pixel: [usize; 2],
    pub(crate) lanes: u8,
    /// Whether light is clamped to the texels under the pixel.
    pub(crate) is_bounded: bool,
}

/// Window of a pixel in N mirror images. In the last R of them, texels run from right to left.
#[derive(Clone, Copy)]
pub(crate) struct Window<'a, S, T, const N: usize, const R: usize> {
    pub(crate) simd: S,
    pub(crate) texels: &'a Texels<'a, T, N, R>,
    /// Runs of the window's group, among them its own.
    pub(crate) group: &'a [Run],
    pub(crate) run: &'a Run,
    /// Column and row of its first texel.
    pub(crate) first: [u32; 2],
    /// Numbers of the group, from this window's header on.
    pub(crate) numbers: &'a [u32],
    /// Whether its light is clamped to the texels under the pixel.
    pub(crate) is_bounded: bool,
}

impl<S, T, const N: usize, const R: usize> Window<'_, S, T, N, R> {
    #[inline(always)]
    pub(crate) fn header(&self) -> Header {
        Header(self.numbers[0])
    }
}

/// Everything that makes the pixels of a band, once light is given.
pub(crate) struct BandFilter<'a, A> {
    pub(crate) level: Level,
    pub(crate) mirrors: &'a Mirrors,
    pub(crate) anti_ringing: bool,
    pub(crate) arithmetic: A,
}

impl<A: WindowArithmetic> Maker<A::Format, A::Pixel> for BandFilter<'_, A> {
    type Memory = A::Fresh;

    fn fill(&self, band: &Band<A::Format>, canvas: &mut Canvas<A::Pixel>) {
        let level = self.level;
        dispatch!(level, simd => {
            self.runs(simd, band, canvas);
            band.singles.fill(simd, self.mirrors, (&self.arithmetic, self.anti_ringing), canvas);
        });
    }

    fn put_at_once(
        &self,
        memory: &mut A::Fresh,
        (pixel, lanes): ([usize; 2], u8),
        windows: &Windows,
        canvas: &mut Canvas<A::Pixel>,
    ) -> bool {
        let Some(texels) = self.texels_unless_mirrored(windows.view()) else { return false };
        let fresh = Fresh { texels: &texels, windows, pixel, lanes, is_bounded: self.anti_ringing };
        let level = self.level;
        dispatch!(level, simd => self.arithmetic.put_at_once(simd, memory, &fresh, canvas))
    }
}

impl<A: WindowArithmetic> BandFilter<'_, A> {
    /// Returns the texels of a view in a picture without mirror images; `None` in others.
    fn texels_unless_mirrored(&self, view: usize) -> Option<Texels<'_, A::Sample, 1, 0>> {
        if self.mirrors.images.len() > 1 {
            return None;
        }
        let walks = [self.mirrors.ways(view).walks[0]];
        Some(Texels::new(self.arithmetic.texels().as_flattened(), walks, self.mirrors.layout().nth(view)?.size))
    }

    // No closures below except those passed to `vectorize`: in others the compiler would not use the SIMD level's
    // instructions.
    #[inline(always)]
    fn runs<S: Simd>(&self, simd: S, band: &Band<A::Format>, canvas: &mut Canvas<A::Pixel>) {
        if band.runs.is_empty() {
            return;
        }
        let texels = self.arithmetic.texels();
        let views = ViewTexels::all(self.mirrors, texels.as_flattened());
        let mut light: GroupLight<LightOf<A>> = [[[LightOf::<A>::default(); TOGETHER]; SIDE]; SIDE];
        let mut shared = <A::Sums as WindowSums>::Shared::default();
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
            let group = Group { group: pass.group, numbers, is_bounded: self.anti_ringing };
            weigh::<S, A::Sums>(simd, (group, &pass.ways), (&views[view], &mut shared), &mut light);
            self.arithmetic.put(simd, &pass, self.mirrors.ways(view), &light, canvas);
        }
    }
}

/// Sums the light of a pass's windows. It is compiled separately: in one function with the rest of a band, its loop would lack
/// registers.
#[inline(never)]
fn weigh<S: Simd, W: WindowSums>(
    simd: S,
    (group, ways): (Group, &Range<usize>),
    (texels, shared): (&ViewTexels<W::Sample>, &mut W::Shared),
    light: &mut GroupLight<W::Light>,
) {
    // A function for each number of mirror images: all in one would take the compiler minutes.
    match texels {
        ViewTexels::Turned([_, turned]) if ways.start > 0 => simd.vectorize(
            #[inline(always)]
            || group.weigh::<S, W, 4, 2, true>(simd, (turned, shared), 0, light),
        ),
        ViewTexels::Four(texels) | ViewTexels::Turned([texels, _]) => simd.vectorize(
            #[inline(always)]
            || group.weigh::<S, W, 4, 2, false>(simd, (texels, shared), 0, light),
        ),
        ViewTexels::Eight(texels) => simd.vectorize(
            #[inline(always)]
            || group.weigh::<S, W, 4, 2, false>(simd, (&texels[ways.start / TOGETHER], shared), 0, light),
        ),
        ViewTexels::Two(texels) => simd.vectorize(
            #[inline(always)]
            || group.weigh::<S, W, 2, 1, false>(simd, (texels, shared), 0, light),
        ),
        ViewTexels::OneByOne { forward, reversed } => simd.vectorize(
            #[inline(always)]
            || {
                for (image, texels) in forward.iter().enumerate() {
                    group.weigh::<S, W, 1, 0, false>(simd, (texels, shared), image, light);
                }
                for (image, texels) in (forward.len()..).zip(reversed) {
                    group.weigh::<S, W, 1, 1, false>(simd, (texels, shared), image, light);
                }
            },
        ),
    }
}

/// Windows of a group.
#[derive(Clone, Copy)]
struct Group<'a> {
    group: &'a [Run],
    /// Numbers of the band, from the group's first header on.
    numbers: &'a [u32],
    is_bounded: bool,
}

impl Group<'_> {
    /// Sums the light in N mirror images, from this one on. In the last R, texels run from right to left. If `TURNED`,
    /// rows are columns in all of them.
    #[inline(always)]
    fn weigh<S: Mirrored<N>, W: WindowSums, const N: usize, const R: usize, const TURNED: bool>(
        self,
        simd: S,
        (texels, shared): (&Texels<W::Sample, N, R>, &mut W::Shared),
        image: usize,
        light: &mut GroupLight<W::Light>,
    ) {
        let Self { group, mut numbers, is_bounded } = self;
        let mut count = window_count(group);
        W::begin(shared);
        while count > 0 {
            prefetch_weights(numbers);
            let Place { run, lane } = Header(numbers[0]).place();
            let light = &mut light[run][lane][image..][..N];
            let run = &group[run];
            let window = Window { simd, texels, group, run, first: run.first(lane), numbers, is_bounded };
            let length = W::weigh::<S, N, R, TURNED>(window, shared, light);
            (numbers, count) = (&numbers[length..], count - 1);
        }
    }
}
