//! The weights of eight pixels at once: a lane for each, a window of texels around each.

use fearless_simd::{Level, dispatch, f32x4, f32x8, prelude::*};

use super::cubics::Cubics;
use super::kernel::UNDER;
use super::patch::{Columns, Density, Patch, SIDE};
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

/// Where windows lie, and the ellipses in them.
struct Ellipses<S: Simd> {
    /// Offset of the first texel's centre from the pixel's, along U and V.
    start: [f32x8<S>; 2],
    /// A, B and C.
    conic: [f32x8<S>; 3],
    /// Relative change of the texels' solid angle along U and V.
    gradient: [f32x8<S>; 2],
    /// How much of the coarse cubic counts.
    coarseness: f32x8<S>,
    /// Columns and rows from the patch's origin to the first texel.
    first: [[f32; SIDE]; 2],
    width: usize,
    height: usize,
}

/// Sums over a window: of the weights w and slacks v, and of their products with the offsets.
struct Moments<S: Simd> {
    w: f32x8<S>,
    wx: f32x8<S>,
    wy: f32x8<S>,
    v: f32x8<S>,
    vx: f32x8<S>,
    vy: f32x8<S>,
    vxx: f32x8<S>,
    vxy: f32x8<S>,
    vyy: f32x8<S>,
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
        self.settle(simd, &ellipses.start, &moments);
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
        let radius_squared = (self.kernel.radius() * self.kernel.radius()) as f32;
        let inverse = radius_squared.recip();
        let curve = self.cubics.blend(ellipses.coarseness);
        let ([a, b, c], [x0, y0], gradient) = (ellipses.conic, ellipses.start, ellipses.gradient);
        let mut m =
            Moments { w: zero, wx: zero, wy: zero, v: zero, vx: zero, vy: zero, vxx: zero, vxy: zero, vyy: zero };
        let under = f32x8::splat(simd, UNDER as f32);
        let around = f32x8::splat(simd, f32::INFINITY);
        let mut at = 0;
        let mut y = y0;
        for _ in 0..self.height {
            let (by, cyy) = (b * y, c * y * y);
            let row_angle = gradient[1] * y + 1.0;
            let (mut w_row, mut wx_row, mut v_row, mut vx_row, mut vxx_row) = (zero, zero, zero, zero, zero);
            let mut x = x0;
            for _ in 0..self.width {
                // Q = AU² + BUV + CV² (Greene & Heckbert 1986), over F.
                let q = ((a * x + by) * x + cyy).max(zero);
                let solid_angle = gradient[0] * x + row_angle;
                let falloff = (zero + 1.0 - q * inverse).max(zero);
                let v = falloff * falloff * solid_angle;
                let w = curve.weight(q) * solid_angle;
                w.store_slice(&mut self.weights[at]);
                v.store_slice(&mut self.slack[at]);
                q.simd_lt(under).select(zero, around).store_slice(&mut self.beyond[at]);
                let vx = v * x;
                w_row += w;
                wx_row += w * x;
                v_row += v;
                vx_row += vx;
                vxx_row += vx * x;
                x += 1.0;
                at += 1;
            }
            m.w += w_row;
            m.wx += wx_row;
            m.wy += w_row * y;
            m.v += v_row;
            m.vx += vx_row;
            m.vy += v_row * y;
            m.vxx += vxx_row;
            m.vxy += vx_row * y;
            m.vyy += v_row * y * y;
            y += 1.0;
        }
        m
    }

    /// Moves the centroid of the weights onto the pixel's centre, as [`super::candidates`] does, and their sum to one.
    ///
    /// Offsets in texels serve as well as offsets on the screen: the correction is linear in them.
    #[inline(always)]
    fn settle<S: Simd>(&mut self, simd: S, [x0, y0]: &[f32x8<S>; 2], m: &Moments<S>) {
        let zero = f32x8::splat(simd, 0.0);
        let scale = (zero + 1.0) / m.w;
        let (mean_x, mean_y) = (m.vx / m.v, m.vy / m.v);
        let (xx, xy, yy) = (m.vxx - m.vx * mean_x, m.vxy - m.vx * mean_y, m.vyy - m.vy * mean_y);
        let determinant = xx * yy - xy * xy;
        let factor = if self.kernel.centred {
            determinant.simd_gt(xx * yy * 1e-6).select(scale / determinant, zero)
        } else {
            zero
        };
        let (gx, gy) = ((xy * m.wy - yy * m.wx) * factor, (xy * m.wx - xx * m.wy) * factor);
        let constant = zero - gx * mean_x - gy * mean_y;
        let mut at = 0;
        let mut y = *y0;
        for _ in 0..self.height {
            let row = gy * y + constant;
            let mut x = *x0;
            for _ in 0..self.width {
                let (w, v) = (f32x8::load_array(simd, self.weights[at]), f32x8::load_array(simd, self.slack[at]));
                (w * scale + v * (gx * x + row)).store_slice(&mut self.weights[at]);
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

impl<S: Simd> Ellipses<S> {
    #[inline(always)]
    fn new(simd: S, kernel: &Kernel, patch: &Patch, row: usize) -> Self {
        let down = row as f32 / SIDE as f32;
        let [left, right] = patch.bulge(row);
        let u = row_of(simd, &patch.place[0], down) + (ramp(simd) * (right[0] - left[0]) + left[0]);
        let v = row_of(simd, &patch.place[1], down) + (ramp(simd) * (right[1] - left[1]) + left[1]);
        let (ux, vx) = (row_of(simd, &patch.jacobian[0], down), row_of(simd, &patch.jacobian[1], down));
        let (uy, vy) = (row_of(simd, &patch.jacobian[2], down), row_of(simd, &patch.jacobian[3], down));
        let determinant = ux * vy - uy * vx;
        let (fine, coarse) = (Kernel::FINE as f32, Kernel::COARSE as f32);
        let zero = f32x8::splat(simd, 0.0);
        let coarseness = ((determinant.abs().sqrt() - fine) * (coarse - fine).recip()).max(zero).min(zero + 1.0);

        // As in `Ellipse::new`: JJᵀ = (p q; q r), whose eigenvalues are raised to the floor. With M the same matrix after
        // that, M = αJJᵀ + β, and the conic is M⁻¹.
        let area = (kernel.scale * kernel.scale) as f32;
        let (p, q, r) = ((ux * ux + uy * uy) * area, (ux * vx + uy * vy) * area, (vx * vx + vy * vy) * area);
        let half = (p - r) * 0.5;
        let major = (p + r) * 0.5 + (half * half + q * q).sqrt();
        let tiny = f32x8::splat(simd, 1e-30);
        // Rounding may put a circle's minor axis above its major one; their difference would change its sign.
        let minor = ((determinant * area) * (determinant * area) / major.max(tiny)).min(major);
        let floor = f32x8::splat(simd, (kernel.floor * kernel.floor) as f32);
        let (wide, narrow) = (major.max(floor), minor.max(floor));
        let alpha = ((wide - narrow) / (major - minor).max(tiny)).min(zero + 1.0);
        let beta = wide - alpha * major;
        let (p, q, r) = (alpha * p + beta, alpha * q, alpha * r + beta);
        let inverse = (zero + 1.0) / (wide * narrow);

        let reach = kernel.radius() as f32;
        let (half_width, half_height) = (p.sqrt() * reach, r.sqrt() * reach);
        let (left, right) = ((u - half_width - 0.5).ceil(), (u + half_width - 0.5).floor());
        let (top, bottom) = ((v - half_height - 0.5).ceil(), (v + half_height - 0.5).floor());
        Self {
            start: [left + 0.5 - u, top + 0.5 - v],
            gradient: gradient(&patch.density, u, v),
            conic: [r * inverse, q * inverse * -2.0, p * inverse],
            coarseness,
            first: [left.to_array(), top.to_array()],
            width: greatest((right - left).to_array()),
            height: greatest((bottom - top).to_array()),
        }
    }
}

/// Relative change of the solid angle at these places.
#[inline(always)]
fn gradient<S: Simd>(density: &Density, u: f32x8<S>, v: f32x8<S>) -> [f32x8<S>; 2] {
    let (u, v) = (u - density.at[0], v - density.at[1]);
    let [xx, xy, yy] = density.bend;
    [u * xx + v * xy + density.gradient[0], u * xy + v * yy + density.gradient[1]]
}

/// A quantity in the row that lies this part of the way down the patch.
#[inline(always)]
fn row_of<S: Simd>(simd: S, columns: &Columns, down: f32) -> f32x8<S> {
    let (top, rise) = (f32x8::load_array(simd, columns.top), f32x8::load_array(simd, columns.rise));
    top + rise * down + f32x8::load_array(simd, columns.bow) * (down * (1.0 - down))
}

/// How far across the patch each lane is.
#[inline(always)]
fn ramp<S: Simd>(simd: S) -> f32x8<S> {
    f32x8::load_array(simd, std::array::from_fn(|lane| lane as f32 / SIDE as f32))
}

/// How many texels there are from the first to the last, in the lane that has most.
fn greatest(extents: [f32; SIDE]) -> usize {
    extents.into_iter().fold(0f32, f32::max) as usize + 1
}
