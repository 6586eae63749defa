//! Texels under a kernel, eight of a row at once: weighed, centred and averaged without a list of taps.

use arrayvec::ArrayVec;
use fearless_simd::{Simd, f32x4, f32x8, prelude::*};
use glam::DVec2;

use super::cubic::Cubics;
use crate::filter::Kernel;
use crate::filter::gather::tap_weights::THINNEST;
use crate::filter::kernel::UNDER;
use crate::filter::rim::clamp_set::Wedge;
use crate::raster::Rgba;

/// A kernel of two cubics, and what is made of its weights.
pub(crate) struct LaneKernel {
    pub(crate) kernel: Kernel,
    pub(crate) cubics: Cubics,
    /// Whether averages are held to what the texels under the footprint have.
    pub(crate) anti_ringing: bool,
}

/// Texels in a block.
pub(crate) const LANES: usize = 8;

/// Blocks that are had room for.
const MOST: usize = 512;

/// Texels beside each other, eight at most.
struct Block {
    /// Index of the first one in the light, and how many there are.
    first: usize,
    count: usize,
    /// Which of them are under the footprint, a bit for each: they follow one another.
    under: u64,
    /// The kernel's weight times the solid angle; zero in lanes without a texel.
    weight: [f32; LANES],
    /// How much of a correction each may take: positive, falling to nothing at the kernel's edge.
    window: [f32; LANES],
    /// Offsets from the footprint's middle, in any linear unit.
    x: [f32; LANES],
    y: [f32; LANES],
}

/// The texels under a kernel.
#[derive(Default)]
pub(crate) struct Blocks(ArrayVec<Block, MOST>);

/// What is known of the texels of a block, in lanes.
pub(crate) struct Weighed<S: Simd> {
    /// Square of the distance from the footprint's middle, in the kernel's unit.
    pub(crate) q: f32x8<S>,
    /// Weight, before the solid angle.
    pub(crate) weight: f32x8<S>,
    /// Solid angle, in any unit.
    pub(crate) solid_angle: f32x8<S>,
    /// Offset from the middle.
    pub(crate) offset: [f32x8<S>; 2],
}

/// Numbers 0 to 7 in lanes.
#[inline(always)]
pub(crate) fn count_up<S: Simd>(simd: S) -> f32x8<S> {
    f32x8::simd_from(simd, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0])
}

impl Blocks {
    /// Adds the first `count` texels of a block; `inverse` is one over the kernel's radius². `None` where there is no room.
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

    /// Whether texels under the footprint lie all around its middle.
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

    /// The average of the texels' light; with `centred` their centroid is the footprint's middle, with `anti_ringing` it is held to
    /// what those under the footprint have.
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

    /// What makes the weights' sum one, and with `centred` their centroid the middle (see [`crate::filter::gather::tap_weights`]).
    #[inline(always)]
    fn correction<S: Simd>(&self, simd: S, centred: bool) -> Correction {
        let mut sums = [f32x8::splat(simd, 0.0); 9];
        for block in &self.0 {
            let [w, v, x, y] = block.lanes(simd);
            let (vx, vy) = (v * x, v * y);
            // One by one: a loop would keep them in memory.
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
    /// Its weights, windows and offsets.
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

/// What becomes of the weights: w·scale + v·(g·p + constant).
struct Correction {
    scale: f32,
    gradient: [f32; 2],
    constant: f32,
}
