//! Cylindrical projections: x is the longitude, y a function of the latitude.

mod central;
mod equal_area;
mod equirectangular;
mod mercator;

pub use central::Central;
pub use equal_area::EqualArea;
pub use equirectangular::Equirectangular;
pub use mercator::Mercator;
use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::bounds::lat_lon_box::Graticule;
use super::{PlanePoint, PlaneRect, Projection};
use crate::sphere::{Angle, Direction, DirectionJacobian};

/// Height of a cylindrical projection as a strictly rising function of the latitude.
pub trait Profile {
    /// Returns the height at a latitude; `None` where it is infinite.
    fn height(&self, latitude: Latitude) -> Option<f64>;

    /// Returns the latitude at a height, and its derivative; `None` beyond the poles.
    fn latitude(&self, height: f64) -> Option<(Latitude, f64)>;

    /// Returns the latitude's second derivative at a height; `None` where no closed form is given.
    fn second_derivative(&self, _height: f64) -> Option<f64> {
        None
    }

    /// Returns whether the latitude's derivative grows without bound towards the poles.
    fn has_steep_poles(&self) -> bool {
        false
    }
}

/// A latitude φ, given by its sine and cosine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Latitude {
    /// sin φ.
    pub sin: f64,
    /// cos φ, not negative.
    pub cos: f64,
}

/// The projection of a [`Profile`]: x is the longitude in radians, 0 at the front, positive to the right.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cylindrical<P>(pub P);

impl<P: Profile> Cylindrical<P> {
    fn direction(longitude: DVec2, latitude: Latitude) -> Direction {
        let Latitude { sin, cos } = latitude;
        Direction::from_unit(DVec3::new(longitude.y * cos, sin, -longitude.x * cos))
    }
}

impl<P: Profile> Projection for Cylindrical<P> {
    fn project(&self, direction: Direction) -> Option<PlanePoint> {
        let vector = direction.vector();
        let latitude = Latitude { sin: vector.y, cos: vector.x.hypot(vector.z) };
        Some(PlanePoint::new(vector.x.atan2(-vector.z), self.0.height(latitude)?))
    }

    fn unproject(&self, point: PlanePoint) -> Option<Direction> {
        let (latitude, _) = self.0.latitude(point.y)?;
        point.x.is_finite().then(|| Self::direction(DVec2::from_angle(point.x), latitude))
    }

    fn unproject_row(&self, first: PlanePoint, step: f64, count: usize, mut visit: impl FnMut(usize, Direction)) {
        let Some((latitude, _)) = self.0.latitude(first.y).filter(|_| first.x.is_finite()) else { return };
        // Along a row each direction is the one before, turned, so that no sine or cosine is computed for each.
        let turn = DVec2::from_angle(step);
        let mut longitude = DVec2::from_angle(first.x);
        for k in 0..count {
            visit(k, Self::direction(longitude, latitude));
            longitude = turn.rotate(longitude);
        }
    }

    fn jacobian(&self, point: PlanePoint) -> Option<DirectionJacobian> {
        self.unproject_with_jacobian(point).map(|(_, jacobian)| jacobian)
    }

    fn solid_angle(&self, point: PlanePoint) -> Option<f64> {
        let (latitude, slope) = self.0.latitude(point.y).filter(|_| point.x.is_finite())?;
        Some((latitude.cos * slope).abs())
    }

    fn row_solid_angles(&self, first: PlanePoint, step: f64, count: usize, mut visit: impl FnMut(usize, Option<f64>)) {
        // Along a row all are alike.
        let solid_angle = self.solid_angle(first).filter(|_| step.is_finite());
        (0..count).for_each(|k| visit(k, solid_angle));
    }

    fn unproject_with_jacobian(&self, point: PlanePoint) -> Option<(Direction, DirectionJacobian)> {
        let (latitude, slope) = self.0.latitude(point.y).filter(|_| point.x.is_finite())?;
        let longitude = DVec2::from_angle(point.x);
        let Latitude { sin, cos } = latitude;
        let jacobian = DirectionJacobian {
            dx: DVec3::new(longitude.x, 0.0, longitude.y) * cos,
            dy: DVec3::new(-longitude.y * sin, cos, longitude.x * sin) * slope,
        };
        Some((Self::direction(longitude, latitude), jacobian))
    }

    fn margin(&self, direction: Direction) -> f64 {
        // The sine of the angle to the nearer pole.
        let vector = direction.vector();
        (vector.x * vector.x + vector.z * vector.z).sqrt()
    }

    fn has_steep_rim(&self) -> bool {
        self.0.has_steep_poles()
    }

    fn curvature(&self, point: PlanePoint) -> Option<[DVec2; 3]> {
        // Parallels curve to their pole by sin φ cos φ, and meridians converge by tan φ (the sphere's Christoffel symbols).
        let second = self.0.second_derivative(point.y)?;
        let (Latitude { sin, cos }, slope) = self.0.latitude(point.y)?;
        Some([DVec2::new(0.0, sin * cos / slope), DVec2::new(-sin / cos * slope, 0.0), DVec2::new(0.0, second / slope)])
    }

    fn cap_bounds(&self, centre: Direction, radius: Angle) -> PlaneRect {
        let graticule = Graticule::around(centre, radius);
        let height = |latitude: f64| {
            let (sin, cos) = latitude.sin_cos();
            self.0.height(Latitude { sin, cos: cos.max(0.0) }).unwrap_or(latitude.signum() * f64::INFINITY)
        };
        PlaneRect {
            min: PlanePoint::new(graticule.west, height(graticule.south)),
            max: PlanePoint::new(graticule.east, height(graticule.north)),
        }
    }

    fn period(&self) -> Option<f64> {
        Some(TAU)
    }
}
