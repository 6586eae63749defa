//! Ellipses of many pixels at once.

use fearless_simd::{Simd, f32x8, i32x8, prelude::*};

use crate::filter::Kernel;
use crate::filter::ewa::lanes::Lanes;
use crate::render::scan::patch::{Density, Geometry, Patch};
use crate::render::scan::patch_interpolation::{Columns, Coons};
use crate::render::scan::tile::SIDE;

/// Places of windows of texels, and the ellipses in them, with a lane for each pixel.
#[derive(Clone, Copy)]
pub(crate) struct Ellipses<V> {
    /// Offset of the first texel's centre from the pixel's, along U and V.
    pub(crate) start: [V; 2],
    /// Coefficients A, B and C.
    conic: [V; 3],
    /// Relative change of the texels' solid angle along U and V.
    gradient: [V; 2],
    /// Share of the coarse cubic.
    pub(crate) coarseness: V,
    /// Columns and rows from the patch's origin to the first texel, and from there to the last.
    first: [V; 2],
    extent: [V; 2],
}

/// Texels of one row: the part of their ellipses that is constant along it.
pub(crate) struct EllipsesRow<V> {
    a: V,
    by: V,
    cyy: V,
    gradient: V,
    solid_angle: V,
}

impl<V> EllipsesRow<V> {
    /// Computes Q/F at U = `x`, where Q = AU² + BUV + CV² (Greene & Heckbert 1986).
    #[inline(always)]
    pub(crate) fn distance_squared<S: Simd>(&self, x: V) -> V
    where
        V: Lanes<S>,
    {
        ((self.a * x + self.by) * x + self.cyy).max(V::splat(x.token(), 0.0))
    }

    /// Returns the solid angle of a texel, relative to that at the pixel's centre.
    #[inline(always)]
    pub(crate) fn solid_angle<S: Simd>(&self, x: V) -> V
    where
        V: Lanes<S>,
    {
        self.gradient * x + self.solid_angle
    }
}

impl<V> Ellipses<V> {
    /// Computes the ellipses of a patch's pixels, from this row on.
    #[inline(always)]
    pub(crate) fn new<S: Simd>(simd: S, kernel: &Kernel, patch: &Patch, row: usize) -> Self
    where
        V: Lanes<S>,
    {
        let [u, v] = places::<S, V>(simd, patch, row);
        let [ux, vx, uy, vy] = derivatives::<S, V>(simd, patch, row);
        let determinant = ux * vy - uy * vx;
        let zero = V::splat(simd, 0.0);
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
        let tiny = V::splat(simd, 1e-30);
        // Rounding may make a circle's minor axis longer than its major one. Then the sign of their difference would
        // change.
        let minor = ((determinant * area) * (determinant * area) / major.max(tiny)).min(major);
        let floor = V::splat(simd, (kernel.floor * kernel.floor) as f32);
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
            first: [left, top],
            extent: [right - left, bottom - top],
        }
    }

    /// Returns the columns and rows from the patch's origin to the first texels of a row's windows.
    #[inline(always)]
    pub(crate) fn first<S: Simd>(&self, row: usize) -> [[i32; SIDE]; 2]
    where
        V: Lanes<S>,
    {
        let [column, row] = [self.first[0].row(row), self.first[1].row(row)];
        [column.to_int_precise::<i32x8<S>>().to_array(), row.to_int_precise::<i32x8<S>>().to_array()]
    }

    /// Returns the width and the height of a row's windows.
    #[inline(always)]
    pub(crate) fn size<S: Simd>(&self, row: usize) -> [usize; 2]
    where
        V: Lanes<S>,
    {
        [greatest(self.extent[0].row(row).to_array()), greatest(self.extent[1].row(row).to_array())]
    }

    /// Returns the row of texels at V = `y`.
    #[inline(always)]
    pub(crate) fn texels_at<S: Simd>(&self, y: V) -> EllipsesRow<V>
    where
        V: Lanes<S>,
    {
        let ([a, b, c], [across, down]) = (self.conic, self.gradient);
        EllipsesRow { a, by: b * y, cyy: c * y * y, gradient: across, solid_angle: down * y + 1.0 }
    }
}

