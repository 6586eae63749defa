//! Projections: invertible mappings between directions and a plane.
//!
//! A projection knows nothing of pixels, orientation or the edges of an image; those belong to [`crate::camera::View`].
//! Each is a small file, and adding one touches its file and the list in this one.

pub mod azimuthal;
pub(crate) mod bounds;
pub mod cylindrical;
mod enum_dispatch;
mod monotone;
pub(crate) mod planar;
mod plane;
pub mod pseudocylindrical;
pub(crate) mod st_map;
pub(crate) mod world_map;

pub use azimuthal::mirror_ball::MirrorBall;
use azimuthal::{Azimuthal, FisheyeLens, OmnimaxLens};
pub use bounds::cap_region::{Outline, Ring, Sector};
use cylindrical::{Central, Cylindrical, EqualArea, Equirectangular, Mercator};
pub(crate) use enum_dispatch::enum_dispatch;
use glam::{DVec2, DVec3};
pub use planar::brown_conrady::{BrownConrady, BrownConradyCoefficients};
pub use planar::calibrated::Calibrated;
pub use planar::equi_angular::EquiAngular;
pub use planar::pannini::Pannini;
pub use planar::perspective::Perspective;
pub use plane::{PlanePoint, PlaneRect};
use pseudocylindrical::{Mollweide, Pseudocylindrical, Sinusoidal};
pub use st_map::{StMap, StMapError, StMapTable};
pub use world_map::hammer::Hammer;
pub use world_map::octahedral::{Octahedral, OctahedralKind};

use crate::sphere::{Angle, Direction, DirectionJacobian};

enum_dispatch! { ($)
    /// Any projection, chosen at run time.
    pub enum ProjectionKind {
        /// A pinhole camera; a cube face is one of 90°.
        Perspective(Perspective) = [Perspective],
        /// The Omnimax lens.
        Omnimax(Azimuthal<OmnimaxLens>) = [Azimuthal(OmnimaxLens)],
        /// A fisheye lens.
        Fisheye(Azimuthal<FisheyeLens>) = FisheyeLens::all().into_iter().map(Azimuthal),
        /// A pinhole camera with lens distortion.
        Pinhole(Calibrated<BrownConrady>) = kind::bent_cameras(),
        /// A fisheye with skewed sensor rows.
        SkewedFisheye(Calibrated<Azimuthal<FisheyeLens>>) = [kind::skewed_fisheye()],
        /// The equirectangular panorama.
        Equirectangular(Cylindrical<Equirectangular>) = [Cylindrical(Equirectangular)],
        /// A face of an equi-angular cube map.
        EquiAngular(EquiAngular) = [EquiAngular],
        /// Mercator's map.
        Mercator(Cylindrical<Mercator>) = [Cylindrical(Mercator)],
        /// The central cylinder.
        CentralCylinder(Cylindrical<Central>) = [Cylindrical(Central)],
        /// Lambert's equal-area cylinder.
        EqualAreaCylinder(Cylindrical<EqualArea>) = [Cylindrical(EqualArea)],
        /// A mirror ball as photographed.
        MirrorBall(MirrorBall) =
            [MirrorBall::DISTANT].into_iter().chain([100.0, 2.0].into_iter().filter_map(MirrorBall::from_distance)),
        /// Hammer's map of the world.
        Hammer(Hammer) = [Hammer],
        /// Mollweide's map of the world.
        Mollweide(Pseudocylindrical<Mollweide>) = [Pseudocylindrical(Mollweide)],
        /// The sinusoidal map of the world.
        Sinusoidal(Pseudocylindrical<Sinusoidal>) = [Pseudocylindrical(Sinusoidal)],
        /// The general Pannini projection.
        Pannini(Pannini) = [0.0, 0.5, 1.0, 2.0].into_iter().filter_map(Pannini::from_distance),
        /// The sphere on an octahedron.
        Octahedral(Octahedral) = [OctahedralKind::EqualArea, OctahedralKind::Plain].map(Octahedral),
        /// A table of places and directions; it has no formula, and tests of its own.
        StMap(StMap) = [],
    }
}

mod kind;

/// An invertible mapping between directions (in the view's own frame, −Z forward) and a plane (x right, y up), in the
/// projection's natural unit.
///
/// Outside the domain every method returns `None`, never NaN.
pub trait Projection {
    /// Returns the point of the plane at which a direction is seen.
    fn project(&self, direction: Direction) -> Option<PlanePoint>;

