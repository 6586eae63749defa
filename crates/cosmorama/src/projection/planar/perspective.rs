use glam::{DVec2, DVec3};

use crate::projection::{PlanePoint, PlaneRect, Projection};
use crate::sphere::{Angle, Direction, DirectionJacobian};

/// The pinhole camera: x and y are tangents of the angles from the axis. As a map it is called gnomonic (J. P. Snyder,
/// *Map Projections: A Working Manual*, USGS Professional Paper 1395, 1987, chapter 22).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Perspective;

/// Sine of the angle to the pinhole's plane below which directions have no image.
const HORIZON: f64 = 1e-9;

impl Projection for Perspective {
    fn project(&self, direction: Direction) -> Option<PlanePoint> {
        let vector = direction.vector();
        let depth = -vector.z;
        (depth > HORIZON).then(|| PlanePoint::new(vector.x / depth, vector.y / depth))
    }

    fn unproject(&self, point: PlanePoint) -> Option<Direction> {
        Direction::new(DVec3::new(point.x, point.y, -1.0))
    }

    fn jacobian(&self, point: PlanePoint) -> Option<DirectionJacobian> {
        self.unproject_with_jacobian(point).map(|(_, jacobian)| jacobian)
    }

    fn solid_angle(&self, point: PlanePoint) -> Option<f64> {
        // The area of the plane at distance |v|, seen at an angle whose cosine is 1/|v|.
        let length_squared = 1.0 + point.x * point.x + point.y * point.y;
        Some(1.0 / (length_squared * length_squared.sqrt())).filter(|solid_angle| *solid_angle > 0.0)
    }

    fn unproject_with_jacobian(&self, point: PlanePoint) -> Option<(Direction, DirectionJacobian)> {
        // d = v/|v| with v = (x, y, −1), so ∂d/∂x = (e_x − d (d·e_x))/|v|.
        let vector = DVec3::new(point.x, point.y, -1.0);
        let inverse_length = vector.length_recip();
        // Beyond 1e154 the length overflows.
        if inverse_length.is_nan() || inverse_length <= 0.0 {
            return None;
        }
        let unit = vector * inverse_length;
        let jacobian = DirectionJacobian {
            dx: (DVec3::X - unit * unit.x) * inverse_length,
            dy: (DVec3::Y - unit * unit.y) * inverse_length,
        };
        Some((Direction::from_unit(unit), jacobian))
    }

    fn project_with_derivatives(&self, direction: Direction, tangents: [DVec3; 2]) -> Option<(PlanePoint, [DVec2; 2])> {
        let point = self.project(direction)?;
        // x = X/depth with depth = −Z, so dx = (dX + x dZ)/depth.
        let inverse_depth = -direction.vector().z.recip();
        let moved = |t: DVec3| DVec2::new(t.x + point.x * t.z, t.y + point.y * t.z) * inverse_depth;
        Some((point, tangents.map(moved)))
    }

    fn curvature(&self, point: PlanePoint) -> Option<[DVec2; 3]> {
        // With d = v/|v|, the part of ∂²d/∂i∂j in the tangent plane is −(i ∂d/∂j + j ∂d/∂i)/|v|².
        let bent = DVec2::new(point.x, point.y) * -(1.0 + point.x * point.x + point.y * point.y).recip();
        Some([DVec2::new(2.0 * bent.x, 0.0), DVec2::new(bent.y, bent.x), DVec2::new(0.0, 2.0 * bent.y)])
    }

    fn margin(&self, direction: Direction) -> f64 {
        // The sine of the angle above the horizon.
        -direction.vector().z
    }

    fn cap_bounds(&self, centre: Direction, radius: Angle) -> PlaneRect {
        let vector = centre.vector();
        let (min_x, max_x) = tangent_range(vector.x, -vector.z, radius);
        let (min_y, max_y) = tangent_range(vector.y, -vector.z, radius);
        PlaneRect { min: PlanePoint::new(min_x, min_y), max: PlanePoint::new(max_x, max_y) }
    }
}

/// Returns the range of tangents of a cap along one axis of the plane. The planes through the other axis that touch the
/// cap are at asin(sin ρ / m) to both sides of its centre, where m is the centre's distance from that axis.
fn tangent_range(across: f64, depth: f64, radius: Angle) -> (f64, f64) {
    let sine = radius.radians().sin() / across.hypot(depth);
    if sine.is_nan() || sine >= 1.0 || radius.degrees() >= 90.0 {
        return (f64::NEG_INFINITY, f64::INFINITY);
    }
    let (angle, half_width) = (across.atan2(depth), sine.asin());
    let tangent = |angle: f64| {
        if angle <= -std::f64::consts::FRAC_PI_2 {
            f64::NEG_INFINITY
        } else if angle >= std::f64::consts::FRAC_PI_2 {
            f64::INFINITY
        } else {
            angle.tan()
        }
    };
    (tangent(angle - half_width), tangent(angle + half_width))
}
