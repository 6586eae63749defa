//! The weights of eight pixels at once: a lane for each, a window of texels around each.

use fearless_simd::{Level, dispatch, f32x4, f32x8, prelude::*};

use super::bend::Bend;
use super::cubics::Cubics;
use super::ellipses::Ellipses;
use super::kernel::UNDER;
use super::moments::{Moments, RowSums};
use super::patch::{Patch, SIDE};
use super::{Kernel, Tap, Taps};
use crate::raster::Rgba;

/// Texels of the largest window. Beyond, a pixel by itself is not slower.
const LARGEST: usize = 256;

/// [`SIDE`] pixels beside each other, each with a window of texels wholly inside one view: all windows of one size, each
/// in its own place, with the texels' weights, which add to one.
#[derive(Clone, Debug)]
pub(super) struct Windows {
    level: Level,
    cubics: Cubics,
    kernel: Kernel,
    width: usize,
    height: usize,
    /// Index of each window's first texel in the world's buffer; `None` where the window is not all inside the view.
    first: [Option<u32>; SIDE],
    /// Texels from one row of a window to the next.
    stride: usize,
    weights: Vec<[f32; SIDE]>,
    /// By how much a correction may change a weight.
    slack: Vec<[f32; SIDE]>,
    /// Zero for a texel under the pixel, infinity for one around it.
    beyond: Vec<[f32; SIDE]>,
}

impl Windows {
    /// Windows for a kernel; `None` if it is one that lanes cannot weigh: not cubic, or with a floor under one, so that there
    /// could be no texel under a pixel to clamp to.
    pub(super) fn new(kernel: &Kernel) -> Option<Self> {
        Self::at_level(kernel, Level::new())
    }

    /// The same with the instructions of a level.
    fn at_level(kernel: &Kernel, level: Level) -> Option<Self> {
        let cubics = Cubics::of(kernel).filter(|_| kernel.floor >= 1.0)?;
        let room = || vec![[0.0; SIDE]; LARGEST];
        Some(Self {
            level,
            cubics,
            kernel: *kernel,
            width: 0,
            height: 0,
            first: [None; SIDE],
            stride: 0,
            weights: room(),
            slack: room(),
            beyond: room(),
        })
    }

    /// One for each level of instructions that this machine has.
    #[cfg(test)]
    pub(super) fn at_every_level(kernel: &Kernel) -> Vec<Self> {
        let best = Level::new();
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        let between = [best.as_sse4_2().map(|simd| simd.level()), best.as_avx2().map(|simd| simd.level())];
        #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
        let between = [None; 2];
        let levels = [Some(Level::baseline()), Some(best)].into_iter().chain(between).flatten();
        let mut seen = Vec::new();
        let levels = levels.filter(|level| {
            let kind = std::mem::discriminant(level);
            let is_new = !seen.contains(&kind);
            seen.push(kind);
            is_new
        });
        levels.filter_map(|level| Self::at_level(kernel, level)).collect()
    }

    /// The windows of a row of a patch.
    pub(super) fn fill(&mut self, patch: &Patch, row: usize) {
        let level = self.level;
        dispatch!(level, simd => self.fill_lanes(simd, patch, row));
    }

    /// Whether this lane's window lies inside the view, so that its weights are right.
    pub(super) fn holds(&self, lane: usize) -> bool {
        self.first[lane].is_some()
    }

    /// The averages of all the lanes whose windows hold; the others are zero.
    pub(super) fn average(&self, texels: &[Rgba], anti_ringing: bool) -> [Rgba; SIDE] {
        let level = self.level;
        dispatch!(level, simd => self.average_lanes(simd, texels, anti_ringing))
    }

    /// How many texels of a lane's window have a weight.
    pub(super) fn tap_count(&self, lane: usize) -> usize {
        if self.holds(lane) { self.weights().filter(|weights| weights[lane] != 0.0).count() } else { 0 }
    }

    fn weights(&self) -> impl Iterator<Item = &[f32; SIDE]> + Clone {
        self.weights[..self.width * self.height].iter()
    }

    /// A lane's window as a list.
    pub(super) fn taps(&self, lane: usize, taps: &mut Taps) {
        taps.clear();
        let Some(first) = self.first[lane] else { return };
        let texel = |at: usize| first + (at / self.width * self.stride + at % self.width) as u32;
        let used = self.weights().zip(&self.beyond).enumerate().filter(|(_, (weights, _))| weights[lane] != 0.0);
        let settled =
            used.map(|(at, (weights, beyond))| (beyond[lane] == 0.0, Tap { texel: texel(at), weight: weights[lane] }));
        taps.fill(settled.clone(), self.tap_count(lane), settled.filter(|(is_under, _)| *is_under).count());
    }

    #[inline(always)]
    fn fill_lanes<S: Simd>(&mut self, simd: S, patch: &Patch, row: usize) {
        let ellipses = Ellipses::new(simd, &self.kernel, patch, row);
        (self.width, self.height) = (ellipses.width, ellipses.height);
        self.place(patch, &ellipses.first);
        if self.first == [None; SIDE] {
            return;
        }
        let moments = self.weigh(simd, &ellipses);
        self.settle(simd, &ellipses.start, &moments, &patch.bend);
    }

