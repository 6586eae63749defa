//! EWA across views: a footprint that crosses from one view into another gathers from both.
//!
//! Each view tests only texels that it owns, in its own plane, with its own ellipse. Each weight is multiplied by the
//! texel's solid angle. There are no padded borders and no double counting: texels that one view lacks, its neighbour
//! has.

pub(crate) mod candidate;
pub(crate) mod cap;
pub(crate) mod cap_chain;
pub(crate) mod clearance;
pub(crate) mod curvature;
pub(crate) mod ellipse;
pub(crate) mod pixel_taps;
pub(crate) mod seam_scale;
pub(crate) mod tangent_kernel;
pub(crate) mod tap_weights;
pub(crate) mod texel_run;

use glam::{DMat2, DVec2, DVec3};

use super::gather::candidate::Candidate;
use super::gather::cap::Cap;
use super::gather::curvature::Bend;
use super::gather::seam_scale::Meeting;
use super::gather::tangent_kernel::{RIM_FLOOR, TangentKernel};
use super::gather::texel_run::{Run, TexelBox, ceil, floor, runs_around};
use super::kernel::KernelTable;
use super::rim::clamp_set;
use super::rim::field_edge::FieldEdge;
use super::rim::visible_texels::SeenTexels;
use super::taps::Taps;
use super::{Ellipse, Kernel, lookup};
use crate::camera::{FieldStop, Footprint, PixelPoint};
use crate::projection::Projection;
use crate::sphere::{Direction, DirectionJacobian};
use crate::world::{Near, Source, World};
use clearance::{Clearance, Grid};
use tap_weights::settle;

/// Radius of a kernel, as a part of the distance to its nearest singularity, below which its mapping is taken as
/// linear. At a fifth, no point of a world whose colours show directions is displaced by more than 0.005 pixel in the
/// tests.
pub(crate) const LINEAR_PART: f64 = 0.2;

/// Greatest displacement, in pixels, that taking a mapping as linear may cause beside a steep rim, where the size of
/// texels changes quickly. The displacement is estimated by the kernel's squared radius divided by the distance to the
/// rim.
const STEEP_PART: f64 = 0.1;

/// Region in which a pixel lies, which decides what its kernel is clamped to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum RimRegion {
    /// Nothing ends under the pixel.
    Inside,
    /// The field of view ends under the pixel.
    Rim,
}

/// Working memory that a gather keeps from one footprint to the next.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scratch {
    candidates: Vec<Candidate>,
    /// Index of the view that held all of the last footprint. It is tried first for the next one.
    last: usize,
}

/// The gather for one world and kernel.
pub(crate) struct Gather<'a> {
    world: &'a World,
    table: &'a KernelTable,
    /// Edge of the target's field of view, if it has one.
    field: Option<FieldEdge<'a>>,
    /// Texels on which the field falls. Others do not count; `None` if all do.
    seen: Option<SeenTexels<'a>>,
    /// Pitch of the largest texel of any view, in radians.
    texel_pitch: f64,
    scratch: Scratch,
}

impl<'a> Gather<'a> {
    /// Makes the gather from a world by a kernel; `field` is the edge of the field of view that footprints belong to,
    /// if any.
    pub(crate) fn new(world: &'a World, field: Option<FieldEdge<'a>>, table: &'a KernelTable) -> Self {
        // Needed only at an edge.
        let pitches = || world.sources().iter().map(|source| source.texel_pitch);
        let texel_pitch = if field.is_some() { pitches().fold(0.0, f64::max) } else { 0.0 };
        let edge = field.filter(|edge| edge.is_wider_than(texel_pitch));
        let seen = edge.map(|edge| SeenTexels::new(world, edge));
        Self { world, table, field, seen, texel_pitch, scratch: Scratch::default() }
    }

    /// Reuses the memory of an earlier gather, even in another world.
    pub(crate) fn with_scratch(self, scratch: Scratch) -> Self {
        let last = scratch.last.min(self.world.sources().len() - 1);
        Self { scratch: Scratch { last, ..scratch }, ..self }
    }

    /// Returns the memory for another gather.
    pub(crate) fn into_scratch(self) -> Scratch {
        self.scratch
    }

