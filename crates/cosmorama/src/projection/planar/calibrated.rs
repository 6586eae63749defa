use glam::{DVec2, DVec3};

use crate::projection::{PlanePoint, PlaneRect, Projection};
use crate::sphere::{Angle, Direction, DirectionJacobian};

/// A calibrated camera: its sensor's rows may be skewed, and its field of view ends at a cone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Calibrated<P> {
    camera: P,
    /// Skew: shift to the right for each unit downwards.
    skew: f64,
    /// Greatest angle from the axis, in radians.
    limit: f64,
    /// Whether the limit is so close to the fold of the lens formula that derivatives grow without bound.
    is_steep: bool,
    /// Greatest distance from the middle at which anything inside the limit is seen.
    outermost: f64,
}

/// Bearings that are sampled for the greatest distance.
const BEARINGS: usize = 256;

/// Factor that covers the distances between sampled bearings.
const SPARE: f64 = 1.001;

/// Angle, in radians, from the fold of a lens formula beyond which its derivatives are moderate.
const TAME: f64 = 0.02;

impl<P: Projection> Calibrated<P> {
    /// Returns a camera with a skew, in units of x per unit of y downwards, and a field of view of `limit` from its
    /// axis.
    pub fn new(camera: P, skew: f64, limit: Angle) -> Self {
        let (sin, cos) = limit.sin_cos();
        let rim = Direction::from_unit(DVec3::new(sin, 0.0, -cos));
        let is_steep = camera.has_steep_rim() && camera.margin(rim) < TAME;
        let outermost = outermost(&camera, limit);
        Self { camera, skew, limit: limit.radians(), is_steep, outermost }
    }

    /// Returns the point with the skew removed; `None` if it is outside the field of view.
    fn upright(&self, point: PlanePoint) -> Option<PlanePoint> {
        let upright = PlanePoint::new(point.x + self.skew * point.y, point.y);
        (upright.x.hypot(upright.y) <= self.outermost).then_some(upright)
    }

    fn skewed(&self, point: PlanePoint) -> PlanePoint {
        PlanePoint::new(point.x - self.skew * point.y, point.y)
    }

    fn is_within(&self, direction: Direction) -> bool {
        direction.angle_to(Direction::FRONT).radians() <= self.limit
    }
}

/// Returns the greatest distance from the middle at which a camera shows a given angle from its axis; infinite if it
/// does not.
fn outermost(camera: &impl Projection, angle: Angle) -> f64 {
    let (sin, cos) = angle.sin_cos();
    let radius = |k: usize| {
        let (y, x) = (k as f64 / BEARINGS as f64 * std::f64::consts::TAU).sin_cos();
        let point = camera.project(Direction::from_unit(DVec3::new(sin * x, sin * y, -cos)))?;
        Some(point.x.hypot(point.y))
    };
    let farthest = (0..BEARINGS).map(radius).try_fold(0.0f64, |farthest, radius| Some(farthest.max(radius?)));
    farthest.map_or(f64::INFINITY, |farthest| farthest * SPARE)
}

impl<P: Projection> Projection for Calibrated<P> {
    fn project(&self, direction: Direction) -> Option<PlanePoint> {
        self.camera.project(direction).filter(|_| self.is_within(direction)).map(|point| self.skewed(point))
    }

    fn unproject(&self, point: PlanePoint) -> Option<Direction> {
        self.camera.unproject(self.upright(point)?).filter(|direction| self.is_within(*direction))
    }

    fn jacobian(&self, point: PlanePoint) -> Option<DirectionJacobian> {
        self.unproject_with_jacobian(point).map(|(_, jacobian)| jacobian)
    }

    fn unproject_with_jacobian(&self, point: PlanePoint) -> Option<(Direction, DirectionJacobian)> {
        let (direction, jacobian) = self.camera.unproject_with_jacobian(self.upright(point)?)?;
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

    fn ends_at_cone(&self) -> bool {
        true
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
