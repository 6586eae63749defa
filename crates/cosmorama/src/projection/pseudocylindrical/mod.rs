//! Oval maps of the whole world with straight parallels: x is proportional to the longitude.

mod mollweide;
mod sinusoidal;

pub use mollweide::Mollweide;
pub use sinusoidal::Sinusoidal;
use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::bounds::lat_lon_box::Graticule;
use super::bounds::meridian;
use super::cylindrical::Latitude;
use super::{Outline, PlanePoint, PlaneRect, Projection};
use crate::sphere::{Angle, Direction, DirectionJacobian};

/// Positions of a map's parallels.
pub trait Parallels {
    /// Returns the height of a parallel, and its half width divided by π.
    fn place(&self, latitude: Latitude) -> (f64, f64);

    /// Returns the parallel at a height; `None` beyond the poles.
    fn at(&self, height: f64) -> Option<Parallel>;

    /// Returns whether the latitude's derivative grows without bound towards the poles.
    fn has_steep_poles(&self) -> bool {
        false
    }
}

/// A parallel of a map, with its derivatives along the height y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parallel {
    /// Latitude φ of the parallel.
    pub latitude: Latitude,
    /// x divided by the longitude, never 0.
    pub width: f64,
    /// dφ/dy.
    pub latitude_slope: f64,
    /// d width/dy.
    pub width_slope: f64,
}

/// The projection of [`Parallels`]: x is the longitude in radians times the parallel's width.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pseudocylindrical<M>(pub M);

/// Tolerance for rounding: a longitude this far beyond 180° is on the map's edge.
const ROUNDING: f64 = 1e-9;

fn is_on_the_map(longitude: f64) -> bool {
    longitude.abs() <= PI + ROUNDING
}

fn direction(longitude: DVec2, latitude: Latitude) -> Direction {
    let Latitude { sin, cos } = latitude;
    Direction::from_unit(DVec3::new(longitude.y * cos, sin, -longitude.x * cos))
}

impl<M: Parallels> Projection for Pseudocylindrical<M> {
    fn project(&self, direction: Direction) -> Option<PlanePoint> {
        let vector = direction.vector();
        let (height, width) = self.0.place(Latitude { sin: vector.y, cos: vector.x.hypot(vector.z) });
        Some(PlanePoint::new(vector.x.atan2(-vector.z) * width, height))
    }

    fn unproject(&self, point: PlanePoint) -> Option<Direction> {
        let parallel = self.0.at(point.y)?;
        let longitude = point.x / parallel.width;
        is_on_the_map(longitude).then(|| direction(DVec2::from_angle(longitude), parallel.latitude))
    }

    fn unproject_row(&self, first: PlanePoint, step: f64, count: usize, mut visit: impl FnMut(usize, Direction)) {
        let Some(parallel) = self.0.at(first.y) else { return };
        let longitude = |k: usize| (first.x + k as f64 * step) / parallel.width;
        let Some(start) = (0..count).find(|&k| is_on_the_map(longitude(k))) else { return };
        // Along a parallel each direction is the one before, turned, so that no sine or cosine is computed for each.
        let turn = DVec2::from_angle(step / parallel.width);
        let mut here = DVec2::from_angle(longitude(start));
        for k in (start..count).take_while(|&k| is_on_the_map(longitude(k))) {
            visit(k, direction(here, parallel.latitude));
            here = turn.rotate(here);
        }
    }

    fn jacobian(&self, point: PlanePoint) -> Option<DirectionJacobian> {
        self.unproject_with_jacobian(point).map(|(_, jacobian)| jacobian)
    }

    fn unproject_with_jacobian(&self, point: PlanePoint) -> Option<(Direction, DirectionJacobian)> {
        let parallel = self.0.at(point.y)?;
        let longitude = point.x / parallel.width;
        let turned = DVec2::from_angle(longitude);
        let Latitude { sin, cos } = parallel.latitude;
        // λ = x/width, so ∂λ/∂x = 1/width and ∂λ/∂y = −λ width′/width.
        let east = DVec3::new(turned.x, 0.0, turned.y) * (cos / parallel.width);
        let north = DVec3::new(-turned.y * sin, cos, turned.x * sin);
        let jacobian = DirectionJacobian {
            dx: east,
            dy: north * parallel.latitude_slope - east * (longitude * parallel.width_slope),
        };
        is_on_the_map(longitude).then(|| (direction(turned, parallel.latitude), jacobian))
    }

    fn margin(&self, direction: Direction) -> f64 {
        meridian::distance_to_the_one_behind(direction)
    }

    fn has_steep_rim(&self) -> bool {
        self.0.has_steep_poles()
    }

    fn beyond_seam(&self, direction: Direction) -> Option<Direction> {
        Some(meridian::mirrored(direction))
    }

    fn cap_bounds(&self, centre: Direction, radius: Angle) -> PlaneRect {
        self.cap_outline(centre, radius).bounds()
    }

    fn cap_outline(&self, centre: Direction, radius: Angle) -> Outline {
        let place = |longitude: f64, latitude: f64| {
            let (sin, cos) = latitude.sin_cos();
            let (height, width) = self.0.place(Latitude { sin, cos: cos.max(0.0) });
            PlanePoint::new(longitude * width, height)
        };
        let parts = Graticule::around(centre, radius).parts();
        Outline::Rects(parts.into_iter().map(|part| part.bounds(place)).collect())
    }
}
