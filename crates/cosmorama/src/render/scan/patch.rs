//! Geometry of many pixels, mostly interpolated from a few.

use super::tile::{HALF, SIDE, lanes_of};
use crate::filter::gather::clearance::{Clearance, Grid};
use glam::{DMat2, DVec2};

use super::lattice::{Lattice, Point};
use super::patch_interpolation::{Coons, largest};
use crate::camera::{PixelPoint, View};
use crate::filter::Kernel;
use crate::filter::gather::Gather;
use crate::filter::gather::curvature::Bend;
use crate::filter::semi_axes;
use crate::render::scan::tile::LARGEST;
use crate::world::Source;

/// Greatest relative error, at a kernel's edge, of taking the texels' solid angle as linear within the kernel.
const CURVATURE: f64 = 1.0 / 256.0;

/// [`SIDE`] × [`SIDE`] pixels of a target as one view sees them: the place of each among its texels, and its footprint.
/// Near the edge of a field of view, only some pixels are made by patch.
#[derive(Clone, Debug)]
pub(crate) struct Patch<'a> {
    /// Index of the view in the world.
    pub(crate) view: usize,
    pub(crate) source: &'a Source,
    /// Texel from which places are counted, so that near ones keep their digits in single precision.
    pub(crate) origin: [i64; 2],
    pub(crate) geometry: Geometry,
    pub(crate) density: Density,
    /// Second-order terms of the places of texels around the patch's middle.
    pub(crate) bend: Bend,
    clearance: Clearance,
}

/// Places and derivatives of a patch's pixels; places are counted from the patch's origin.
#[derive(Clone, Debug)]
#[allow(
    clippy::large_enum_variant,
    reason = "nearly all patches are of the large kind, and should take no memory of their own"
)]
pub(crate) enum Geometry {
    Interpolated(Coons),
    /// Computed for each pixel, where the mapping bends too much between a few. In a picture of few pixels each holds
    /// many texels, and weighing them together saves more than this costs. How texels lie around each pixel is still
    /// taken from the middle.
    Exact(Box<Exact>),
}

/// Exact places and derivatives, by row and by lane.
#[derive(Clone, Debug)]
pub(crate) struct Exact {
    /// Coordinates U and V.
    pub(crate) place: [[[f32; SIDE]; SIDE]; 2],
    /// Derivatives Ux, Vx, Uy, Vy: texels for one pixel to the right and one pixel down.
    pub(crate) jacobian: [[[f32; SIDE]; SIDE]; 4],
}

/// Relative change of the texels' solid angle over a patch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Density {
    /// Point to which the gradient belongs, in texels from the origin.
    pub(crate) at: [f32; 2],
    /// Change for one texel along U and V.
    pub(crate) gradient: [f32; 2],
    /// Change of the gradient for one texel: of its U part along U, of either part along the other axis, of its V part
    /// along V.
    pub(crate) bend: [f32; 3],
}

impl<'a> Patch<'a> {
    /// Makes the patch whose top left pixel is in column `i` of row `j`. `None` where its pixels are better computed
    /// one by one: where views meet, near a singularity, or where derivatives change much.
    pub(crate) fn new(gather: &Gather<'a>, lattice: &mut Lattice, [i, j]: [usize; 2]) -> Option<Self> {
        let middle = lattice.footprint([i + HALF, j + HALF])?;
        let (view, _) = gather.world().owner(middle.direction)?;
        let source = &gather.world().sources()[view];
        let mut screen = [[middle; 3]; 3];
        let mut points = Grid::<Point>::default();
        for (y, (screen, points)) in screen.iter_mut().zip(&mut points).enumerate() {
            for (x, (screen, point)) in screen.iter_mut().zip(points).enumerate() {
                let (footprint, seen) = lattice.point([i + x * HALF, j + y * HALF], (view, source))?;
                // Beside a steep rim, pixels are not measured by derivatives.
                if lattice.target().is_steep_at(&footprint) {
                    return None;
                }
                (*screen, *point) = (footprint, seen?);
            }
        }
        let clearance = gather.clearance(source, &screen)?;
        let density = Density::around(&source.view, &points, gather.kernel())?;
        let middle = points[1][1].place;
        let bend = Bend::around(&source.view, PixelPoint::new(middle.x, middle.y))?;
        let origin = points[0][0].place.floor();
        let geometry = match Coons::through(&points, origin) {
            Some(coons) => Geometry::Interpolated(coons),
            None if is_held(&points[1][1], gather.kernel()) => {
                Geometry::Exact(Exact::of((&*lattice, [i, j]), source, (origin, points[1][1].jacobian))?.into())
            }
            None => return None,
        };
        let origin = [origin.x as i64, origin.y as i64];
        Some(Self { view, source, origin, geometry, density, bend, clearance })
    }

