//! Average of a footprint without a list of taps: eight texels of a row at once.

use fearless_simd::{Level, Simd, dispatch, f32x8, prelude::*};
use glam::DVec2;

use super::blocks::{Blocks, LANES, LaneKernel, Weighed, count_up};
use super::cubic::Cubics;
use super::lanes::Falloff;
use super::pinhole::Pinholes;
use super::rows::{Conic, Lattice, Rows};
use crate::camera::Footprint;
use crate::filter::Kernel;
use crate::filter::gather::curvature::Bend;
use crate::filter::gather::{EllipseOfTexels, ellipse_of_texels};
use crate::raster::Rgba;
use crate::world::{Source, World};

/// Average of footprints by a kernel of two cubics.
pub(crate) struct Direct {
    kernel: LaneKernel,
    level: Level,
}

impl Direct {
    /// Prepares the average for a kernel. Returns `None` if a cross-section is not a cubic, or if there might be no texels
    /// under a footprint that its kind of average needs.
    pub(crate) fn new(kernel: &Kernel, anti_ringing: bool) -> Option<Self> {
        let kernel = LaneKernel { kernel: *kernel, cubics: Cubics::of(kernel)?, anti_ringing };
        kernel.always_averages().then(|| Self { kernel, level: Level::new() })
    }

    /// Averages a footprint. `view` is the index of the view that shows its centre, if the caller knows it. Returns
    /// `None` if the footprint's texels must be listed one by one.
    pub(crate) fn average(
        &self,
        (world, pinholes): (&World, Option<&Pinholes>),
        light: &[Rgba],
        footprint: &Footprint,
        view: Option<usize>,
    ) -> Option<Rgba> {
        let level = self.level;
        if let Some(pinholes) = pinholes {
            return dispatch!(level, simd => pinholes.average(simd, &self.kernel, light, footprint, view));
        }
        let source = match view {
            Some(view) => &world.sources()[view],
            None => world.sources().iter().find(|source| holds(source, footprint))?,
        };
        let ellipse = ellipse_of_texels(&self.kernel.kernel, source, footprint)?;
        dispatch!(level, simd => in_view(simd, &self.kernel, source, light, &ellipse))
    }
}

/// Averages an ellipse of texels.
#[inline(always)]
fn in_view<S: Simd>(
    simd: S,
    kernel: &LaneKernel,
    source: &Source,
    light: &[Rgba],
    texels: &EllipseOfTexels,
) -> Option<Rgba> {
    let LaneKernel { kernel, cubics, anti_ringing } = kernel;
    let EllipseOfTexels { centre, jacobian, ellipse } = texels;
    let bend = Bend::in_closed_form(&source.view, *centre).or_else(|| Bend::around(&source.view, *centre))?;
    let reach = kernel.radius().powi(2);
    let conic = Conic { uu: ellipse.a, uv: ellipse.b, vv: ellipse.c, u: 0.0, v: 0.0, one: -reach };
    let size = [source.view.width(), source.view.height()];
    let mut rows = Rows::default();
    rows.cut(simd, &conic, &Lattice::around([centre.x, centre.y], size))?;
    let coarseness = kernel.coarseness(jacobian.determinant().abs().sqrt());
    let curve = cubics.blend(f32x8::splat(simd, coarseness as f32));
    let (inverse, bend) = (reach.recip() as f32, Bent::of(&bend));
    let [a, b, c] = [ellipse.a, ellipse.b, ellipse.c].map(|number| number as f32);
    let mut blocks = Blocks::default();
    for row in &rows.rows {
        let first = source.offset + row.row * size[0] + row.column;
        for start in (0..row.count).step_by(LANES) {
            let (u, v) = (count_up(simd) + (row.u + start as f32), row.v);
            let q = ((u * a + b * v) * u + c * v * v).max(f32x8::splat(simd, 0.0));
            let weighed = Weighed {
                q,
                weight: curve.weight(q),
                solid_angle: u * bend.growth[0] + (bend.growth[1] * v + 1.0),
                offset: [
                    (u * bend.uu[0] + (bend.uv[0] * v + 1.0)) * u + bend.vv[0] * v * v,
                    (u * bend.uu[1] + bend.uv[1] * v) * u + (bend.vv[1] * v + 1.0) * v,
                ],
            };
            blocks.push(simd, (first + start, (row.count - start).min(LANES)), weighed, inverse)?;
        }
    }
    Some(blocks.average(simd, light, kernel.centred, *anti_ringing))
}

/// Returns whether the middle of a footprint lies in the part of a source that no other view shares.
fn holds(source: &Source, footprint: &Footprint) -> bool {
    let rect = source.whole;
    source.view.pixel(footprint.direction).is_some_and(|pixel| {
        (rect.left as f64..rect.right as f64).contains(&pixel.x)
            && (rect.top as f64..rect.bottom as f64).contains(&pixel.y)
    })
}

/// Second-order terms of texels' offsets on the sphere, in single precision.
struct Bent {
    uu: [f32; 2],
    uv: [f32; 2],
    vv: [f32; 2],
    /// Relative change of the texels' solid angle along U and V: the trace of the second-order terms.
    growth: [f32; 2],
}

impl Bent {
    fn of(bend: &Bend) -> Self {
        let single = |vector: DVec2| [vector.x as f32, vector.y as f32];
        let growth = DVec2::new(bend.uu.x + bend.uv.y, bend.uv.x + bend.vv.y);
        Self { uu: single(bend.uu * 0.5), uv: single(bend.uv), vv: single(bend.vv * 0.5), growth: single(growth) }
    }
}
