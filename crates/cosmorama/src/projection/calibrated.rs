use glam::{DVec2, DVec3};

use super::{PlanePoint, PlaneRect, Projection};
use crate::sphere::{Angle, Direction, DirectionJacobian};

/// A camera as it was measured: its sensor's rows may lean (skew), and its field of view ends at a cone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Calibrated<P> {
    camera: P,
    /// How far to the right a point lies for each unit that it lies lower.
    skew: f64,
    /// Greatest angle from the axis, in radians.
    limit: f64,
    /// Whether that is so near to where the lens's picture turns back that derivatives grow without bound.
    is_steep: bool,
}

/// Further than this, in radians, from where a lens's picture turns back its derivatives are tame.
const TAME: f64 = 0.02;

impl<P: Projection> Calibrated<P> {
    /// A camera with a skew, in units of x a unit of y downwards, that shows what is at most `limit` from its axis.
    pub fn new(camera: P, skew: f64, limit: Angle) -> Self {
        let (sin, cos) = limit.sin_cos();
        let rim = Direction::from_unit(DVec3::new(sin, 0.0, -cos));
        let is_steep = camera.has_steep_rim() && camera.margin(rim) < TAME;
        Self { camera, skew, limit: limit.radians(), is_steep }
    }

    fn upright(&self, point: PlanePoint) -> PlanePoint {
        PlanePoint::new(point.x + self.skew * point.y, point.y)
    }

    fn skewed(&self, point: PlanePoint) -> PlanePoint {
        PlanePoint::new(point.x - self.skew * point.y, point.y)
    }

    fn is_within(&self, direction: Direction) -> bool {
        direction.angle_to(Direction::FRONT).radians() <= self.limit
    }
}

impl<P: Projection> Projection for Calibrated<P> {
    fn project(&self, direction: Direction) -> Option<PlanePoint> {
        self.camera.project(direction).filter(|_| self.is_within(direction)).map(|point| self.skewed(point))
    }

    fn unproject(&self, point: PlanePoint) -> Option<Direction> {
        self.camera.unproject(self.upright(point)).filter(|direction| self.is_within(*direction))
    }

    fn jacobian(&self, point: PlanePoint) -> Option<DirectionJacobian> {
        self.unproject_with_jacobian(point).map(|(_, jacobian)| jacobian)
    }

    fn unproject_with_jacobian(&self, point: PlanePoint) -> Option<(Direction, DirectionJacobian)> {
        let (direction, jacobian) = self.camera.unproject_with_jacobian(self.upright(point))?;
        let DirectionJacobian { dx, dy } = jacobian;
        self.is_within(direction).then(|| (direction, DirectionJacobian { dx, dy: dy + dx * self.skew }))
    }

    fn project_with_derivatives(&self, direction: Direction, tangents: [DVec3; 2]) -> Option<(PlanePoint, [DVec2; 2])> {
        let (point, moved) = self.camera.project_with_derivatives(direction, tangents)?;
        let skewed = |moved: DVec2| DVec2::new(moved.x - self.skew * moved.y, moved.y);
        self.is_within(direction).then(|| (self.skewed(point), moved.map(skewed)))
    }

    fn margin(&self, direction: Direction) -> f64 {
        self.camera.margin(direction).min(self.limit - direction.angle_to(Direction::FRONT).radians())
    }

    fn has_steep_rim(&self) -> bool {
        self.is_steep
    }

    fn cap_bounds(&self, centre: Direction, radius: Angle) -> PlaneRect {
        let PlaneRect { min, max } = self.camera.cap_bounds(centre, radius);
        if self.skew == 0.0 {
            return PlaneRect { min, max };
        }
        let corners = [min, max, PlanePoint::new(min.x, max.y), PlanePoint::new(max.x, min.y)];
        let [first, rest @ ..] = corners.map(|corner| self.skewed(corner));
        rest.into_iter().fold(PlaneRect { min: first, max: first }, PlaneRect::with)
    }
}