    /// Returns which pixels of a row are made by the patch, a bit for each: those that are away from the edge of the
    /// field of view.
    pub(crate) fn lanes(&self, gather: &Gather, target: &View, [i, j]: [usize; 2]) -> u8 {
        let Clearance::Within(reach) = self.clearance else { return u8::MAX };
        lanes_of(|lane| {
            let direction = target.direction(PixelPoint::centre(i + lane, j));
            direction.is_some_and(|direction| !gather.is_near_edge(direction, reach))
        })
    }
}

/// Largest relative change of derivatives across a patch.
///
/// Below it, curvature and edge distance measured at the centre hold for the whole patch.
const CHANGE: f64 = 0.25;

/// Returns whether windows may hold what a kernel reaches around this point.
fn is_held(point: &Point, kernel: &Kernel) -> bool {
    let [_, minor] = semi_axes(point.jacobian);
    (2.0 * kernel.radius() * kernel.scale * minor).powi(2) < LARGEST as f64
}

impl Exact {
    /// Measures every pixel of the patch with this top left pixel in a view, given the derivatives in the patch's
    /// middle.
    ///
    /// `None` where the view does not show all of the patch, beside a steep rim, or where derivatives change much.
    fn of(
        (lattice, [i, j]): (&Lattice, [usize; 2]),
        source: &Source,
        (origin, middle): (DVec2, DMat2),
    ) -> Option<Self> {
        let target = lattice.target();
        let bound = CHANGE * largest(middle);
        let mut exact = Self { place: [[[0.0; SIDE]; SIDE]; 2], jacobian: [[[0.0; SIDE]; SIDE]; 4] };
        for row in 0..SIDE {
            for lane in 0..SIDE {
                let footprint = target.footprint(PixelPoint::centre(i + lane, j + row))?;
                if target.is_steep_at(&footprint) {
                    return None;
                }
                let Point { place: at, jacobian, .. } = lattice.measure(source, &footprint)?;
                if !(jacobian.is_finite() && at.x.is_finite() && at.y.is_finite() && largest(jacobian - middle) < bound)
                {
                    return None;
                }
                for (into, value) in exact.place.iter_mut().zip([at.x - origin.x, at.y - origin.y]) {
                    into[row][lane] = value as f32;
                }
                for (into, value) in exact.jacobian.iter_mut().zip(jacobian.to_cols_array()) {
                    into[row][lane] = value as f32;
                }
            }
        }
        Some(exact)
    }
}

impl Density {
    /// Measures the density of a view's texels around the middle of a patch; `None` where it bends within a kernel.
    fn around(view: &View, points: &Grid<Point>, kernel: &Kernel) -> Option<Self> {
        let size = |point: &Point| {
            let [x, y] = [point.jacobian.x_axis, point.jacobian.y_axis];
            (x.length_squared() + y.length_squared()).sqrt()
        };
        let widest = points.iter().flatten().map(size).fold(0.0, f64::max);
        let radius = kernel.radius() * (kernel.scale * widest).max(kernel.floor);
        let (origin, at) = (points[0][0].place.floor(), points[1][1].place);
        let solid_angle = |u: f64, v: f64| view.solid_angle(PixelPoint::new(at.x + u, at.y + v));
        let here = solid_angle(0.0, 0.0).filter(|here| *here > 0.0)?;
        let [left, right, above, below, diagonal] =
            [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0), (1.0, 1.0)].map(|(u, v)| solid_angle(u, v));
        let [left, right, above, below, diagonal] =
            [left? / here, right? / here, above? / here, below? / here, diagonal? / here];
        let (x, y) = ((right - left) / 2.0, (below - above) / 2.0);
        let (xx, xy, yy) = (left + right - 2.0, diagonal - right - below + 1.0, above + below - 2.0);
        let at = at - origin;
        // No eigenvalue of the second derivatives is larger than this.
        let bend = xx.abs().max(yy.abs()) + xy.abs();
        (bend * radius * radius / 2.0 < CURVATURE).then(|| Self {
            at: [at.x as f32, at.y as f32],
            gradient: [x as f32, y as f32],
            // The gradient is relative to the solid angle, which changes too.
            bend: [xx - x * x, xy - x * y, yy - y * y].map(|bend| bend as f32),
        })
    }
}
