//! Rows of texels that a kernel reaches, where it is a conic in a view's plane.

use arrayvec::ArrayVec;
use fearless_simd::{Simd, f32x8, prelude::*};

use super::blocks::{LANES, count_up};

/// Inside of a conic: P(u, v) < 0, where P = uu·u² + uv·uv + vv·v² + u·u + v·v + one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Conic {
    pub(crate) uu: f64,
    pub(crate) uv: f64,
    pub(crate) vv: f64,
    pub(crate) u: f64,
    pub(crate) v: f64,
    pub(crate) one: f64,
}

/// Columns and rows of a view around a point of its plane, from which u and v are measured.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lattice {
    /// Texel that holds the point.
    pub(crate) texel: [i32; 2],
    /// Offset of that texel's centre from the point.
    pub(crate) centre: [f32; 2],
    /// Number of columns and rows.
    pub(crate) size: [i32; 2],
}

/// Texels of a row inside a conic.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    pub(crate) row: usize,
    pub(crate) column: usize,
    pub(crate) count: usize,
    /// Offset of the first texel's centre.
    pub(crate) u: f32,
    pub(crate) v: f32,
}

/// Greatest number of rows; a conic with more is not cut.
const MOST: usize = 256;

/// Rows of texels inside a conic, from top to bottom.
#[derive(Default)]
pub(crate) struct Rows {
    pub(crate) rows: ArrayVec<Row, MOST>,
    /// Whether the conic continues outside the view.
    pub(crate) is_cut: bool,
}

impl Conic {
    /// Returns the least and greatest v inside the conic; infinite if the conic is unbounded.
    fn range(&self) -> [f64; 2] {
        // A row meets the conic if the discriminant of P in u is not negative. That discriminant is quadratic in v.
        let Self { uu, uv, vv, u, v, one } = *self;
        let [square, linear, constant] =
            [uv * uv - 4.0 * uu * vv, 2.0 * (uv * u - 2.0 * uu * v), u * u - 4.0 * uu * one];
        if uu <= 0.0 || square >= 0.0 {
            return [f64::NEG_INFINITY, f64::INFINITY];
        }
        let (middle, inside) = (-0.5 * linear / square, linear * linear - 4.0 * square * constant);
        let half = if inside < 0.0 { -1.0 } else { -0.5 * inside.sqrt() / square };
        [middle - half, middle + half]
    }
}

impl Rows {
    /// Cuts a conic into rows; `None` if there are more than [`MOST`].
    #[inline(always)]
    pub(crate) fn cut<S: Simd>(&mut self, simd: S, conic: &Conic, lattice: &Lattice) -> Option<()> {
        let Lattice { texel: [column, row], centre, size: [width, height] } = *lattice;
        let [top, bottom] = conic.range();
        let [top, bottom] =
            [(top - f64::from(centre[1])).ceil() as i32, (bottom - f64::from(centre[1])).floor() as i32];
        let [first, last] = [top.max(-row), bottom.min(height - 1 - row)];
        self.is_cut = first != top || last != bottom;
        if last - first >= MOST as i32 {
            return None;
        }
        let is_open = conic.uu <= 0.0;
        let splat = |number: f64| f32x8::splat(simd, number as f32);
        let (uu, uv, vv) = (splat(conic.uu), splat(conic.uv), splat(conic.vv));
        let (u, v, one) = (splat(conic.u), splat(conic.v), splat(conic.one));
        let inverse = splat(0.5 / conic.uu);
        let (left, right) = (f32x8::splat(simd, -column as f32), f32x8::splat(simd, (width - 1 - column) as f32));
        for group in (first..=last).step_by(LANES) {
            let at = count_up(simd) + (group as f32 + centre[1]);
            let (b, c) = (uv * at + u, (vv * at + v) * at + one);
            let inside = b * b - uu * c * 4.0;
            let half = inside.max(f32x8::splat(simd, 0.0)).sqrt() * inverse;
            let middle = f32x8::splat(simd, -centre[0]) - b * inverse;
            let (mut from, mut to) = ((middle - half).ceil(), (middle + half).floor());
            if is_open {
                (from, to) = (left, right);
            }
            let is_cut = from.simd_lt(left) | to.simd_gt(right);
            let meets = inside.simd_ge(f32x8::splat(simd, 0.0)).to_bitmask() & ((1 << (last - group + 1).min(8)) - 1);
            let meets = if is_open { (1 << (last - group + 1).min(8)) - 1 } else { meets };
            self.is_cut |= is_open || is_cut.to_bitmask() & meets != 0;
            let (from, to) = (from.max(left), to.min(right));
            let counts = (to - from + 1.0).to_array();
            for (lane, (from, count)) in from.to_array().into_iter().zip(counts).enumerate() {
                if meets >> lane & 1 == 1 && count > 0.0 {
                    let row = Row {
                        row: (row + group) as usize + lane,
                        column: (column + from as i32) as usize,
                        count: count as usize,
                        u: from + centre[0],
                        v: (group + lane as i32) as f32 + centre[1],
                    };
                    self.rows.try_push(row).ok()?;
                }
            }
        }
        Some(())
    }
}

impl Lattice {
    /// Returns the columns and rows of a view of this size, around a point of its image.
    #[inline(always)]
    pub(crate) fn around([x, y]: [f64; 2], [width, height]: [usize; 2]) -> Self {
        let [column, row] = [x.floor(), y.floor()];
        let centre = [(column + 0.5 - x) as f32, (row + 0.5 - y) as f32];
        Self { texel: [column as i32, row as i32], centre, size: [width as i32, height as i32] }
    }
}
