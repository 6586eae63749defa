//! EWA across views: a footprint that crosses from one view into another gathers from both.
//!
//! Each view tests only texels that it owns, in its own plane, with its own ellipse; each weight is multiplied by the
//! texel's solid angle. No padded borders, no double counting: what one view leaves the next one has.

use glam::{DMat2, DVec2};

use super::kernel::KernelTable;
use super::taps::{Candidate, Taps, centre, settle};
use super::{Ellipse, lookup};
use crate::sphere::{Angle, Direction};
use crate::world::{Footprint, PixelPoint, Source, World};

/// A mapping is taken as linear over a kernel that is smaller than this part of the way to its nearest singularity.
const LINEAR_PART: f64 = 0.2;

/// Anti-ringing clamps to the texels of r² under this. With the default floor the disc reaches 1.37 texels, so that
/// whatever way a gradient runs there are texels on both sides of the pixel, at the corners of a cube too.
const UNDER: f64 = 1.5;

/// The gather for one world and kernel.
pub(super) struct Gather<'a> {
    world: &'a World,
    table: &'a KernelTable,
    candidates: Vec<Candidate>,
    /// The view that held all of the last footprint: the likeliest for the next.
    last: usize,
}

/// Columns and rows of texels, both ends included; columns may run past a panorama's edges.
struct TexelBox {
    left: i64,
    right: i64,
    top: i64,
    bottom: i64,
}

impl<'a> Gather<'a> {
    pub(super) fn new(world: &'a World, table: &'a KernelTable) -> Self {
        Self { world, table, candidates: Vec::new(), last: 0 }
    }

    /// The taps of a footprint, weights adding to one; none where no view is near.
    pub(super) fn taps(&mut self, footprint: &Footprint, taps: &mut Taps) {
        taps.clear();
        self.candidates.clear();
        let sources = self.world.sources();
        if !self.gather_from(&sources[self.last], footprint) {
            // A kernel inside one view touches no other, so the order of views never changes a result.
            self.candidates.clear();
            for (index, source) in sources.iter().enumerate() {
                if self.gather_from(source, footprint) {
                    self.last = index;
                    break;
                }
            }
        }
        if self.table.kernel().centred {
            centre(&mut self.candidates);
        }
        settle(&self.candidates, taps);
        if taps.is_empty() {
            lookup::nearest(self.world, footprint.direction, |texel, weight| taps.push_under(texel, weight));
        }
    }

    /// Adds the texels of one view; true if the kernel lies wholly inside it.
    fn gather_from(&mut self, source: &Source, footprint: &Footprint) -> bool {
        let kernel = self.table.kernel();
        let jacobian = &footprint.jacobian;
        let pixel = (jacobian.dx.length_squared() + jacobian.dy.length_squared()).sqrt();
        let unit = (kernel.scale * pixel).max(kernel.floor * source.texel_pitch);
        let radius = kernel.radius() * unit;
        let margin = source.view.margin(footprint.direction);
        if margin + radius <= 0.0 {
            return false;
        }
        if radius < LINEAR_PART * margin {
            self.gather_ellipse(source, footprint)
        } else {
            self.gather_cap(source, footprint, radius);
            false
        }
    }

    /// The common case: the footprint is an ellipse of texels.
    fn gather_ellipse(&mut self, source: &Source, footprint: &Footprint) -> bool {
        let Some((centre, jacobian)) = source.view.texel_footprint(footprint) else { return false };
        let kernel = self.table.kernel();
        let coarseness = kernel.coarseness(jacobian.determinant().abs().sqrt()) as f32;
        let ellipse = Ellipse::new(jacobian * kernel.scale, kernel.floor);
        let to_screen = jacobian.inverse();
        let reach = ellipse.half_extent(self.table.radius_squared());
        let bounds = TexelBox::around(centre, reach);
        let (width, height) = (source.view.width() as i64, source.view.height() as i64);
        let period = source.period.map(|period| period as i64);
        let rows = bounds.top.max(0)..=bounds.bottom.min(height - 1);
        let columns = match period {
            Some(period) => bounds.left..=bounds.right.min(bounds.left + period - 1),
            None => bounds.left.max(0)..=bounds.right.min(width - 1),
        };
        for j in rows {
            let v = j as f64 + 0.5 - centre.y;
            let row = source.offset + j as usize * source.view.width();
            // Q = AU² + BUV + CV² by finite differences along the row (Greene & Heckbert 1986).
            let u = *columns.start() as f64 + 0.5 - centre.x;
            let mut q = ellipse.distance_squared(DVec2::new(u, v));
            let mut dq = ellipse.a * (2.0 * u + 1.0) + ellipse.b * v;
            let ddq = 2.0 * ellipse.a;
            for i in columns.clone() {
                if q < self.table.radius_squared() {
                    let column = period.map_or(i, |period| i.rem_euclid(period));
                    if column < width {
                        let offset = DVec2::new(i as f64 + 0.5 - centre.x, v);
                        self.add(row + column as usize, q, coarseness, to_screen * offset);
                    }
                }
                q += dq;
                dq += ddq;
            }
        }
        let whole_width = period.is_some_and(|period| period <= width);
        bounds.top >= 0 && bounds.bottom < height && (whole_width || (bounds.left >= 0 && bounds.right < width))
    }

