use std::f64::consts::SQRT_2;

use glam::DVec3;

use crate::projection::bounds::lat_lon_box::Graticule;
use crate::projection::bounds::meridian;
use crate::projection::{Outline, PlanePoint, PlaneRect, Projection};
use crate::sphere::{Angle, Direction, DirectionJacobian};

/// Hammer's map, in an ellipse with semi-axes 2√2 and √2: Lambert's equal-area view of a hemisphere, in which
/// longitudes are halved and the picture is stretched to twice its width. Areas are proportional to solid angles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Hammer;

/// Squared radius of the hemisphere's edge, with a tolerance for rounding.
const EDGE: f64 = 2.0 + 1e-9;

/// A unit direction whose longitude is halved, by its components `right`, `up` and `ahead`.
struct Halved {
    right: f64,
    up: f64,
    ahead: f64,
}

impl Halved {
    /// Returns cos φ.
    fn across(&self) -> f64 {
        self.right.hypot(self.ahead)
    }

    /// Returns cosine and sine of the halved longitude; at the poles any longitude will do.
    fn longitude(&self) -> (f64, f64) {
        let across = self.across();
        if across > 0.0 { (self.ahead / across, self.right / across) } else { (1.0, 0.0) }
    }

    /// Returns the direction with the full longitude.
    fn doubled(&self) -> Direction {
        let (across, (cos, sin)) = (self.across(), self.longitude());
        Direction::from_unit(DVec3::new(2.0 * cos * sin * across, self.up, (sin * sin - cos * cos) * across))
    }

    /// Returns the change of the full direction for a change of `right`, `up` and `ahead`. With q = cos φ, X = 2 right
    /// ahead/q and Z = (right² − ahead²)/q.
    fn doubled_moves(&self, right: f64, up: f64, ahead: f64) -> DVec3 {
        let (cos, sin) = self.longitude();
        DVec3::new(
            2.0 * (cos * cos * cos * right + sin * sin * sin * ahead),
            up,
            sin * (3.0 * cos * cos + sin * sin) * right - cos * (3.0 * sin * sin + cos * cos) * ahead,
        )
    }
}

impl Projection for Hammer {
    fn project(&self, direction: Direction) -> Option<PlanePoint> {
        let vector = direction.vector();
        let across = vector.x.hypot(vector.z);
        let (sin, cos) = (vector.x.atan2(-vector.z) / 2.0).sin_cos();
        let scale = SQRT_2 / (1.0 + across * cos).sqrt();
        Some(PlanePoint::new(2.0 * across * sin * scale, vector.y * scale))
    }

    fn unproject(&self, point: PlanePoint) -> Option<Direction> {
        let (x, y) = (point.x / 2.0, point.y);
        let radius2 = x * x + y * y;
        (radius2 <= EDGE).then(|| {
            let scale = (1.0 - radius2 / 4.0).sqrt();
            Halved { right: x * scale, up: y * scale, ahead: 1.0 - radius2 / 2.0 }.doubled()
        })
    }

    fn jacobian(&self, point: PlanePoint) -> Option<DirectionJacobian> {
        self.unproject_with_jacobian(point).map(|(_, jacobian)| jacobian)
    }

    fn unproject_with_jacobian(&self, point: PlanePoint) -> Option<(Direction, DirectionJacobian)> {
        let (x, y) = (point.x / 2.0, point.y);
        let radius2 = x * x + y * y;
        (radius2 <= EDGE).then(|| {
            let scale = (1.0 - radius2 / 4.0).sqrt();
            let halved = Halved { right: x * scale, up: y * scale, ahead: 1.0 - radius2 / 2.0 };
            let quarter = (4.0 * scale).recip();
            let dx = halved.doubled_moves(scale - x * x * quarter, -x * y * quarter, -x) / 2.0;
            let dy = halved.doubled_moves(-x * y * quarter, scale - y * y * quarter, -y);
            (halved.doubled(), DirectionJacobian { dx, dy })
        })
    }

    fn margin(&self, direction: Direction) -> f64 {
        meridian::distance_to_the_one_behind(direction)
    }

    fn beyond_seam(&self, direction: Direction) -> Option<Direction> {
        Some(meridian::mirrored(direction))
    }

    fn cap_bounds(&self, centre: Direction, radius: Angle) -> PlaneRect {
        self.cap_outline(centre, radius).bounds()
    }

    fn cap_outline(&self, centre: Direction, radius: Angle) -> Outline {
        let place = |longitude: f64, latitude: f64| {
            let ((sin_lon, cos_lon), (sin_lat, cos_lat)) = ((longitude / 2.0).sin_cos(), latitude.sin_cos());
            let scale = SQRT_2 / (1.0 + cos_lat * cos_lon).sqrt();
            PlanePoint::new(2.0 * cos_lat * sin_lon * scale, sin_lat * scale)
        };
        let parts = Graticule::around(centre, radius).parts();
        Outline::Rects(parts.into_iter().map(|part| part.bounds(place)).collect())
    }
}
