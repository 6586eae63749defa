use glam::{DVec2, DVec3};

use super::{Azimuthal, BallLens};
use crate::projection::{Outline, PlanePoint, PlaneRect, Projection};
use crate::sphere::{Angle, Direction, DirectionJacobian};

/// A mirror ball as photographed; the plane's unit is the radius of the ball's outline. The middle shows the
/// photographer, the rim shows the world straight ahead, and text is mirrored.
///
/// The angle from the direction back to the camera is a function of the radius ([`BallLens`]). The picture is that of
/// such a lens in a world whose front and back are exchanged. On the use of such photographs see P. Debevec, *Rendering
/// synthetic objects into real scenes* (SIGGRAPH '98). The formula is the law of reflection on a sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MirrorBall(Azimuthal<BallLens>);

impl MirrorBall {
    /// The ball as seen by a distant camera.
    pub const DISTANT: Self = Self(Azimuthal(BallLens::DISTANT));

    /// Returns the ball as seen from a distance between camera and ball centre, in ball radii; `None` unless it exceeds
    /// 1.
    pub fn from_distance(distance: f64) -> Option<Self> {
        BallLens::from_distance(distance).map(|lens| Self(Azimuthal(lens)))
    }
}

/// Exchanges front and back.
fn exchanged(vector: DVec3) -> DVec3 {
    DVec3::new(vector.x, vector.y, -vector.z)
}

fn turned(direction: Direction) -> Direction {
    Direction::from_unit(exchanged(direction.vector()))
}

impl Projection for MirrorBall {
    fn project(&self, direction: Direction) -> Option<PlanePoint> {
        self.0.project(turned(direction))
    }

    fn unproject(&self, point: PlanePoint) -> Option<Direction> {
        self.0.unproject(point).map(turned)
    }

    fn jacobian(&self, point: PlanePoint) -> Option<DirectionJacobian> {
        self.unproject_with_jacobian(point).map(|(_, jacobian)| jacobian)
    }

    fn unproject_with_jacobian(&self, point: PlanePoint) -> Option<(Direction, DirectionJacobian)> {
        let (direction, jacobian) = self.0.unproject_with_jacobian(point)?;
        let jacobian = DirectionJacobian { dx: exchanged(jacobian.dx), dy: exchanged(jacobian.dy) };
        Some((turned(direction), jacobian))
    }

    fn project_with_derivatives(&self, direction: Direction, tangents: [DVec3; 2]) -> Option<(PlanePoint, [DVec2; 2])> {
        self.0.project_with_derivatives(turned(direction), tangents.map(exchanged))
    }

    fn margin(&self, direction: Direction) -> f64 {
        self.0.margin(turned(direction))
    }

    fn has_steep_rim(&self) -> bool {
        true
    }

    fn cap_bounds(&self, centre: Direction, radius: Angle) -> PlaneRect {
        self.0.cap_bounds(turned(centre), radius)
    }

    fn cap_outline(&self, centre: Direction, radius: Angle) -> Outline {
        self.0.cap_outline(turned(centre), radius)
    }
}
