//! The ellipses of eight pixels at once.

use fearless_simd::{f32x8, prelude::*};

use super::Kernel;
use super::patch::{Columns, Density, Patch, SIDE};

/// Where windows of texels lie, and the ellipses in them: a lane for each.
pub(super) struct Ellipses<S: Simd> {
    /// Offset of the first texel's centre from the pixel's, along U and V.
    pub(super) start: [f32x8<S>; 2],
    /// A, B and C.
    conic: [f32x8<S>; 3],
    /// Relative change of the texels' solid angle along U and V.
    gradient: [f32x8<S>; 2],
    /// How much of the coarse cubic counts.
    pub(super) coarseness: f32x8<S>,
    /// Columns and rows from the patch's origin to the first texel.
    pub(super) first: [[f32; SIDE]; 2],
    pub(super) width: usize,
    pub(super) height: usize,
}

/// Texels of one row: what of their ellipses does not change along it.
pub(super) struct EllipsesRow<S: Simd> {
    a: f32x8<S>,
    by: f32x8<S>,
    cyy: f32x8<S>,
    gradient: f32x8<S>,
    solid_angle: f32x8<S>,
}

impl<S: Simd> EllipsesRow<S> {
    /// Q = AU² + BUV + CV² (Greene & Heckbert 1986), over F, at U = `x`.
    #[inline(always)]
    pub(super) fn distance_squared(&self, x: f32x8<S>) -> f32x8<S> {
        ((self.a * x + self.by) * x + self.cyy).max(f32x8::splat(x.simd, 0.0))
    }

    /// The solid angle of a texel, that at the pixel's centre being 1.
    #[inline(always)]
    pub(super) fn solid_angle(&self, x: f32x8<S>) -> f32x8<S> {
        self.gradient * x + self.solid_angle
    }
}

impl<S: Simd> Ellipses<S> {
    /// Those of a row of a patch.
    #[inline(always)]
    pub(super) fn new(simd: S, kernel: &Kernel, patch: &Patch, row: usize) -> Self {
        let down = row as f32 / SIDE as f32;
        let [left, right] = patch.bulge(row);
        let u = row_of(simd, &patch.place[0], down) + (ramp(simd) * (right[0] - left[0]) + left[0]);
        let v = row_of(simd, &patch.place[1], down) + (ramp(simd) * (right[1] - left[1]) + left[1]);
        let (ux, vx) = (row_of(simd, &patch.jacobian[0], down), row_of(simd, &patch.jacobian[1], down));
        let (uy, vy) = (row_of(simd, &patch.jacobian[2], down), row_of(simd, &patch.jacobian[3], down));
        let determinant = ux * vy - uy * vx;
        let zero = f32x8::splat(simd, 0.0);
        // As in `Kernel::coarseness`.
        let texels = determinant.abs().sqrt();
        let [before, after] = Kernel::SLOPES.map(|slope| slope as f32);
        let slowly = (texels - Kernel::COARSE as f32) * after + Kernel::KNEE as f32;
        let coarseness = ((texels - Kernel::FINE as f32) * before).min(slowly).max(zero).min(zero + 1.0);

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

    /// The row of texels at V = `y`.
    #[inline(always)]
    pub(super) fn row(&self, y: f32x8<S>) -> EllipsesRow<S> {
        let ([a, b, c], [across, down]) = (self.conic, self.gradient);
        EllipsesRow { a, by: b * y, cyy: c * y * y, gradient: across, solid_angle: down * y + 1.0 }
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
