//! EWA across views: a footprint that crosses from one view into another gathers from both.
//!
//! Each view tests only texels that it owns, in its own plane, with its own ellipse; each weight is multiplied by the
//! texel's solid angle. No padded borders, no double counting: what one view leaves the next one has.

use glam::{DMat2, DVec2};

use super::candidates::{Candidate, settle};
use super::kernel::KernelTable;
use super::{Ellipse, Taps, lookup};
use crate::sphere::{Angle, Direction};
use crate::world::{Footprint, PixelPoint, Source, World};

/// A mapping is taken as linear over a kernel that is smaller than this part of the way to its nearest singularity.
const LINEAR_PART: f64 = 0.2;

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
        settle(&mut self.candidates, self.table.kernel().centred, taps);
        if taps.is_empty() {
            lookup::nearest(self.world, footprint.direction, |texel, weight| taps.push_under(texel, weight as f32));
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
        for j in bounds.top.max(0)..=bounds.bottom.min(height - 1) {
            let row = source.offset + j as usize * source.view.width();
            for run in bounds.runs(source) {
                let offset = DVec2::new(run.unrolled as f64 + 0.5 - centre.x, j as f64 + 0.5 - centre.y);
                self.gather_run(row + run.column, run.length, offset, &ellipse, coarseness, to_screen);
            }
        }
        let whole_width = source.period.is_some_and(|period| period <= source.view.width());
        bounds.top >= 0 && bounds.bottom < height && (whole_width || (bounds.left >= 0 && bounds.right < width))
    }

    /// Texels beside each other in a row: Q = AU² + BUV + CV² by finite differences (Greene & Heckbert 1986).
    fn gather_run(
        &mut self,
        first: usize,
        length: usize,
        first_offset: DVec2,
        ellipse: &Ellipse,
        coarseness: f32,
        to_screen: DMat2,
    ) {
        let mut q = ellipse.distance_squared(first_offset);
        let mut dq = ellipse.a * (2.0 * first_offset.x + 1.0) + ellipse.b * first_offset.y;
        let ddq = 2.0 * ellipse.a;
        let mut offset = to_screen * first_offset;
        let radius_squared = self.table.radius_squared();
        // Every texel is written, and only those inside are kept: whether the next one is inside cannot be predicted.
        let mut kept = self.candidates.len();
        self.candidates.resize(kept + length, Candidate::default());
        for (texel, &solid_angle) in self.world.solid_angles()[first..first + length].iter().enumerate() {
            self.candidates[kept] = self.table.candidate(first + texel, solid_angle, q, coarseness, offset);
            kept += usize::from(q < radius_squared && solid_angle > 0.0);
            q += dq;
            dq += ddq;
            offset += to_screen.x_axis;
        }
        self.candidates.truncate(kept);
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
            let index = source.offset + j * source.view.width() + i;
            let solid_angle = self.world.solid_angles()[index];
            if q < self.table.radius_squared() && solid_angle > 0.0 {
                let offset = to_screen * offset;
                self.candidates.push(self.table.candidate(index, solid_angle, q, coarseness, offset));
            }
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

    /// The runs of texels in each row: one, or where a panorama's box crosses its edge, one for each turn.
    fn runs(&self, source: &Source) -> impl Iterator<Item = Run> + use<> {
        let width = source.view.width() as i64;
        let (left, end, turn) = match source.period {
            // Never the same texel twice.
            Some(period) => (self.left, (self.right + 1).min(self.left + period as i64), period as i64),
            None => (self.left.max(0), (self.right + 1).min(width), width),
        };
        let turns = if left < end { left.div_euclid(turn)..(end - 1).div_euclid(turn) + 1 } else { 0..0 };
        turns.filter_map(move |k| {
            let (first, past) = (left.max(k * turn), end.min(k * turn + width.min(turn)));
            let column = (first - k * turn) as usize;
            (first < past).then(|| Run { column, unrolled: first, length: (past - first) as usize })
        })
    }
}

/// A run of texels in one row of the box: its first column in the image, the same column counted on past the image's
/// edge, and its length.
struct Run {
    column: usize,
    unrolled: i64,
    length: usize,
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
