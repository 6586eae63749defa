//! Average of the texels under a kernel, eight texels of a row at a time and without a list of taps.

use std::f64::consts::FRAC_1_SQRT_2;

use arrayvec::ArrayVec;
use fearless_simd::{Simd, f32x4, f32x8, prelude::*};
use glam::DVec2;

use super::cubic::Cubics;
use crate::filter::Kernel;
use crate::filter::gather::tap_weights::THINNEST;
use crate::filter::kernel::UNDER;
use crate::filter::rim::clamp_set::Wedge;
use crate::raster::Rgba;

/// Kernel whose two cross-sections are cubics, so that SIMD lanes can evaluate it.
pub(crate) struct LaneKernel {
    pub(crate) kernel: Kernel,
    pub(crate) cubics: Cubics,
    /// Whether averages are clamped to the texels under the footprint.
    pub(crate) anti_ringing: bool,
}

impl LaneKernel {
    /// Returns whether the average needs texels on all sides of the footprint's middle.
    pub(crate) fn needs_surroundings(&self) -> bool {
        self.kernel.centred || self.anti_ringing
    }

    /// Returns whether the texels that the average needs lie under every footprint. A plain mean by positive weights needs
    /// but one, and every disc of the radius √½ holds one.
    pub(crate) fn always_averages(&self) -> bool {
        let Kernel { floor, .. } = self.kernel;
        let is_plain = !self.needs_surroundings() && self.cubics.are_positive();
        floor >= 1.0 || is_plain && floor * self.kernel.radius() > FRAC_1_SQRT_2
    }
}

/// Number of texels in a block.
pub(crate) const LANES: usize = 8;

/// Greatest number of blocks for one footprint. The texels of a larger one are listed as taps instead.
const MOST: usize = 512;

/// Up to eight neighbouring texels of a row.
struct Block {
    /// Index of the first texel in the light, and the number of texels.
    first: usize,
    count: usize,
    /// Bit mask of the texels under the footprint, which are contiguous.
    under: u64,
    /// Kernel's weight times the texel's solid angle; zero in lanes without a texel.
    weight: [f32; LANES],
    /// Factor on the correction that centres the weights (see [`Correction`]): positive, and zero at the kernel's edge.
    window: [f32; LANES],
    /// Offsets from the footprint's middle, in any linear unit.
    x: [f32; LANES],
    y: [f32; LANES],
}

/// Texels under a kernel, in blocks.
#[derive(Default)]
pub(crate) struct Blocks(ArrayVec<Block, MOST>);

/// Weights and offsets of the texels of a block, one texel in each lane.
pub(crate) struct Weighed<S: Simd> {
    /// Square of the distance from the footprint's middle, in the kernel's unit.
    pub(crate) q: f32x8<S>,
    /// Weight, before the solid angle.
    pub(crate) weight: f32x8<S>,
    /// Solid angle, up to a common factor.
    pub(crate) solid_angle: f32x8<S>,
    /// Offset from the middle.
    pub(crate) offset: [f32x8<S>; 2],
}

/// Returns the numbers 0 to 7 in lanes.
#[inline(always)]
pub(crate) fn count_up<S: Simd>(simd: S) -> f32x8<S> {
    f32x8::simd_from(simd, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0])
}

impl Blocks {
    /// Adds the first `count` texels of a block; `inverse` is 1 over the kernel's radius². `None` if they do not fit.
    #[inline(always)]
    pub(crate) fn push<S: Simd>(
        &mut self,
        simd: S,
        (first, count): (usize, usize),
        weighed: Weighed<S>,
        inverse: f32,
    ) -> Option<()> {
        let Weighed { q, weight, solid_angle, offset: [x, y] } = weighed;
        let zero = f32x8::splat(simd, 0.0);
        let solid_angle = count_up(simd).simd_lt(f32x8::splat(simd, count as f32)).select(solid_angle, zero);
        let falloff = (zero + 1.0 - q * inverse).max(zero);
        let under = q.simd_lt(f32x8::splat(simd, UNDER as f32)).to_bitmask() & ((1 << count) - 1);
        let (weight, window) = ((weight * solid_angle).to_array(), (falloff * falloff * solid_angle).to_array());
        self.0.try_push(Block { first, count, under, weight, window, x: x.to_array(), y: y.to_array() }).ok()
    }

