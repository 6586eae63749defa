//! Weights of many pixels at once, with a lane for each pixel's window of texels.

use std::ops::Range;

use fearless_simd::{Simd, dispatch, f32x8, f32x16, prelude::*};

use super::centring::{Correction, Moments, RowSums};
use super::ellipses::Ellipses;
use super::window::{Level, ROOM, Size, Windows};
use crate::filter::Kernel;
use crate::filter::ewa::cubic::Cubics;
use crate::filter::ewa::gaussian::Gaussian;
use crate::filter::ewa::lanes::{Falloff, Lanes};
use crate::filter::kernel::UNDER;
use crate::render::scan::patch::Patch;
use crate::render::scan::tile::SIDE;

/// Greatest number of rows of a patch that are weighed together.
const ROWS: usize = 2;

/// Cross-sections of a kernel that lanes can weigh by.
#[derive(Clone, Copy)]
enum Shape {
    Cubics(Cubics),
    Gaussian(Gaussian),
}

impl Shape {
    fn of(kernel: &Kernel) -> Option<Self> {
        Cubics::of(kernel).map(Self::Cubics).or_else(|| Gaussian::of(kernel).map(Self::Gaussian))
    }
}

/// Weigher of texels by one kernel.
pub(crate) struct Weigher {
    level: Level,
    shape: Shape,
    kernel: Kernel,
    /// Windows that are weighed together.
    windows: [Windows; ROWS],
    /// Weight of each texel before it is centred, and the slack by which a correction may change it.
    loose: Vec<f32>,
}

impl Weigher {
    /// Makes the weigher of a kernel. `None` unless its cross-sections are cubics or one wide Gaussian, which lanes can
    /// weigh. `None` also if the floor is below one: there might be no texel under a pixel to clamp to.
    pub(crate) fn new(kernel: &Kernel, level: Level) -> Option<Self> {
        let shape = Shape::of(kernel).filter(|_| kernel.floor >= 1.0)?;
        let windows = std::array::from_fn(|_| Windows::new(level));
        Some(Self { level, shape, kernel: *kernel, windows, loose: vec![0.0; 2 * ROWS * SIDE * ROOM] })
    }