    /// Finds the taps of a footprint. Their weights add to one. There is none where no view is near.
    pub(crate) fn taps(&mut self, footprint: &Footprint, taps: &mut Taps) {
        taps.clear();
        let footprint = &shape(self.table.kernel(), footprint);
        let centred = self.table.kernel().centred;
        let ends_under = self.collect(footprint, RimRegion::Inside);
        let at_rim = centred && (ends_under || self.ends_beside());
        if at_rim {
            self.collect(footprint, RimRegion::Rim);
        }
        settle(&mut self.scratch.candidates, centred, at_rim.then_some(&footprint.jacobian), taps);
        if taps.is_empty() {
            lookup::nearest(self.world, footprint.direction, |texel, weight| taps.push_under(texel, weight as f32));
        }
    }

    /// Returns whether all texels that count lie to one side of the pixel. On its other side there is no view, or one
    /// that the caller had no need to supply.
    fn ends_beside(&self) -> bool {
        !self.scratch.candidates.is_empty() && clamp_set::reach(&self.scratch.candidates).is_none()
    }

    /// Finds the texels that count. Returns whether the field of view ends under the pixel.
    fn collect(&mut self, footprint: &Footprint, region: RimRegion) -> bool {
        self.scratch.candidates.clear();
        let (sources, floor) = (self.world.sources(), self.floor(region));
        if !self.gather_from(&sources[self.scratch.last], footprint, region, floor) && sources.len() > 1 {
            self.scratch.candidates.clear();
            let meeting = Meeting::at(self.world, self.table.kernel(), footprint.direction);
            let mut coarsest = 0f64;
            for index in self.near(footprint, meeting.as_ref(), floor) {
                let (source, start) = (&sources[index], self.scratch.candidates.len());
                let floor = floor * meeting.map_or(1.0, |meeting| meeting.widening(source));
                if self.gather_from(source, footprint, region, floor) {
                    // A kernel wholly inside one view ignores the others. They could enter only through a bent ellipse,
                    // and the result would depend on the order of views or on the last footprint.
                    self.scratch.candidates.drain(..start);
                    self.scratch.last = index;
                    break;
                }
                coarsest = self.measure_alike(start, coarsest, self.reach(footprint, source.texel_pitch, floor));
            }
        }
        self.drop_unseen(footprint, region)
    }

