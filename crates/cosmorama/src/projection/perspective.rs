use super::{PlanePoint, PlaneRect, Projection};
use crate::sphere::{Angle, Direction, DirectionJacobian};

/// The pinhole camera: x and y are tangents of the angles from the axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Perspective;

/// Directions closer than this (as a sine) to the plane of the pinhole have no image.
const HORIZON: f64 = 1e-9;

impl Projection for Perspective {
    fn project(&self, direction: Direction) -> Option<PlanePoint> {
        let vector = direction.vector();
        let depth = -vector.z;
        (depth > HORIZON).then(|| PlanePoint::new(vector.x / depth, vector.y / depth))
    }

    fn unproject(&self, point: PlanePoint) -> Option<Direction> {
        Direction::new(glam::DVec3::new(point.x, point.y, -1.0))
    }

    fn jacobian(&self, point: PlanePoint) -> Option<DirectionJacobian> {
        // d = v/|v| with v = (x, y, −1), so ∂d/∂x = (e_x − d (d·e_x))/|v|.
        let vector = glam::DVec3::new(point.x, point.y, -1.0);
        let inverse_length = vector.length_recip();
        if !(inverse_length > 0.0) {
            return None;
        }
        let unit = vector * inverse_length;
        Some(DirectionJacobian {
            dx: (glam::DVec3::X - unit * unit.x) * inverse_length,
            dy: (glam::DVec3::Y - unit * unit.y) * inverse_length,
        })
    }

    fn margin(&self, direction: Direction) -> Angle {
        Angle::from_radians((-direction.vector().z).clamp(-1.0, 1.0).asin())
    }

    fn cap_bounds(&self, centre: Direction, radius: Angle) -> PlaneRect {
        let vector = centre.vector();
        let (min_x, max_x) = tangent_range(vector.x, -vector.z, radius);
        let (min_y, max_y) = tangent_range(vector.y, -vector.z, radius);
        PlaneRect { min: PlanePoint::new(min_x, min_y), max: PlanePoint::new(max_x, max_y) }
    }
}

/// The tangents between which a cap lies, seen along one axis of the plane: the planes through the other axis that
/// touch the cap stand at asin(sin ρ / m) to both sides of its centre, m being the centre's distance from that axis.
fn tangent_range(across: f64, depth: f64, radius: Angle) -> (f64, f64) {
    let sine = radius.radians().sin() / across.hypot(depth);
    if !(sine < 1.0) || radius.degrees() >= 90.0 {
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