    /// Returns the windows of a patch.
    pub(crate) fn rows<'w>(&'w mut self, patch: &'w Patch<'w>) -> PatchWindows<'w> {
        PatchWindows { weigher: self, patch, weighed: 0..0 }
    }

    /// Weighs a row of a patch, and with wide vectors the next one, too. Returns the number of rows.
    fn weigh(&mut self, patch: &Patch, row: usize) -> usize {
        let level = self.level;
        dispatch!(level, simd => self.weigh_rows(simd, patch, row))
    }

    #[inline(always)]
    fn weigh_rows<S: Simd>(&mut self, simd: S, patch: &Patch, row: usize) -> usize {
        if S::f32s::LEN == f32x16::<S>::LEN && row + 1 < SIDE {
            let ellipses = Ellipses::<f32x16<S>>::new(simd, &self.kernel, patch, row);
            if ellipses.size(0) == ellipses.size(1) {
                self.fill(simd, &ellipses, patch);
                return 2;
            }
        }
        self.fill(simd, &Ellipses::<f32x8<S>>::new(simd, &self.kernel, patch, row), patch);
        1
    }

    /// Fills windows of one size.
    #[inline(always)]
    fn fill<S: Simd, V: Lanes<S>>(&mut self, simd: S, ellipses: &Ellipses<V>, patch: &Patch) {
        let size = ellipses.size(0);
        let mut any = false;
        for (row, windows) in self.windows[..V::ROWS].iter_mut().enumerate() {
            any |= windows.place(patch, &ellipses.first(row), size);
        }
        if any {
            self.make_room(size[0] * size[1]);
            let moments = match self.shape {
                Shape::Cubics(cubics) => self.measure(simd, ellipses, size, &cubics.blend(ellipses.coarseness)),
                Shape::Gaussian(gaussian) => self.measure(simd, ellipses, size, &gaussian),
            };
            let correction = moments.correction(simd, self.kernel.centred.then_some(&patch.bend));
            self.settle(simd, &ellipses.start, size, &correction);
        }
    }

    /// Makes room for windows of this number of texels, in all rows.
    fn make_room(&mut self, texels: usize) {
        let length = 2 * ROWS * SIDE * texels;
        if self.loose.len() < length {
            self.loose.resize(length, 0.0);
            self.windows.iter_mut().for_each(|windows| windows.make_room(texels));
        }
    }

    /// Weighs each texel by the kernel and its solid angle.
    #[inline(always)]
    fn measure<S: Simd, V: Lanes<S>>(
        &mut self,
        simd: S,
        ellipses: &Ellipses<V>,
        [width, height]: [usize; 2],
        curve: &impl Falloff<V>,
    ) -> Moments<V> {
        let [x0, mut y] = ellipses.start;
        let zero = V::splat(simd, 0.0);
        let inverse = ((self.kernel.radius() * self.kernel.radius()) as f32).recip();
        let reach = V::splat(simd, UNDER as f32);
        let mut moments = Moments::zero(simd);
        let mut loose = self.loose.chunks_exact_mut(2 * V::LEN);
        let [first, second] = &mut self.windows;
        let mut under = first.under.iter_mut().zip(&mut second.under);
        for _ in 0..height {
            let row = ellipses.texels_at(y);
            let mut sums = RowSums::zero(simd);
            let mut x = x0;
            for (loose, under) in loose.by_ref().zip(under.by_ref()).take(width) {
                let (q, solid_angle) = (row.distance_squared(x), row.solid_angle(x));
                let falloff = (zero + 1.0 - q * inverse).max(zero);
                let (w, v) = (curve.weight(q) * solid_angle, falloff * falloff * solid_angle);
                let (weight, slack) = loose.split_at_mut(V::LEN);
                w.store_slice(weight);
                v.store_slice(slack);
                let lanes = q.simd_lt(reach).to_bitmask();
                (*under.0, *under.1) = (lanes as u8, (lanes >> SIDE) as u8);
                sums.add(w, v, x);
                x += 1.0;
            }
            moments.add(&sums, y);
            y += 1.0;
        }
        moments
    }

    /// Corrects the weights: their centroid moves onto the pixel's centre, and their sum to one.
    #[inline(always)]
    fn settle<S: Simd, V: Lanes<S>>(
        &mut self,
        simd: S,
        [x0, y0]: &[V; 2],
        [width, height]: [usize; 2],
        correction: &Correction<V>,
    ) {
        let mut loose = self.loose.chunks_exact(2 * V::LEN);
        let [first, second] = &mut self.windows;
        let mut weights = first.weights.iter_mut().zip(&mut second.weights);
        let (mut largest, mut sum) = (V::splat(simd, 0.0), V::splat(simd, 0.0));
        let mut y = *y0;
        for _ in 0..height {
            let row = correction.row(y);
            let mut x = *x0;
            for (loose, weights) in loose.by_ref().zip(weights.by_ref()).take(width) {
                let (weight, slack) = loose.split_at(V::LEN);
                let settled = row.apply(V::from_slice(simd, weight), V::from_slice(simd, slack), x);
                largest = largest.max(settled.abs());
                sum += settled.abs();
                *weights.0 = settled.row(0).to_array();
                if V::ROWS == 2 {
                    *weights.1 = settled.row(1).to_array();
                }
                x += 1.0;
            }
            y += 1.0;
        }
        for (row, windows) in self.windows[..V::ROWS].iter_mut().enumerate() {
            windows.size = Size { largest: largest.row(row).reduce_max(), sum: sum.row(row).reduce_max() };
        }
    }
}

/// Windows of a patch, computed when they are needed.
pub(crate) struct PatchWindows<'w> {
    weigher: &'w mut Weigher,
    patch: &'w Patch<'w>,
    /// Rows that the weigher holds.
    weighed: Range<usize>,
}

impl PatchWindows<'_> {
    /// Returns the windows of a row; weighs it first if necessary.
    pub(crate) fn row(&mut self, row: usize) -> &Windows {
        if !self.weighed.contains(&row) {
            self.weighed = row..row + self.weigher.weigh(self.patch, row);
        }
        &self.weigher.windows[row - self.weighed.start]
    }
}
