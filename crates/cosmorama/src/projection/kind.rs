use glam::{DVec2, DVec3};

use super::azimuthal::{Azimuthal, Equidistant, OmnimaxLens};
use super::cylindrical::Equirectangular;
use super::{EquiAngular, Perspective, PlanePoint, PlaneRect, Projection};
use crate::sphere::{Angle, Direction, DirectionJacobian};

/// Every projection, chosen at run time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ProjectionKind {
    /// A pinhole camera; a cube face is one of 90°.
    Perspective(Perspective),
    /// The Omnimax lens.
    Omnimax(Azimuthal<OmnimaxLens>),
    /// The equidistant fisheye.
    Equidistant(Azimuthal<Equidistant>),
    /// The panorama of longitude by latitude.
    Equirectangular(Equirectangular),
    /// A face of an equi-angular cube map.
    EquiAngular(EquiAngular),
}

impl ProjectionKind {
    /// The pinhole camera.
    pub const PERSPECTIVE: Self = Self::Perspective(Perspective);
    /// The Omnimax lens.
    pub const OMNIMAX: Self = Self::Omnimax(Azimuthal(OmnimaxLens));
    /// The equidistant fisheye.
    pub const EQUIDISTANT: Self = Self::Equidistant(Azimuthal(Equidistant));
    /// The panorama.
    pub const EQUIRECTANGULAR: Self = Self::Equirectangular(Equirectangular);
    /// A face of an equi-angular cube map.
    pub const EQUI_ANGULAR: Self = Self::EquiAngular(EquiAngular);

    /// One of each, for tests and listings.
    pub const ALL: [Self; 5] =
        [Self::PERSPECTIVE, Self::OMNIMAX, Self::EQUIDISTANT, Self::EQUIRECTANGULAR, Self::EQUI_ANGULAR];
}

/// Calls a method of the projection that is inside.
macro_rules! each {
    ($kind:expr, $projection:ident => $call:expr) => {
        match $kind {
            ProjectionKind::Perspective($projection) => $call,
            ProjectionKind::Omnimax($projection) => $call,
            ProjectionKind::Equidistant($projection) => $call,
            ProjectionKind::Equirectangular($projection) => $call,
            ProjectionKind::EquiAngular($projection) => $call,
        }
    };
}

impl Projection for ProjectionKind {
    fn project(&self, direction: Direction) -> Option<PlanePoint> {
        each!(self, projection => projection.project(direction))
    }

    fn unproject(&self, point: PlanePoint) -> Option<Direction> {
        each!(self, projection => projection.unproject(point))
    }

    fn unproject_row(&self, first: PlanePoint, step: f64, count: usize, visit: impl FnMut(usize, Direction)) {
        each!(self, projection => projection.unproject_row(first, step, count, visit));
    }

    fn jacobian(&self, point: PlanePoint) -> Option<DirectionJacobian> {
        each!(self, projection => projection.jacobian(point))
    }

    fn unproject_with_jacobian(&self, point: PlanePoint) -> Option<(Direction, DirectionJacobian)> {
        each!(self, projection => projection.unproject_with_jacobian(point))
    }

    fn project_with_derivatives(&self, direction: Direction, tangents: [DVec3; 2]) -> Option<(PlanePoint, [DVec2; 2])> {
        each!(self, projection => projection.project_with_derivatives(direction, tangents))
    }

    fn margin(&self, direction: Direction) -> f64 {
        each!(self, projection => projection.margin(direction))
    }

    fn cap_bounds(&self, centre: Direction, radius: Angle) -> PlaneRect {
        each!(self, projection => projection.cap_bounds(centre, radius))
    }

    fn period(&self) -> Option<f64> {
        each!(self, projection => projection.period())
    }
}