    /// Finds which windows are inside the view.
    fn place(&mut self, patch: &Patch, first: &[[f32; SIDE]; 2]) {
        let source = patch.source;
        let whole = &source.whole;
        let (width, height) = (self.width as i64, self.height as i64);
        self.stride = source.view.width();
        self.first = std::array::from_fn(|lane| {
            let (left, top) = (patch.origin[0] + first[0][lane] as i64, patch.origin[1] + first[1][lane] as i64);
            let columns = left >= whole.left as i64 && left + width <= whole.right as i64;
            let rows = top >= whole.top as i64 && top + height <= whole.bottom as i64;
            (columns && rows && self.width * self.height <= LARGEST)
                .then(|| (source.offset + top as usize * self.stride + left as usize) as u32)
        });
    }

    /// Weighs each texel by the kernel and its solid angle.
    #[inline(always)]
    fn weigh<S: Simd>(&mut self, simd: S, ellipses: &Ellipses<S>) -> Moments<S> {
        let zero = f32x8::splat(simd, 0.0);
        let inverse = ((self.kernel.radius() * self.kernel.radius()) as f32).recip();
        let curve = self.cubics.blend(ellipses.coarseness);
        let under = f32x8::splat(simd, UNDER as f32);
        let around = f32x8::splat(simd, f32::INFINITY);
        let mut moments = Moments::zero(simd);
        let [x0, mut y] = ellipses.start;
        let mut at = 0;
        for _ in 0..self.height {
            let row = ellipses.row(y);
            let mut sums = RowSums::zero(simd);
            let mut x = x0;
            for _ in 0..self.width {
                let (q, solid_angle) = (row.distance_squared(x), row.solid_angle(x));
                let falloff = (zero + 1.0 - q * inverse).max(zero);
                let (w, v) = (curve.weight(q) * solid_angle, falloff * falloff * solid_angle);
                w.store_slice(&mut self.weights[at]);
                v.store_slice(&mut self.slack[at]);
                q.simd_lt(under).select(zero, around).store_slice(&mut self.beyond[at]);
                sums.add(w, v, x);
                x += 1.0;
                at += 1;
            }
            moments.add(&sums, y);
            y += 1.0;
        }
        moments
    }

    /// Moves the centroid of the weights onto the pixel's centre and their sum to one.
    #[inline(always)]
    fn settle<S: Simd>(&mut self, simd: S, [x0, y0]: &[f32x8<S>; 2], moments: &Moments<S>, bend: &Bend) {
        let correction = moments.correction(simd, self.kernel.centred.then_some(bend));
        let mut at = 0;
        let mut y = *y0;
        for _ in 0..self.height {
            let row = correction.row(y);
            let mut x = *x0;
            for _ in 0..self.width {
                let (w, v) = (f32x8::load_array(simd, self.weights[at]), f32x8::load_array(simd, self.slack[at]));
                row.apply(w, v, x).store_slice(&mut self.weights[at]);
                x += 1.0;
                at += 1;
            }
            y += 1.0;
        }
    }

    #[inline(always)]
    fn average_lanes<S: Simd>(&self, simd: S, texels: &[Rgba], anti_ringing: bool) -> [Rgba; SIDE] {
        let mut averages = [Rgba::TRANSPARENT; SIDE];
        // No closures here and below: the compiler gives them no leave to use the level's instructions.
        for (lane, average) in averages.iter_mut().enumerate() {
            let Some(first) = self.first[lane] else { continue };
            let texels = &texels[first as usize..];
            *average = if anti_ringing {
                self.clamped_average(simd, texels, lane)
            } else {
                self.plain_average(simd, texels, lane)
            };
        }
        averages
    }

    #[inline(always)]
    fn plain_average<S: Simd>(&self, simd: S, texels: &[Rgba], lane: usize) -> Rgba {
        let mut sum = f32x4::splat(simd, 0.0);
        for row in 0..self.height {
            let texels = &texels[row * self.stride..][..self.width];
            let weights = &self.weights[row * self.width..][..self.width];
            let mut part = f32x4::splat(simd, 0.0);
            for (texel, weight) in texels.iter().zip(weights) {
                part += f32x4::load_array(simd, texel.0) * weight[lane];
            }
            sum += part;
        }
        Rgba(sum.to_array())
    }

    #[inline(always)]
    fn clamped_average<S: Simd>(&self, simd: S, texels: &[Rgba], lane: usize) -> Rgba {
        let mut sum = f32x4::splat(simd, 0.0);
        let mut least = f32x4::splat(simd, f32::INFINITY);
        let mut greatest = f32x4::splat(simd, f32::NEG_INFINITY);
        for row in 0..self.height {
            let texels = &texels[row * self.stride..][..self.width];
            let weights = &self.weights[row * self.width..][..self.width];
            let beyond = &self.beyond[row * self.width..][..self.width];
            let mut part = f32x4::splat(simd, 0.0);
            for ((texel, weight), beyond) in texels.iter().zip(weights).zip(beyond) {
                let texel = f32x4::load_array(simd, texel.0);
                part += texel * weight[lane];
                least = least.min(texel + beyond[lane]);
                greatest = greatest.max(texel - beyond[lane]);
            }
            sum += part;
        }
        Rgba(sum.max(least).min(greatest).to_array())
    }
}
