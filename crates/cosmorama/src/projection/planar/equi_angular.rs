use std::f64::consts::FRAC_PI_2;

use glam::{DVec2, DVec3};

use crate::projection::{Perspective, PlanePoint, PlaneRect, Projection};
use crate::sphere::{Angle, Direction, DirectionJacobian};

/// A face of an equi-angular cube map: x and y are angles from the axis in radians, where a pinhole camera has their
/// tangents. The pixels of a face of 90° are more uniform in size than a pinhole camera's (C. Brown, *Bringing pixels
/// front and center in VR video*, Google, 2017).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EquiAngular;

/// Sine of the angle to the horizon below which directions have no image. The horizon's image is in the four corners of
/// a square, around which the mapping bends without bound. The corners of a face of 90° are at 0.577.
const HORIZON: f64 = 0.125;

impl Projection for EquiAngular {
    fn project(&self, direction: Direction) -> Option<PlanePoint> {
        let vector = direction.vector();
        let depth = -vector.z;
        (depth > HORIZON).then(|| PlanePoint::new(vector.x.atan2(depth), vector.y.atan2(depth)))
    }

    fn unproject(&self, point: PlanePoint) -> Option<Direction> {
        self.unproject_with_jacobian(point).map(|(direction, _)| direction)
    }

    fn jacobian(&self, point: PlanePoint) -> Option<DirectionJacobian> {
        self.unproject_with_jacobian(point).map(|(_, jacobian)| jacobian)
    }

    fn unproject_with_jacobian(&self, point: PlanePoint) -> Option<(Direction, DirectionJacobian)> {
        if !(point.x.abs() < FRAC_PI_2 && point.y.abs() < FRAC_PI_2) {
            return None;
        }
        let tangent = PlanePoint::new(point.x.tan(), point.y.tan());
        let (direction, jacobian) = Perspective.unproject_with_jacobian(tangent)?;
        // d tan x/dx = 1 + tan² x.
        let slope = |tangent: f64| 1.0 + tangent * tangent;
        let jacobian = DirectionJacobian { dx: jacobian.dx * slope(tangent.x), dy: jacobian.dy * slope(tangent.y) };
        (-direction.vector().z > HORIZON).then_some((direction, jacobian))
    }

    fn project_with_derivatives(&self, direction: Direction, tangents: [DVec3; 2]) -> Option<(PlanePoint, [DVec2; 2])> {
        let point = self.project(direction)?;
        // x = atan(X/depth) with depth = −Z, so dx = (depth dX + X dZ)/(X² + depth²).
        let d = direction.vector();
        let moved = |t: DVec3, across: f64, along: f64| (d.z * along - across * t.z) / -(across * across + d.z * d.z);
        Some((point, tangents.map(|t| DVec2::new(moved(t, d.x, t.x), moved(t, d.y, t.y)))))
    }

    fn margin(&self, direction: Direction) -> f64 {
        // The difference of two sines is no greater than that of their angles.
        -direction.vector().z - HORIZON
    }

    fn cap_bounds(&self, centre: Direction, radius: Angle) -> PlaneRect {
        let vector = centre.vector();
        let (min_x, max_x) = angle_range(vector.x, -vector.z, radius);
        let (min_y, max_y) = angle_range(vector.y, -vector.z, radius);
        PlaneRect { min: PlanePoint::new(min_x, min_y), max: PlanePoint::new(max_x, max_y) }
    }
}

/// Returns the range of angles of a cap along one axis of the plane: that of [`Perspective`], as angles.
fn angle_range(across: f64, depth: f64, radius: Angle) -> (f64, f64) {
    let sine = radius.radians().sin() / across.hypot(depth);
    if sine.is_nan() || sine >= 1.0 || radius.degrees() >= 90.0 {
        return (-FRAC_PI_2, FRAC_PI_2);
    }
    let (angle, half_width) = (across.atan2(depth), sine.asin());
    ((angle - half_width).max(-FRAC_PI_2), (angle + half_width).min(FRAC_PI_2))
}