    /// Near a pole, a horizon or a rim the ellipse would be wrong: each texel is weighed by its direction instead, in
    /// the plane tangent to the sphere at the footprint.
    fn gather_cap(&mut self, source: &Source, footprint: &Footprint, radius: f64) {
        let here = footprint.direction.vector();
        let (right, up) = here.any_orthonormal_pair();
        let in_tangent_plane = |vector: glam::DVec3| DVec2::new(right.dot(vector), up.dot(vector)) / source.texel_pitch;
        let jacobian =
            DMat2::from_cols(in_tangent_plane(footprint.jacobian.dx), in_tangent_plane(footprint.jacobian.dy));
        let kernel = self.table.kernel();
        let coarseness = kernel.coarseness(jacobian.determinant().abs().sqrt()) as f32;
        let ellipse = Ellipse::new(jacobian * kernel.scale, kernel.floor);
        let to_screen = jacobian.inverse();
        for (i, j) in texels_within(source, footprint.direction, radius) {
            let Some(texel) = source.view.direction(PixelPoint::centre(i, j)) else { continue };
            if texel.dot(footprint.direction) <= 0.0 {
                continue;
            }
            let offset = in_tangent_plane(texel.vector() - here);
            let q = ellipse.distance_squared(offset);
            if q < self.table.radius_squared() {
                self.add(source.offset + j * source.view.width() + i, q, coarseness, to_screen * offset);
            }
        }
    }

    fn add(&mut self, texel: usize, q: f64, coarseness: f32, offset: DVec2) {
        let solid_angle = f64::from(self.world.solid_angles()[texel]);
        if solid_angle > 0.0 {
            self.candidates.push(Candidate {
                texel: texel as u32,
                under: q < UNDER,
                weight: f64::from(self.table.weight(q, coarseness)) * solid_angle,
                window: (1.0 - q / self.table.radius_squared()).powi(2) * solid_angle,
                offset,
            });
        }
    }
}

impl TexelBox {
    /// All texels whose centres are within `reach` of a point.
    fn around(centre: PixelPoint, reach: DVec2) -> Self {
        Self {
            left: (centre.x - reach.x - 0.5).ceil() as i64,
            right: (centre.x + reach.x - 0.5).floor() as i64,
            top: (centre.y - reach.y - 0.5).ceil() as i64,
            bottom: (centre.y + reach.y - 0.5).floor() as i64,
        }
    }
}

/// Column and row of every texel that can lie within `radius` radians of a direction.
fn texels_within(source: &Source, direction: Direction, radius: f64) -> impl Iterator<Item = (usize, usize)> {
    let view = &source.view;
    let bounds = view.cap_bounds(direction, Angle::from_radians(radius));
    let clamp = |value: f64, size: usize| value.clamp(0.0, size as f64) as usize;
    let (top, bottom) = (clamp(bounds.min.y.floor(), view.height()), clamp(bounds.max.y.ceil(), view.height()));
    let (left, right) = match source.period {
        // The cap may lie across the seam; rows are short there or few.
        Some(_) if bounds.min.x < 0.0 || bounds.max.x > view.width() as f64 => (0, view.width()),
        _ => (clamp(bounds.min.x.floor(), view.width()), clamp(bounds.max.x.ceil(), view.width())),
    };
    (top..bottom).flat_map(move |j| (left..right).map(move |i| (i, j)))
}
