use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DVec2, DVec3};

use crate::projection::{PlanePoint, PlaneRect, Projection};
use crate::sphere::{Angle, Direction, DirectionJacobian};

/// The panorama: x is the longitude (0 at the front, positive to the right), y the latitude, in radians.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Equirectangular;

impl Projection for Equirectangular {
    fn project(&self, direction: Direction) -> Option<PlanePoint> {
        let vector = direction.vector();
        let latitude = vector.y.atan2(vector.x.hypot(vector.z));
        Some(PlanePoint::new(vector.x.atan2(-vector.z), latitude))
    }

    fn unproject(&self, point: PlanePoint) -> Option<Direction> {
        // Half a pixel row beyond a pole belongs to no direction, but rounding must not lose the pole itself.
        (point.x.is_finite() && point.y.abs() <= FRAC_PI_2 + 1e-12)
            .then(|| Direction::from_longitude_latitude(Angle::from_radians(point.x), Angle::from_radians(point.y)))
    }

    fn unproject_row(&self, first: PlanePoint, step: f64, count: usize, mut visit: impl FnMut(usize, Direction)) {
        if self.unproject(first).is_none() {
            return;
        }
        let (sin_lat, cos_lat) = first.y.sin_cos();
        // Along a row of latitude each direction is the one before, turned: no sine or cosine for each.
        let turn = DVec2::from_angle(step);
        let mut longitude = DVec2::from_angle(first.x);
        for k in 0..count {
            visit(k, Direction::from_unit(DVec3::new(longitude.y * cos_lat, sin_lat, -longitude.x * cos_lat)));
            longitude = turn.rotate(longitude);
        }
    }

    fn jacobian(&self, point: PlanePoint) -> Option<DirectionJacobian> {
        self.unproject_with_jacobian(point).map(|(_, jacobian)| jacobian)
    }

    fn unproject_with_jacobian(&self, point: PlanePoint) -> Option<(Direction, DirectionJacobian)> {
        let direction = self.unproject(point)?;
        let d = direction.vector();
        let (sin_lon, cos_lon) = point.x.sin_cos();
        let cos_lat = point.y.cos();
        let jacobian = DirectionJacobian {
            dx: DVec3::new(cos_lon, 0.0, sin_lon) * cos_lat,
            dy: DVec3::new(-sin_lon * d.y, cos_lat, cos_lon * d.y),
        };
        Some((direction, jacobian))
    }

    fn margin(&self, direction: Direction) -> f64 {
        // The sine of the angle to the nearer pole.
        let vector = direction.vector();
        (vector.x * vector.x + vector.z * vector.z).sqrt()
    }

    fn cap_bounds(&self, centre: Direction, radius: Angle) -> PlaneRect {
        let Some(point) = self.project(centre) else { return PlaneRect::EVERYTHING };
        let (low, high) = (point.y - radius.radians(), point.y + radius.radians());
        let holds_a_pole = low <= -FRAC_PI_2 || high >= FRAC_PI_2;
        let half_width = if holds_a_pole { PI } else { (radius.radians().sin() / point.y.cos()).min(1.0).asin() };
        PlaneRect {
            min: PlanePoint::new(point.x - half_width, low.max(-FRAC_PI_2)),
            max: PlanePoint::new(point.x + half_width, high.min(FRAC_PI_2)),
        }
    }

    fn period(&self) -> Option<f64> {
        Some(TAU)
    }
}