    /// Visits, in their order, the views that a footprint's kernels may reach, whose unit is at least `floor` texels before they are
    /// widened where views meet.
    fn near(&self, footprint: &Footprint, meeting: Option<&Meeting>, floor: f64) -> Near<'a> {
        let direction = footprint.direction;
        let pitch = || self.world.coarsest(|source| source.texel_pitch_at(direction));
        let widest = || pitch().max(meeting.map_or(0.0, Meeting::coarsest));
        self.world.near(direction, || self.reach(footprint, widest(), floor))
    }

    /// Rescales candidates' distances to the coarsest kernel's unit, and returns that kernel's reach. Otherwise texels
    /// of the finer view would not count as under the pixel, and every slope beside a coarser view would be clamped.
    ///
    /// Candidates from `start` on belong to a kernel of this `reach`, earlier ones to the one of reach `coarsest`. Both
    /// are in radians.
    fn measure_alike(&mut self, start: usize, coarsest: f64, reach: f64) -> f64 {
        if start == self.scratch.candidates.len() {
            return coarsest;
        }
        let (before, these) = self.scratch.candidates.split_at_mut(start);
        let (finer, part) = if reach < coarsest { (these, reach / coarsest) } else { (before, coarsest / reach) };
        finer.iter_mut().for_each(|candidate| candidate.q *= (part * part) as f32);
        coarsest.max(reach)
    }

    pub(crate) fn world(&self) -> &'a World {
        self.world
    }

    pub(crate) fn kernel(&self) -> &'a Kernel {
        self.table.kernel()
    }

    /// Returns whether the edge of the target's field of view may lie within `reach` radians of a direction.
    pub(crate) fn is_near_edge(&self, direction: Direction, reach: f64) -> bool {
        self.field.is_some_and(|edge| edge.is_near(direction, reach))
    }

    /// Returns how far a patch of the target is from the edge of its field of view. `None` unless each kernel in the
    /// patch is an ellipse of texels that no view's edge cuts. `screen` holds points of the patch, row by row.
    pub(crate) fn clearance(&self, source: &Source, screen: &Grid<Footprint>) -> Option<Clearance> {
        let (middle, corners) = (screen[1][1].direction, [screen[0][0], screen[0][2], screen[2][0], screen[2][2]]);
        let cap = Cap::around(middle, &corners)?;
        let floor = self.floor(RimRegion::Inside);
        let largest = |of: &dyn Fn(&Footprint) -> f64| corners.iter().map(of).fold(0.0, f64::max);
        let reach = largest(&|corner| self.reach(corner, source.texel_pitch_at(corner.direction), floor));
        let seen = cap.widened(reach);
        let margin = source.view.margin(middle) - cap.radius();
        let is_linear = corners.iter().all(|corner| is_linear(source, corner, reach, margin));
        if !is_linear || !seen.is_clear_of_stop(&source.view) {
            return None;
        }
        if !self.is_near_edge(middle, seen.radius()) {
            return Some(Clearance::Whole);
        }
        // Distance at which single pixels are tested for the edge, but at least the size of a pixel.
        let kernel = largest(&|corner| self.reach(corner, self.texel_pitch, floor));
        Some(Clearance::Within(largest(&pixel_size).max(kernel)))
    }

    /// Drops texels outside the field of view, so that their light does not leak in. Returns whether any of them lies
    /// under the pixel.
    fn drop_unseen(&mut self, footprint: &Footprint, region: RimRegion) -> bool {
        let reach = self.reach(footprint, self.texel_pitch, self.floor(region));
        let Some(seen) = self.seen.as_mut().filter(|seen| seen.ends_near(footprint.direction, reach)) else {
            return false;
        };
        let mut ends_under = false;
        self.scratch.candidates.retain(|candidate| {
            let is_seen = seen.holds(candidate.texel);
            ends_under |= candidate.is_under() && !is_seen;
            is_seen
        });
        ends_under
    }

    /// Returns the least size of the kernel's unit, in texels.
    fn floor(&self, region: RimRegion) -> f64 {
        self.table.kernel().floor * if region == RimRegion::Rim { RIM_FLOOR } else { 1.0 }
    }

    /// Returns an upper bound of the kernel's radius on the sphere, in radians. `texel_pitch` is in radians too, and
    /// the kernel's unit is at least `floor` texels.
    fn reach(&self, footprint: &Footprint, texel_pitch: f64, floor: f64) -> f64 {
        reach(self.table.kernel(), footprint, texel_pitch, floor)
    }

    /// Adds the texels of one view. Returns whether the kernel lies wholly inside it.
    fn gather_from(&mut self, source: &Source, footprint: &Footprint, region: RimRegion, floor: f64) -> bool {
        let radius = self.reach(footprint, source.texel_pitch_at(footprint.direction), floor);
        // First of all, since of many views most are far away.
        if !source.reaches(footprint.direction, radius) {
            return false;
        }
        let margin = source.view.margin(footprint.direction);
        if margin + radius <= 0.0 {
            return false;
        }
        // At a rim, the errors of a bent mapping do not cancel between two sides.
        if is_linear(source, footprint, radius, margin) && region == RimRegion::Inside {
            self.gather_ellipse(source, footprint, floor)
        } else {
            self.gather_cap(source, footprint, radius, floor);
            false
        }
    }

    /// Gathers an ellipse of texels, which is the common case. Returns whether it lies wholly inside the view.
    fn gather_ellipse(&mut self, source: &Source, footprint: &Footprint, unit: f64) -> bool {
        let Some((centre, jacobian)) = source.view.texel_footprint(footprint) else { return false };
        let kernel = self.table.kernel();
        let coarseness = kernel.coarseness(jacobian.determinant().abs().sqrt()) as f32;
        let ellipse = Ellipse::new(jacobian * kernel.scale, unit);
        let to_screen = jacobian.inverse();
        let bend = if kernel.centred { Bend::around(&source.view, centre) } else { None }.unwrap_or_default();
        let reach = ellipse.half_extent(self.table.radius_squared());
        let bounds = TexelBox::around(centre, reach);
        let rows = ellipse.rows(self.table.radius_squared());
        let height = source.view.height() as i64;
        for j in bounds.top.max(0)..=bounds.bottom.min(height - 1) {
            let v = j as f64 + 0.5 - centre.y;
            let Some((least, greatest)) = rows.range(v) else { continue };
            let row = j as usize * source.view.width();
            let (left, end) = (ceil(centre.x + least - 0.5), floor(centre.x + greatest - 0.5) + 1);
            let mut gather = |run: Run| {
                if run.length == 0 {
                    return;
                }
                let offset = DVec2::new(run.unrolled as f64 + 0.5 - centre.x, v);
                let first = row + run.column;
                let texels = (source.offset + first, &source.solid_angles[first..first + run.length]);
                self.gather_run(texels, offset, &ellipse, coarseness, (to_screen, &bend));
            };
            match source.period {
                None => gather(Run::within(left.max(0), end.min(source.view.width() as i64), 0)),
                Some(period) => runs_around(source, period as i64, left, end).for_each(gather),
            }
        }
        // Inside means that no other view has a part in what the kernel touches.
        let whole = &source.whole;
        let whole_turn = source.period.is_some_and(|period| period == whole.right - whole.left);
        source.view.stop == FieldStop::NONE
            && bounds.top >= whole.top as i64
            && bounds.bottom < whole.bottom as i64
            && (whole_turn || (bounds.left >= whole.left as i64 && bounds.right < whole.right as i64))
    }

    /// Adds neighbouring texels of a row, all inside, given the index of the first and the solid angle of each.
    /// Computes Q = AU² + BUV + CV² by finite differences (Greene & Heckbert 1986).
    fn gather_run(
        &mut self,
        (first, solid_angles): (usize, &[f32]),
        first_offset: DVec2,
        ellipse: &Ellipse,
        coarseness: f32,
        (to_screen, bend): (DMat2, &Bend),
    ) {
        let mut q = ellipse.distance_squared(first_offset);
        let mut dq = ellipse.a * (2.0 * first_offset.x + 1.0) + ellipse.b * first_offset.y;
        let ddq = 2.0 * ellipse.a;
        let mut offset = to_screen * bend.of(first_offset);
        let mut step = to_screen * bend.of(first_offset + DVec2::X) - offset;
        let change = to_screen * bend.uu;
        for (texel, &solid_angle) in solid_angles.iter().enumerate() {
            if solid_angle > 0.0 {
                self.scratch.candidates.push(Candidate::weighed(
                    self.table,
                    first + texel,
                    solid_angle,
                    q,
                    coarseness,
                    offset,
                ));
            }
            q += dq;
            dq += ddq;
            offset += step;
            step += change;
        }
    }

    /// Gathers near a pole, a horizon or a rim, where the ellipse would be wrong. Each texel is weighed by its
    /// direction instead, in the plane tangent to the sphere at the footprint.
    fn gather_cap(&mut self, source: &Source, footprint: &Footprint, radius: f64, floor: f64) {
        let kernel = TangentKernel::new(self.table.kernel(), source, footprint, (radius, floor, 0.0));
        kernel.reach.each_run(source, |j, columns| {
            let row = j * source.view.width();
            source.view.row_directions(j, columns, |i, texel| {
                let solid_angle = source.solid_angles[row + i];
                let Some((q, offset)) = kernel.place(texel, self.table.radius_squared()) else { return };
                if solid_angle > 0.0 {
                    let texel = source.offset + row + i;
                    self.scratch.candidates.push(Candidate::weighed(
                        self.table,
                        texel,
                        solid_angle,
                        q,
                        kernel.coarseness,
                        offset,
                    ));
                }
            });
        });
    }
}