/// Computes the relative change of the solid angle at these places.
#[inline(always)]
fn gradient<S: Simd, V: Lanes<S>>(density: &Density, u: V, v: V) -> [V; 2] {
    let (u, v) = (u - density.at[0], v - density.at[1]);
    let [xx, xy, yy] = density.bend;
    [u * xx + v * xy + density.gradient[0], u * xy + v * yy + density.gradient[1]]
}

/// Returns U and V of the pixels in rows of the patch, from this one on.
#[inline(always)]
fn places<S: Simd, V: Lanes<S>>(simd: S, patch: &Patch, row: usize) -> [V; 2] {
    match &patch.geometry {
        Geometry::Interpolated(coons) => {
            let ([u, v], [u_bulge, v_bulge]) =
                (&coons.place, [bulges::<S, V>(simd, coons, row, 0), bulges::<S, V>(simd, coons, row, 1)]);
            [rows_of::<S, V>(simd, u, row) + u_bulge, rows_of::<S, V>(simd, v, row) + v_bulge]
        }
        Geometry::Exact(exact) => {
            let [u, v] = &exact.place;
            [known::<S, V>(simd, u, row), known::<S, V>(simd, v, row)]
        }
    }
}

/// Returns Ux, Vx, Uy and Vy in rows of the patch, from this one on.
#[inline(always)]
fn derivatives<S: Simd, V: Lanes<S>>(simd: S, patch: &Patch, row: usize) -> [V; 4] {
    match &patch.geometry {
        Geometry::Interpolated(Coons { jacobian: [ux, vx, uy, vy], .. }) => {
            [rows_of(simd, ux, row), rows_of(simd, vx, row), rows_of(simd, uy, row), rows_of(simd, vy, row)]
        }
        Geometry::Exact(exact) => {
            let [ux, vx, uy, vy] = &exact.jacobian;
            [known(simd, ux, row), known(simd, vx, row), known(simd, uy, row), known(simd, vy, row)]
        }
    }
}

/// Loads the values of each pixel in rows from this one on; the last row is repeated.
#[inline(always)]
fn known<S: Simd, V: Lanes<S>>(simd: S, rows: &[[f32; SIDE]; SIDE], row: usize) -> V {
    V::of_rows([f32x8::load_array(simd, rows[row]), f32x8::load_array(simd, rows[(row + 1).min(SIDE - 1)])])
}

/// Interpolates a quantity in rows of the patch, from this one on.
#[inline(always)]
fn rows_of<S: Simd, V: Lanes<S>>(simd: S, columns: &Columns, row: usize) -> V {
    V::of_rows([row_of(simd, columns, row), row_of(simd, columns, row + 1)])
}

#[inline(always)]
fn row_of<S: Simd>(simd: S, columns: &Columns, row: usize) -> f32x8<S> {
    let down = row as f32 / SIDE as f32;
    let (top, rise) = (f32x8::load_array(simd, columns.top), f32x8::load_array(simd, columns.rise));
    top + rise * down + f32x8::load_array(simd, columns.bow) * (down * (1.0 - down))
}

/// Returns the part of places that bulging sides of the patch add, in rows from this one on, along one axis.
#[inline(always)]
fn bulges<S: Simd, V: Lanes<S>>(simd: S, coons: &Coons, row: usize, axis: usize) -> V {
    V::of_rows([bulge(simd, coons, row, axis), bulge(simd, coons, row + 1, axis)])
}

#[inline(always)]
fn bulge<S: Simd>(simd: S, coons: &Coons, row: usize, axis: usize) -> f32x8<S> {
    let [left, right] = coons.bulge(row);
    ramp(simd) * (right[axis] - left[axis]) + left[axis]
}

/// Returns the position of each lane across the patch, from 0 to 1.
#[inline(always)]
fn ramp<S: Simd>(simd: S) -> f32x8<S> {
    f32x8::load_array(simd, std::array::from_fn(|lane| lane as f32 / SIDE as f32))
}

/// Returns the number of texels from the first to the last, in the lane that has the most.
fn greatest(extents: [f32; SIDE]) -> usize {
    extents.into_iter().fold(0f32, f32::max) as usize + 1
}
