use std::f64::consts::{FRAC_PI_2, TAU};

use glam::{DVec2, DVec3};

use crate::projection::bounds::lat_lon_box::Graticule;
use crate::projection::bounds::meridian;
use crate::projection::{PlanePoint, PlaneRect, Projection};
use crate::sphere::{Angle, Direction, DirectionJacobian};

/// The general Pannini projection (Sharpless, Postle & German 2010): a picture on a cylinder, seen from the distance d
/// behind its axis. x = S sin λ and y = S tan φ with S = (d + 1)/(d + cos λ). d = 0 is the pinhole camera, d = 1
/// Pannini's own view, and a very large d the orthographic cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pannini {
    distance: f64,
    /// Cosine and sine of the longitude at which x goes to infinity (d < 1) or turns back (d > 1).
    limit: DVec2,
}

/// Greatest distance of a point with a direction; beyond it squares overflow.
const FURTHEST: f64 = 1e100;

/// Discriminant below which there is no derivative: it vanishes where x turns back.
const RIM: f64 = 1e-20;

impl Pannini {
    /// Returns the projection seen from this distance, 0 or more; `None` for others.
    pub fn from_distance(distance: f64) -> Option<Self> {
        let is_distance = (0.0..=1e6).contains(&distance);
        let cos = -if distance <= 1.0 { distance } else { distance.recip() };
        is_distance.then(|| Self { distance, limit: DVec2::new(cos, ((1.0 - cos) * (1.0 + cos)).sqrt()) })
    }

    /// Returns the longitude that bounds the picture.
    pub fn limit(&self) -> Angle {
        Angle::from_radians(self.limit.y.atan2(self.limit.x))
    }

    /// Returns S at a longitude given by its cosine and sine.
    fn scale(&self, cos: f64, sin: f64) -> f64 {
        // 1 + cos λ without its loss of digits behind.
        let versed = if cos < 0.0 { sin * sin / (1.0 - cos) } else { 1.0 + cos };
        (self.distance + 1.0) / (self.distance - 1.0 + versed)
    }

    /// Returns bounds of a cap that holds a pole or touches the limiting longitude; they are infinite on that side.
    fn singular_bounds(&self, centre: Direction, radius: f64) -> PlaneRect {
        let (longitude, latitude) = centre.longitude_latitude();
        let (longitude, latitude) = (longitude.radians(), latitude.radians());
        let PlaneRect { mut min, mut max } = PlaneRect::EVERYTHING;
        // |y| is S |tan φ|, and S at least 1.
        let lowest = latitude.abs() - radius;
        if lowest > 0.0 {
            if latitude > 0.0 { min.y = lowest.tan() } else { max.y = -lowest.tan() }
        }
        // A cap around a pole has all longitudes. In others |x| rises with |λ| to the limit, unless the cap reaches the
        // other limit.
        let half_width = (radius.sin() / latitude.cos()).asin();
        let (least, limit) = (longitude.abs() - half_width, self.limit().radians());
        if latitude.abs() + radius < FRAC_PI_2 && least > 0.0 && longitude.abs() + half_width < TAU - limit {
            let least = self.across(Angle::from_radians(least.min(limit)));
            if longitude > 0.0 { min.x = least } else { max.x = -least }
        }
        PlaneRect { min, max }
    }

    /// Returns x at a longitude, even where nothing is seen.
    pub fn across(&self, longitude: Angle) -> f64 {
        let (sin, cos) = longitude.sin_cos();
        self.scale(cos, sin) * sin
    }
}

impl Projection for Pannini {
    fn project(&self, direction: Direction) -> Option<PlanePoint> {
        let vector = direction.vector();
        let across = vector.x.hypot(vector.z);
        let (sin, cos) = (vector.x / across, -vector.z / across);
        let is_shown = across > 0.0 && cos > self.limit.x;
        let scale = self.scale(cos, sin);
        is_shown.then(|| PlanePoint::new(scale * sin, scale * vector.y / across))
    }

    fn unproject(&self, point: PlanePoint) -> Option<Direction> {
        self.unproject_with_jacobian(point).map(|(direction, _)| direction)
    }

    fn jacobian(&self, point: PlanePoint) -> Option<DirectionJacobian> {
        self.unproject_with_jacobian(point).map(|(_, jacobian)| jacobian)
    }

    fn unproject_with_jacobian(&self, point: PlanePoint) -> Option<(Direction, DirectionJacobian)> {
        // (1 + k) cos² λ + 2 k d cos λ + k d² − 1 = 0, k = (x/(d + 1))²; its discriminant is 1 + k − k d².
        let d = self.distance;
        let k = (point.x / (d + 1.0)).powi(2);
        let root2 = 1.0 + k * (1.0 - d) * (1.0 + d);
        if root2.is_nan() || root2 < RIM || point.x.abs() > FURTHEST {
            return None;
        }
        let root = root2.sqrt();
        let cos = (root - k * d) / (1.0 + k);
        // d + cos λ and 1 + d cos λ, without their loss of digits.
        let (sum, versed) = ((root + d) / (1.0 + k), root * (root + d) / (1.0 + k));
        let scale = (d + 1.0) / sum;
        let sin = point.x / scale;
        let tangent = point.y / scale;
        let cos_latitude = (1.0 + tangent * tangent).sqrt().recip();
        if tangent.is_nan() || tangent.abs() > FURTHEST {
            return None;
        }
        let sin_latitude = tangent * cos_latitude;
        // ∂x/∂λ = (d + 1)(1 + d cos λ)/(d + cos λ)², ∂S/∂λ = S sin λ/(d + cos λ), and dφ = cos² φ d tan φ.
        let turn = sum / (scale * versed);
        let rise = -tangent * sin / sum * turn;
        let east = DVec3::new(cos, 0.0, sin) * cos_latitude;
        let north = DVec3::new(-sin * sin_latitude, cos_latitude, cos * sin_latitude) * (cos_latitude * cos_latitude);
        let jacobian = DirectionJacobian { dx: east * turn + north * rise, dy: north / scale };
        let direction = DVec3::new(sin * cos_latitude, sin_latitude, -cos * cos_latitude);
        Some((Direction::from_unit(direction), jacobian))
    }

    fn margin(&self, direction: Direction) -> f64 {
        let vector = direction.vector();
        let pole = DVec2::new(vector.x, vector.z).length();
        pole.min(meridian::distance_to_the_two_at(self.limit, direction))
    }

    fn has_steep_rim(&self) -> bool {
        self.distance > 1.0
    }

    fn cap_bounds(&self, centre: Direction, radius: Angle) -> PlaneRect {
        if self.margin(centre) <= radius.radians() {
            return self.singular_bounds(centre, radius.radians());
        }
        Graticule::around(centre, radius).bounds(|longitude, latitude| {
            let (sin, cos) = longitude.sin_cos();
            let scale = self.scale(cos, sin);
            PlanePoint::new(scale * sin, scale * latitude.tan())
        })
    }
}