/// Texels of a kernel that lie wholly inside one view, in an ellipse.
pub(crate) struct EllipseOfTexels {
    pub(crate) centre: PixelPoint,
    /// Footprint in texels.
    pub(crate) jacobian: DMat2,
    pub(crate) ellipse: Ellipse,
}

/// Returns the ellipse of a footprint's kernel among the texels of a source. `None` if the kernel is not an ellipse
/// there, or not wholly inside the part that no other view shares.
pub(crate) fn ellipse_of_texels(kernel: &Kernel, source: &Source, footprint: &Footprint) -> Option<EllipseOfTexels> {
    let footprint = &shape(kernel, footprint);
    let radius = reach(kernel, footprint, source.texel_pitch_at(footprint.direction), kernel.floor);
    if source.view.stop != FieldStop::NONE
        || !is_linear(source, footprint, radius, source.view.margin(footprint.direction))
    {
        return None;
    }
    let (centre, jacobian) = source.view.texel_footprint(footprint)?;
    let ellipse = Ellipse::new(jacobian * kernel.scale, kernel.floor);
    let reach = kernel.radius().powi(2);
    let bounds = TexelBox::around(centre, ellipse.half_extent(reach));
    let whole = &source.whole;
    let is_inside = bounds.left >= whole.left as i64
        && bounds.right < whole.right as i64
        && bounds.top >= whole.top as i64
        && bounds.bottom < whole.bottom as i64;
    is_inside.then_some(EllipseOfTexels { centre, jacobian, ellipse })
}

