//! The average of a footprint wholly inside one view, without a list of taps: eight texels of a row at once.

use fearless_simd::{Level, Simd, dispatch, f32x4, f32x8, prelude::*};
use glam::DVec2;

use super::cubic::{Cubics, Curve};
use crate::camera::{Footprint, View};
use crate::filter::Kernel;
use crate::filter::gather::curvature::Bend;
use crate::filter::gather::tap_weights::THINNEST;
use crate::filter::gather::texel_run::{ceil, floor};
use crate::filter::gather::{EllipseOfTexels, ellipse_of_texels};
use crate::filter::kernel::UNDER;
use crate::raster::Rgba;
use crate::world::{Source, World};

/// Averages footprints by kernels of two cubics.
pub(crate) struct Direct {
    kernel: Kernel,
    cubics: Cubics,
    anti_ringing: bool,
    level: Level,
}

impl Direct {
    /// `None` for a kernel that is not of cubics, or whose floor is under one, so that there could be no texel under a footprint.
    pub(crate) fn new(kernel: &Kernel, anti_ringing: bool) -> Option<Self> {
        let cubics = Cubics::of(kernel).filter(|_| kernel.floor >= 1.0)?;
        Some(Self { kernel: *kernel, cubics, anti_ringing, level: Level::new() })
    }

    /// The average of a footprint; `None` where its texels do not all lie in one view, evenly: there they are listed one by one.
    pub(crate) fn average(
        &self,
        world: &World,
        light: &[Rgba],
        footprint: &Footprint,
        view: Option<usize>,
    ) -> Option<Rgba> {
        let sources = world.sources();
        let source = match view {
            Some(view) => &sources[view],
            None => sources.iter().find(|source| holds(source, footprint))?,
        };
        let ellipse = ellipse_of_texels(&self.kernel, source, footprint)?;
        let weights = self.weights(&source.view, &ellipse)?;
        let light = &light[source.texels()];
        let rows = Rows::of(&ellipse, source.view.width())?;
        let level = self.level;
        Some(dispatch!(level, simd => self.sum(simd, light, rows.each(), &weights)))
    }

    /// What weighs the texels of an ellipse; `None` where it is not known how they lie around its middle.
    fn weights(&self, view: &View, ellipse: &EllipseOfTexels) -> Option<Weights> {
        let bend = Bend::in_closed_form(view, ellipse.centre).or_else(|| Bend::around(view, ellipse.centre))?;
        let gradient = [bend.uu.x + bend.uv.y, bend.uv.x + bend.vv.y].map(|change| change as f32);
        let bend = self.kernel.centred.then_some(bend);
        let coarseness = self.kernel.coarseness(ellipse.jacobian.determinant().abs().sqrt()) as f32;
        let conic = [ellipse.ellipse.a, ellipse.ellipse.b, ellipse.ellipse.c].map(|number| number as f32);
        Some(Weights { conic, gradient, bend, coarseness })
    }

    #[inline(always)]
    fn sum<S: Simd>(&self, simd: S, light: &[Rgba], rows: &[Row], weights: &Weights) -> Rgba {
        let curve = self.cubics.blend(f32x8::splat(simd, weights.coarseness));
        let lanes = LaneWeights { curve, inverse: (self.kernel.radius().powi(2) as f32).recip(), weights };
        let correction = lanes.moments(simd, rows).correction(weights.bend.as_ref());
        let (nothing, far) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, f32::INFINITY));
        let mut sum = f32x4::splat(simd, 0.0);
        let (mut least, mut greatest) = (f32x4::splat(simd, f32::INFINITY), f32x4::splat(simd, f32::NEG_INFINITY));
        for row in rows {
            let at = correction.row(row.v);
            for (block, texels) in light[row.first..row.first + row.count].chunks(f32x8::<S>::LEN).enumerate() {
                let x = lanes_from(simd, row.u + (block * f32x8::<S>::LEN) as f32);
                let (w, v, q) = lanes.of(simd, x, row.v);
                let weight = (w * at.scale + v * (x * at.gx + at.constant)).to_array();
                // What is not under the footprint bounds nothing: it is moved out of the way, without a branch for each.
                let aside = q.simd_lt(f32x8::splat(simd, UNDER as f32)).select(nothing, far).to_array();
                for ((texel, weight), aside) in texels.iter().zip(weight).zip(aside) {
                    let texel = f32x4::load_array_ref(simd, &texel.0);
                    sum += texel * weight;
                    (least, greatest) = (least.min(texel + aside), greatest.max(texel - aside));
                }
            }
        }
        let held = if self.anti_ringing { sum.max(least).min(greatest) } else { sum };
        Rgba(held.to_array())
    }
}

/// Whether a footprint's middle lies among the texels of a source that count whole.
fn holds(source: &Source, footprint: &Footprint) -> bool {
    let rect = source.whole;
    source.view.pixel(footprint.direction).is_some_and(|pixel| {
        (rect.left as f64..rect.right as f64).contains(&pixel.x)
            && (rect.top as f64..rect.bottom as f64).contains(&pixel.y)
    })
}

/// Rows of texels under a kernel, at most; of more, they are listed one by one.
const MOST_ROWS: usize = 64;

/// The rows of texels under a kernel.
struct Rows {
    rows: [Row; MOST_ROWS],
    count: usize,
}

/// One of them.
#[derive(Clone, Copy, Default)]
struct Row {
    /// Index of its first texel in the view, and how many there are.
    first: usize,
    count: usize,
    /// Offset of the first one's centre from the footprint's.
    u: f32,
    v: f32,
}