    /// Returns the direction that is seen at a point of the plane.
    fn unproject(&self, point: PlanePoint) -> Option<Direction>;

    /// Visits the directions at `count` points in a row, `step` apart along x, each with its number. Points without a
    /// direction are left out. Projections override it where a whole row costs less than its points.
    fn unproject_row(&self, first: PlanePoint, step: f64, count: usize, mut visit: impl FnMut(usize, Direction)) {
        for k in 0..count {
            if let Some(direction) = self.unproject(PlanePoint::new(first.x + k as f64 * step, first.y)) {
                visit(k, direction);
            }
        }
    }

    /// Returns the exact ∂direction/∂plane at a point; `None` exactly where [`Projection::unproject`] is `None`.
    fn jacobian(&self, point: PlanePoint) -> Option<DirectionJacobian>;

    /// Returns the solid angle of a unit square of the plane around a point, in steradians (to first order): |∂d/∂x ×
    /// ∂d/∂y|.
    fn solid_angle(&self, point: PlanePoint) -> Option<f64> {
        self.jacobian(point).map(|jacobian| jacobian.solid_angle())
    }

    /// Computes solid angles at `count` points of a row, `step` apart along x, and calls `visit` with each point's number.
    fn row_solid_angles(&self, first: PlanePoint, step: f64, count: usize, mut visit: impl FnMut(usize, Option<f64>)) {
        for k in 0..count {
            visit(k, self.solid_angle(PlanePoint::new(first.x + k as f64 * step, first.y)));
        }
    }

    /// Returns the direction and its derivatives. Projections override it where the two share work.
    fn unproject_with_jacobian(&self, point: PlanePoint) -> Option<(Direction, DirectionJacobian)> {
        Some((self.unproject(point)?, self.jacobian(point)?))
    }

    /// Returns the point at which a direction is seen, and its derivatives along each tangent vector.
    fn project_with_derivatives(&self, direction: Direction, tangents: [DVec3; 2]) -> Option<(PlanePoint, [DVec2; 2])> {
        let point = self.project(direction)?;
        let jacobian = self.jacobian(point)?;
        Some((point, [jacobian.pseudo_inverse(tangents[0])?, jacobian.pseudo_inverse(tangents[1])?]))
    }

    /// Returns how lines of equal x and y bend on the sphere, if that has a closed form: ∂²direction/∂x², ∂x∂y and ∂y².
    /// Each is given by its part in the tangent plane, in multiples of ∂direction/∂x and ∂y (Christoffel symbols).
    fn curvature(&self, _point: PlanePoint) -> Option<[DVec2; 3]> {
        None
    }

    /// Returns a lower bound, in radians, of the angle from a direction to the nearest singularity of the mapping: a
    /// pole, a horizon or a rim. It is negative beyond a horizon. A footprint much smaller than this is mapped to an
    /// ellipse; a larger one is weighed on the sphere.
    fn margin(&self, direction: Direction) -> f64;

    /// Returns whether derivatives grow without bound towards a rim or a pole. There a texel is measured from one side
    /// to the other.
    fn has_steep_rim(&self) -> bool {
        false
    }

    /// Returns whether the visible part ends at a cone around the axis; then [`Projection::margin`] is the angle to
    /// that cone.
    fn ends_at_cone(&self) -> bool {
        false
    }

    /// Returns the mirror image of a direction beyond the nearest seam at which the map's sides meet at an angle. That
    /// is where the texels beyond the seam lie. `None` for maps without such a seam.
    fn beyond_seam(&self, _direction: Direction) -> Option<Direction> {
        None
    }

    /// Returns the rectangle of the plane that holds every direction within `radius` of `centre`.
    fn cap_bounds(&self, centre: Direction, radius: Angle) -> PlaneRect;

    /// Returns the part of the plane that holds every direction within `radius` of `centre`. Maps override it if a cap
    /// at a rim or a seam lies in several distant places.
    fn cap_outline(&self, centre: Direction, radius: Angle) -> Outline {
        Outline::Rects(vec![self.cap_bounds(centre, radius)])
    }

    /// Returns the distance after which x repeats, if the plane is an unrolled cylinder.
    fn period(&self) -> Option<f64> {
        None
    }
}