    /// Returns whether texels under the footprint lie all around its middle.
    pub(crate) fn surround(&self) -> bool {
        let mut wedge = Wedge::default();
        let under = |block: &Block| {
            (0..LANES).filter({
                let under = block.under;
                move |lane| under >> lane & 1 == 1
            })
        };
        self.0.iter().any(|block| under(block).any(|lane| wedge.closes_with([block.x[lane], block.y[lane]])))
    }

    /// Averages the texels' light. With `centred`, the centroid of the weights is the footprint's middle. With
    /// `anti_ringing`, the average is clamped to the texels under the footprint.
    #[inline(always)]
    pub(crate) fn average<S: Simd>(&self, simd: S, light: &[Rgba], centred: bool, anti_ringing: bool) -> Rgba {
        let Correction { scale, gradient, constant } = self.correction(simd, centred);
        let (gx, gy) = (f32x8::splat(simd, gradient[0]), f32x8::splat(simd, gradient[1]));
        let (scale, constant) = (f32x8::splat(simd, scale), f32x8::splat(simd, constant));
        let mut sum = f32x4::splat(simd, 0.0);
        let (mut least, mut greatest) = (f32x4::splat(simd, f32::INFINITY), f32x4::splat(simd, f32::NEG_INFINITY));
        for block in &self.0 {
            let [weight, window, x, y] = block.lanes(simd);
            let weight = (weight * scale + window * (x * gx + (y * gy + constant))).to_array();
            let texels = &light[block.first..][..block.count];
            for (texel, weight) in texels.iter().zip(weight) {
                let weight = f32x4::splat(simd, weight);
                sum += f32x4::load_array_ref(simd, &texel.0) * weight;
            }
            let (from, under) = (block.under.trailing_zeros() as usize, block.under.count_ones() as usize);
            for texel in texels.iter().skip(from).take(under) {
                let texel = f32x4::load_array_ref(simd, &texel.0);
                (least, greatest) = (least.min(texel), greatest.max(texel));
            }
        }
        let held = if anti_ringing { sum.max(least).min(greatest) } else { sum };
        Rgba(held.to_array())
    }

    /// Computes the correction that makes the weights' sum one. With `centred` it also makes their centroid the middle
    /// (see [`crate::filter::gather::tap_weights`]).
    #[inline(always)]
    fn correction<S: Simd>(&self, simd: S, centred: bool) -> Correction {
        let mut sums = [f32x8::splat(simd, 0.0); 9];
        for block in &self.0 {
            let [w, v, x, y] = block.lanes(simd);
            let (vx, vy) = (v * x, v * y);
            // Added one by one: a loop would keep the sums in memory instead of registers.
            sums[0] += w;
            sums[1] += w * x;
            sums[2] += w * y;
            sums[3] += v;
            sums[4] += vx;
            sums[5] += vy;
            sums[6] += vx * x;
            sums[7] += vx * y;
            sums[8] += vy * y;
        }
        let mut totals = [0f64; 9];
        for (total, sum) in totals.iter_mut().zip(sums) {
            *total = f64::from(sum.to_array().iter().sum::<f32>());
        }
        let [w, wx, wy, v, vx, vy, vxx, vxy, vyy] = totals;
        let mean = DVec2::new(vx, vy) / v;
        let (xx, xy, yy) = (vxx - vx * mean.x, vxy - vx * mean.y, vyy - vy * mean.y);
        let determinant = xx * yy - xy * xy;
        let is_plane = centred && determinant > f64::from(THINNEST) * xx * yy;
        let gradient = DVec2::new(xy * wy - yy * wx, xy * wx - xx * wy) / (w * determinant);
        let gradient = if is_plane { gradient } else { DVec2::ZERO };
        let constant = -gradient.dot(mean) as f32;
        Correction { scale: w.recip() as f32, gradient: [gradient.x as f32, gradient.y as f32], constant }
    }
}

impl Block {
    /// Returns the weights, windows and offsets.
    #[inline(always)]
    fn lanes<S: Simd>(&self, simd: S) -> [f32x8<S>; 4] {
        [
            f32x8::load_array_ref(simd, &self.weight),
            f32x8::load_array_ref(simd, &self.window),
            f32x8::load_array_ref(simd, &self.x),
            f32x8::load_array_ref(simd, &self.y),
        ]
    }
}

/// Coefficients of a texel's corrected weight, w·scale + v·(gradient·p + constant), where w is its weight, v its window
/// and p its offset.
struct Correction {
    scale: f32,
    gradient: [f32; 2],
    constant: f32,
}