impl Rows {
    /// Cuts an ellipse in a view of so many columns into rows; `None` if it has too many.
    fn of(ellipse: &EllipseOfTexels, columns: usize) -> Option<Self> {
        let EllipseOfTexels { centre, bounds, rows, .. } = ellipse;
        if bounds.bottom - bounds.top >= MOST_ROWS as i64 {
            return None;
        }
        let mut found = Self { rows: [Row::default(); MOST_ROWS], count: 0 };
        for j in bounds.top..=bounds.bottom {
            let v = j as f64 + 0.5 - centre.y;
            let Some((least, greatest)) = rows.range(v) else { continue };
            let left = ceil(centre.x + least - 0.5).max(bounds.left);
            let right = floor(centre.x + greatest - 0.5).min(bounds.right);
            if left <= right {
                let first = j as usize * columns + left as usize;
                let u = left as f64 + 0.5 - centre.x;
                found.rows[found.count] = Row { first, count: (right + 1 - left) as usize, u: u as f32, v: v as f32 };
                found.count += 1;
            }
        }
        Some(found)
    }

    fn each(&self) -> &[Row] {
        &self.rows[..self.count]
    }
}

/// What weighs texels by their offset.
struct Weights {
    /// A, B and C.
    conic: [f32; 3],
    /// Relative change of the texels' solid angle along U and V: the trace of how they bend.
    gradient: [f32; 2],
    /// How texels lie around, if the weights are to be centred.
    bend: Option<Bend>,
    /// How much of the coarse cubic counts.
    coarseness: f32,
}

struct LaneWeights<'a, V> {
    curve: Curve<V>,
    /// One over the kernel's radius².
    inverse: f32,
    weights: &'a Weights,
}

/// Offsets across of texels beside each other.
#[inline(always)]
fn lanes_from<S: Simd>(simd: S, first: f32) -> f32x8<S> {
    f32x8::simd_from(simd, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]) + first
}

impl<S: Simd> LaneWeights<'_, f32x8<S>> {
    /// Weights and slacks of texels in one row, and the squares of their distances: zero beyond the kernel.
    #[inline(always)]
    fn of(&self, simd: S, x: f32x8<S>, y: f32) -> (f32x8<S>, f32x8<S>, f32x8<S>) {
        let ([a, b, c], [across, down]) = (self.weights.conic, self.weights.gradient);
        let zero = f32x8::splat(simd, 0.0);
        let q = ((x * a + b * y) * x + c * y * y).max(zero);
        let solid_angle = x * across + (down * y + 1.0);
        let falloff = (zero + 1.0 - q * self.inverse).max(zero);
        (self.curve.weight(q) * solid_angle, falloff * falloff * solid_angle, q)
    }

    /// The moments of all texels.
    #[inline(always)]
    fn moments(&self, simd: S, rows: &[Row]) -> Moments {
        let zero = f32x8::splat(simd, 0.0);
        let mut sums = [zero; 12];
        for row in rows {
            let mut line = [zero; 6];
            for first in (0..row.count).step_by(f32x8::<S>::LEN) {
                let x = lanes_from(simd, row.u + first as f32);
                let (w, v, _) = self.of(simd, x, row.v);
                let (wx, vx) = (w * x, v * x);
                for (sum, term) in line.iter_mut().zip([w, wx, wx * x, v, vx, vx * x]) {
                    *sum += term;
                }
            }
            let y = row.v;
            let [w, wx, wxx, v, vx, vxx] = line;
            let terms = [w, wx, w * y, wxx, wx * y, w * (y * y), v, vx, v * y, vxx, vx * y, v * (y * y)];
            for (sum, term) in sums.iter_mut().zip(terms) {
                *sum += term;
            }
        }
        Moments(sums.map(|sum| f64::from(sum.to_array().iter().sum::<f32>())))
    }
}

/// Sums over the texels: of w, wx, wy, wxx, wxy, wyy, and the same of v.
struct Moments([f64; 12]);

/// What becomes of the weights: w·scale + v·(g·p + constant).
struct Correction {
    scale: f64,
    gradient: DVec2,
    constant: f64,
}

/// A correction in one row.
struct RowCorrection {
    scale: f32,
    gx: f32,
    constant: f32,
}

impl Moments {
    /// What makes the weights' sum one, and with `bend` moves their centroid to the footprint's middle (see
    /// [`crate::filter::gather::tap_weights`]).
    fn correction(&self, bend: Option<&Bend>) -> Correction {
        let [w, wx, wy, wxx, wxy, wyy, v, vx, vy, vxx, vxy, vyy] = self.0;
        let scale = w.recip();
        let mean = DVec2::new(vx, vy) / v;
        let (xx, xy, yy) = (vxx - vx * mean.x, vxy - vx * mean.y, vyy - vy * mean.y);
        let determinant = xx * yy - xy * xy;
        let gradient = match bend {
            Some(bend) if determinant > f64::from(THINNEST) * xx * yy => {
                let p = DVec2::new(wx, wy) + bend.uu * (0.5 * wxx) + bend.uv * wxy + bend.vv * (0.5 * wyy);
                DVec2::new(xy * p.y - yy * p.x, xy * p.x - xx * p.y) * (scale / determinant)
            }
            _ => DVec2::ZERO,
        };
        Correction { scale, gradient, constant: -gradient.dot(mean) }
    }
}

impl Correction {
    fn row(&self, y: f32) -> RowCorrection {
        let constant = self.gradient.y * f64::from(y) + self.constant;
        RowCorrection { scale: self.scale as f32, gx: self.gradient.x as f32, constant: constant as f32 }
    }
}