/// Estimates how many texels of a source a kernel reads for a footprint, as measured across the kernel. `around` widens
/// the kernel on all sides, in radians.
pub(crate) fn texels_of(kernel: &Kernel, source: &Source, footprint: &Footprint, around: f64) -> f64 {
    let footprint = &shape(kernel, footprint);
    let radius = reach(kernel, footprint, source.texel_pitch_at(footprint.direction), kernel.floor);
    let margin = source.view.margin(footprint.direction);
    if margin + radius + around <= 0.0 || !source.reaches(footprint.direction, radius + around) {
        return 0.0;
    }
    if !is_linear(source, footprint, radius, margin) {
        return TangentKernel::new(kernel, source, footprint, (radius, kernel.floor, around)).reach.texels(source);
    }
    source
        .view
        .texel_footprint(footprint)
        .map_or(0.0, |(_, jacobian)| Ellipse::new(jacobian * kernel.scale, kernel.floor).area(kernel.radius().powi(2)))
}

/// Returns whether derivatives tell how many texels a footprint holds. They do if the mapping under its kernel is
/// nearly linear and texels do not converge.
pub(crate) fn is_regular(kernel: &Kernel, source: &Source, footprint: &Footprint) -> bool {
    let radius = reach(kernel, footprint, source.texel_pitch_at(footprint.direction), kernel.floor);
    let margin = source.view.margin(footprint.direction);
    source.period.is_none() && is_linear(source, footprint, radius, margin)
}

/// Returns an upper bound of a kernel's radius on the sphere, in radians. `texel_pitch` is in radians too, and the
/// kernel's unit is at least `floor` texels.
pub(crate) fn reach(kernel: &Kernel, footprint: &Footprint, texel_pitch: f64, floor: f64) -> f64 {
    kernel.radius() * (kernel.scale * pixel_size(footprint)).max(floor * texel_pitch)
}

/// Returns the root of a pixel's summed squared derivatives, in radians.
fn pixel_size(footprint: &Footprint) -> f64 {
    (footprint.jacobian.dx.length_squared() + footprint.jacobian.dy.length_squared()).sqrt()
}

/// Ratio of width to length below which a pixel has no width, as on the very pole of a panorama.
const NO_WIDTH: f64 = 1e-6;

/// Ratio of width to length that a pixel without width is given. It is far less than the kernel's floor, but enough to
/// tell offsets across the pixel apart.
const SOME_WIDTH: f64 = 0.01;

/// Returns a footprint as a kernel takes it.
pub(crate) fn shape(kernel: &Kernel, footprint: &Footprint) -> Footprint {
    let footprint = with_width(*footprint);
    if kernel.round { footprint.rounded() } else { footprint }
}

/// Returns a footprint unchanged if it has any width; else a narrow one.
fn with_width(footprint: Footprint) -> Footprint {
    let Footprint { direction, jacobian: DirectionJacobian { dx, dy } } = footprint;
    let across = |side: DVec3| direction.vector().cross(side) * SOME_WIDTH;
    let (x, y) = (dx.length(), dy.length());
    let jacobian = if x <= NO_WIDTH * y {
        DirectionJacobian { dx: -across(dy), dy }
    } else if y <= NO_WIDTH * x {
        DirectionJacobian { dx, dy: across(dx) }
    } else {
        return footprint;
    };
    Footprint { direction, jacobian }
}

/// Returns whether the mapping is linear enough over a kernel of this radius; `margin` is the distance to its nearest
/// singularity.
fn is_linear(source: &Source, footprint: &Footprint, radius: f64, margin: f64) -> bool {
    let pixel = || footprint.jacobian.solid_angle().sqrt();
    radius < LINEAR_PART * margin
        && (!source.view.projection.has_steep_rim() || radius * radius < STEEP_PART * margin * pixel())
}
