//! Moments of many pixels' weights at once, and the correction of their centroids.

use fearless_simd::{Simd, prelude::*};

use crate::filter::ewa::lanes::Lanes;
use crate::filter::gather::curvature::Bend;
use crate::filter::gather::tap_weights::THINNEST;

/// Sums over a window of the weights w and the slacks v, and of their products with offsets. A texel's slack is the
/// factor on the correction of its weight.
pub(crate) struct Moments<V> {
    w: V,
    wx: V,
    wy: V,
    wxx: V,
    wxy: V,
    wyy: V,
    v: V,
    vx: V,
    vy: V,
    vxx: V,
    vxy: V,
    vyy: V,
}

/// Moments of weights over one row of a window, at a fixed vertical offset.
pub(crate) struct RowSums<V> {
    w: V,
    wx: V,
    wxx: V,
    v: V,
    vx: V,
    vxx: V,
}

impl<V> RowSums<V> {
    #[inline(always)]
    pub(crate) fn zero<S: Simd>(simd: S) -> Self
    where
        V: Lanes<S>,
    {
        let zero = V::splat(simd, 0.0);
        Self { w: zero, wx: zero, wxx: zero, v: zero, vx: zero, vxx: zero }
    }

    /// Adds a texel at this horizontal offset.
    #[inline(always)]
    pub(crate) fn add<S: Simd>(&mut self, w: V, v: V, x: V)
    where
        V: Lanes<S>,
    {
        let (wx, vx) = (w * x, v * x);
        self.w += w;
        self.wx += wx;
        self.wxx += wx * x;
        self.v += v;
        self.vx += vx;
        self.vxx += vx * x;
    }
}

impl<V> Moments<V> {
    #[inline(always)]
    pub(crate) fn zero<S: Simd>(simd: S) -> Self
    where
        V: Lanes<S>,
    {
        let zero = V::splat(simd, 0.0);
        Self {
            w: zero,
            wx: zero,
            wy: zero,
            wxx: zero,
            wxy: zero,
            wyy: zero,
            v: zero,
            vx: zero,
            vy: zero,
            vxx: zero,
            vxy: zero,
            vyy: zero,
        }
    }

    /// Adds a row at this vertical offset.
    #[inline(always)]
    pub(crate) fn add<S: Simd>(&mut self, row: &RowSums<V>, y: V)
    where
        V: Lanes<S>,
    {
        self.w += row.w;
        self.wx += row.wx;
        self.wy += row.w * y;
        self.wxx += row.wxx;
        self.wxy += row.wx * y;
        self.wyy += row.w * y * y;
        self.v += row.v;
        self.vx += row.vx;
        self.vy += row.v * y;
        self.vxx += row.vxx;
        self.vxy += row.vx * y;
        self.vyy += row.v * y * y;
    }

    /// Computes the correction that makes the weights' sum one. With `centring`, it also moves the weights' centroid
    /// onto the pixel's centre, as [`crate::filter::gather::tap_weights`] does; `centring` tells how the texels bend.
    ///
    /// Offsets in texels serve as well as offsets on the screen: the correction is linear in them.
    #[inline(always)]
    pub(crate) fn correction<S: Simd>(&self, simd: S, centring: Option<&Bend>) -> Correction<V>
    where
        V: Lanes<S>,
    {
        let zero = V::splat(simd, 0.0);
        let scale = (zero + 1.0) / self.w;
        let (mean_x, mean_y) = (self.vx / self.v, self.vy / self.v);
        let xx = self.vxx - self.vx * mean_x;
        let xy = self.vxy - self.vx * mean_y;
        let yy = self.vyy - self.vy * mean_y;
        let determinant = xx * yy - xy * xy;
        let (factor, [wx, wy]) = match centring {
            Some(bend) => {
                let factor = determinant.simd_gt(xx * yy * THINNEST).select(scale / determinant, zero);
                (factor, self.first_moments(bend))
            }
            None => (zero, [zero; 2]),
        };
        let (gx, gy) = ((xy * wy - yy * wx) * factor, (xy * wx - xx * wy) * factor);
        Correction { scale, gx, gy, constant: zero - gx * mean_x - gy * mean_y }
    }

    /// Returns the first moments of the weights, with texels at the places where they appear on the sphere.
    #[inline(always)]
    fn first_moments<S: Simd>(&self, bend: &Bend) -> [V; 2]
    where
        V: Lanes<S>,
    {
        let [[uu_x, uu_y], [uv_x, uv_y], [vv_x, vv_y]] =
            [bend.uu * 0.5, bend.uv, bend.vv * 0.5].map(|bend| bend.as_vec2().to_array());
        [
            self.wx + self.wxx * uu_x + self.wxy * uv_x + self.wyy * vv_x,
            self.wy + self.wxx * uu_y + self.wxy * uv_y + self.wyy * vv_y,
        ]
    }
}

/// Coefficients of a texel's corrected weight, w·scale + v·(g·p + constant), where w is its weight, v its slack and p
/// its offset.
pub(crate) struct Correction<V> {
    scale: V,
    gx: V,
    gy: V,
    constant: V,
}

/// Coefficients of the correction along one row, at a fixed vertical offset.
pub(crate) struct RowCorrection<V> {
    scale: V,
    gx: V,
    constant: V,
}

impl<V> Correction<V> {
    /// Returns the correction in the row at this vertical offset.
    #[inline(always)]
    pub(crate) fn row<S: Simd>(&self, y: V) -> RowCorrection<V>
    where
        V: Lanes<S>,
    {
        RowCorrection { scale: self.scale, gx: self.gx, constant: self.gy * y + self.constant }
    }
}

impl<V> RowCorrection<V> {
    /// Returns the corrected weight of a texel at this horizontal offset.
    #[inline(always)]
    pub(crate) fn apply<S: Simd>(&self, w: V, v: V, x: V) -> V
    where
        V: Lanes<S>,
    {
        w * self.scale + v * (self.gx * x + self.constant)
    }
}
