//! The weights of eight pixels at once: a lane for each, a window of texels around each.

use std::ops::Range;

/// The level of instructions that lanes use: found once, for all of them.
pub(super) use fearless_simd::Level;
use fearless_simd::{dispatch, f32x8, prelude::*};

use super::bend::Bend;
use super::cubics::Cubics;
use super::ellipses::Ellipses;
use super::kernel::UNDER;
use super::moments::{Moments, RowSums};
use super::patch::{Patch, SIDE};
use super::{Kernel, Tap, Taps};

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
    /// The view that holds the texels, by its index in the world.
    view: usize,
    /// Columns of the view that count.
    within: Range<u32>,
    /// Index of the view's first texel in the world's buffer, and its texels from one row to the next.
    offset: usize,
    stride: usize,
    /// Column and row of each window's first texel; `None` where the window is not all inside the view.
    corners: [Option<[u32; 2]>; SIDE],
    weights: Vec<[f32; SIDE]>,
    /// By how much a correction may change a weight.
    slack: Vec<[f32; SIDE]>,
    /// In which lanes a texel lies under the pixel, a bit for each.
    under: Vec<u8>,
}

impl Windows {
    /// Windows for a kernel; `None` if it is one that lanes cannot weigh: not cubic, or with a floor under one, so that there
    /// could be no texel under a pixel to clamp to.
    pub(super) fn new(kernel: &Kernel, level: Level) -> Option<Self> {
        let cubics = Cubics::of(kernel).filter(|_| kernel.floor >= 1.0)?;
        let room = || vec![[0.0; SIDE]; LARGEST];
        Some(Self {
            level,
            cubics,
            kernel: *kernel,
            width: 0,
            height: 0,
            view: 0,
            within: 0..0,
            offset: 0,
            stride: 0,
            corners: [None; SIDE],
            weights: room(),
            slack: room(),
            under: vec![0; LARGEST],
        })
    }

    /// The level of instructions that fills them.
    pub(super) fn level(&self) -> Level {
        self.level
    }

    /// The windows of a row of a patch.
    pub(super) fn fill(&mut self, patch: &Patch, row: usize) {
        let level = self.level;
        dispatch!(level, simd => self.fill_lanes(simd, patch, row));
    }

    /// Whether this lane's window lies inside the view, so that its weights are right.
    pub(super) fn holds(&self, lane: usize) -> bool {
        self.corners[lane].is_some()
    }

    /// Column and row of a lane's first texel, if its window holds.
    pub(super) fn corner(&self, lane: usize) -> Option<[u32; 2]> {
        self.corners[lane]
    }

    /// The index of the view that holds the texels.
    pub(super) fn view(&self) -> usize {
        self.view
    }

    /// The columns of the view, within which all windows that hold lie.
    pub(super) fn columns_within(&self) -> Range<u32> {
        self.within.clone()
    }

    /// Texels of a window across.
    pub(super) fn width(&self) -> usize {
        self.width
    }

    /// Texels of a window down.
    pub(super) fn height(&self) -> usize {
        self.height
    }

    /// The weights of all texels of the windows, row by row, a lane for each window.
    pub(super) fn weights(&self) -> &[[f32; SIDE]] {
        &self.weights[..self.width * self.height]
    }

    /// In which lanes each of them lies under the pixel, a bit for each.
    pub(super) fn under(&self) -> &[u8] {
        &self.under[..self.width * self.height]
    }

    /// Both.
    pub(super) fn texels(&self) -> impl Iterator<Item = (&[f32; SIDE], &u8)> + Clone {
        self.weights().iter().zip(self.under())
    }

    /// The rows in which some window has texels under its pixel, and those between.
    pub(super) fn rows_under(&self) -> Range<usize> {
        let holds = |row: &usize| self.under[row * self.width..][..self.width].iter().any(|&lanes| lanes != 0);
        let first = (0..self.height).find(holds).unwrap_or(0);
        first..(first..self.height).rev().find(holds).map_or(first, |last| last + 1)
    }

    /// A lane's window as a list.
    pub(super) fn taps(&self, lane: usize, taps: &mut Taps) {
        taps.clear();
        let Some([left, top]) = self.corners[lane] else { return };
        let first = self.offset + top as usize * self.stride + left as usize;
        let texel = |at: usize| (first + at / self.width * self.stride + at % self.width) as u32;
        let used = self.texels().enumerate().filter(|(_, (weights, _))| weights[lane] != 0.0);
        let settled = used
            .map(|(at, (weights, under))| (under >> lane & 1 == 1, Tap { texel: texel(at), weight: weights[lane] }));
        taps.fill(settled.clone(), settled.clone().count(), settled.filter(|(is_under, _)| *is_under).count());
    }

    #[inline(always)]
    fn fill_lanes<S: Simd>(&mut self, simd: S, patch: &Patch, row: usize) {
        let ellipses = Ellipses::new(simd, &self.kernel, patch, row);
        (self.width, self.height) = (ellipses.width, ellipses.height);
        self.place(patch, &ellipses.first);
        if self.corners == [None; SIDE] {
            return;
        }
        let moments = self.weigh(simd, &ellipses);
        self.settle(simd, &ellipses.start, &moments, &patch.bend);
    }

    /// Finds which windows are inside the view.
    fn place(&mut self, patch: &Patch, first: &[[f32; SIDE]; 2]) {
        let source = patch.source;
        let whole = &source.whole;
        self.within = whole.left as u32..whole.right as u32;
        let (width, height) = (self.width as i64, self.height as i64);
        (self.view, self.offset, self.stride) = (patch.view, source.offset, source.view.width());
        self.corners = std::array::from_fn(|lane| {
            let (left, top) = (patch.origin[0] + first[0][lane] as i64, patch.origin[1] + first[1][lane] as i64);
            let columns = left >= whole.left as i64 && left + width <= whole.right as i64;
            let rows = top >= whole.top as i64 && top + height <= whole.bottom as i64;
            (columns && rows && self.width * self.height <= LARGEST).then_some([left as u32, top as u32])
        });
    }

    /// Weighs each texel by the kernel and its solid angle.
    #[inline(always)]
    fn weigh<S: Simd>(&mut self, simd: S, ellipses: &Ellipses<S>) -> Moments<S> {
        let zero = f32x8::splat(simd, 0.0);
        let inverse = ((self.kernel.radius() * self.kernel.radius()) as f32).recip();
        let curve = self.cubics.blend(ellipses.coarseness);
        let under = f32x8::splat(simd, UNDER as f32);
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
                self.under[at] = q.simd_lt(under).to_bitmask() as u8;
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
}

#[cfg(test)]
/// The levels of instructions that this machine has.
pub(super) fn levels() -> Vec<Level> {
    let best = Level::new();
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    let between = [best.as_sse4_2().map(|simd| simd.level()), best.as_avx2().map(|simd| simd.level())];
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    let between = [None; 2];
    [Some(Level::baseline()), Some(best)].into_iter().chain(between).flatten().collect()
}
