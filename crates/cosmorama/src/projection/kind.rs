use glam::{DVec2, DVec3};

use super::azimuthal::{Azimuthal, FisheyeLens, OmnimaxLens};
use super::cylindrical::Equirectangular;
use super::{Perspective, PlanePoint, PlaneRect, Projection};
use crate::sphere::{Angle, Direction, DirectionJacobian};

/// Every projection, chosen at run time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ProjectionKind {
    /// A pinhole camera; a cube face is one of 90°.
    Perspective(Perspective),
    /// The Omnimax lens.
    Omnimax(Azimuthal<OmnimaxLens>),
    /// A fisheye lens.
    Fisheye(Azimuthal<FisheyeLens>),
    /// The panorama of longitude by latitude.
    Equirectangular(Equirectangular),
}

impl ProjectionKind {
    /// The pinhole camera.
    pub const PERSPECTIVE: Self = Self::Perspective(Perspective);
    /// The Omnimax lens.
    pub const OMNIMAX: Self = Self::Omnimax(Azimuthal(OmnimaxLens));
    /// The equidistant fisheye.
    pub const EQUIDISTANT: Self = Self::fisheye(FisheyeLens::EQUIDISTANT);
    /// The panorama.
    pub const EQUIRECTANGULAR: Self = Self::Equirectangular(Equirectangular);

    /// A fisheye lens.
    pub const fn fisheye(lens: FisheyeLens) -> Self {
        Self::Fisheye(Azimuthal(lens))
    }

    /// One of each, for tests and listings.
    pub fn all() -> Vec<Self> {
        let others = [Self::PERSPECTIVE, Self::OMNIMAX, Self::EQUIRECTANGULAR];
        others.into_iter().chain(FisheyeLens::all().into_iter().map(Self::fisheye)).collect()
    }
}

/// Calls a method of the projection that is inside.
macro_rules! each {
    ($kind:expr, $projection:ident => $call:expr) => {
        match $kind {
            ProjectionKind::Perspective($projection) => $call,
            ProjectionKind::Omnimax($projection) => $call,
            ProjectionKind::Fisheye($projection) => $call,
            ProjectionKind::Equirectangular($projection) => $call,
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

    fn has_steep_rim(&self) -> bool {
        each!(self, projection => projection.has_steep_rim())
    }

    fn cap_bounds(&self, centre: Direction, radius: Angle) -> PlaneRect {
        each!(self, projection => projection.cap_bounds(centre, radius))
    }

    fn period(&self) -> Option<f64> {
        each!(self, projection => projection.period())
    }
}
