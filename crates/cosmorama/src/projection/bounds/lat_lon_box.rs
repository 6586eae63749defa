use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::projection::{PlanePoint, PlaneRect};
use crate::sphere::{Angle, Direction};

/// A box of longitudes and latitudes, in radians. West may be less than −π, east more than π.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Graticule {
    pub(crate) west: f64,
    pub(crate) east: f64,
    pub(crate) south: f64,
    pub(crate) north: f64,
}

impl Graticule {
    /// Returns the box that holds every direction within `radius` of `centre`: all longitudes if a pole is among them.
    pub(crate) fn around(centre: Direction, radius: Angle) -> Self {
        let (longitude, latitude) = centre.longitude_latitude();
        let (longitude, latitude, radius) = (longitude.radians(), latitude.radians(), radius.radians());
        let (south, north) = (latitude - radius, latitude + radius);
        let holds_a_pole = south <= -FRAC_PI_2 || north >= FRAC_PI_2;
        let half_width = if holds_a_pole { PI } else { (radius.sin() / latitude.cos()).min(1.0).asin() };
        Self {
            west: longitude - half_width,
            east: longitude + half_width,
            south: south.max(-FRAC_PI_2),
            north: north.min(FRAC_PI_2),
        }
    }

    /// Splits the box at the meridian behind, where maps end. A box that spans a full turn becomes one of all
    /// longitudes.
    pub(crate) fn parts(self) -> Vec<Self> {
        let Self { west, east, .. } = self;
        if west >= -PI && east <= PI {
            vec![self]
        } else if east - west >= TAU {
            vec![Self { west: -PI, east: PI, ..self }]
        } else {
            let (west, east) = ((west + PI).rem_euclid(TAU) - PI, (east + PI).rem_euclid(TAU) - PI);
            vec![Self { west, east: PI, ..self }, Self { west: -PI, east, ..self }]
        }
    }

    /// Returns the rectangle of the plane that holds the box's image. x must rise with the longitude, and y with the
    /// latitude. At a fixed longitude x must be a monotone function of the latitude's distance from 0, and likewise y
    /// of the longitude's.
    pub(crate) fn bounds(self, place: impl Fn(f64, f64) -> PlanePoint) -> PlaneRect {
        let with_least = |low: f64, high: f64| [low, high, 0f64.clamp(low, high)];
        let mut rect = PlaneRect::NOTHING;
        for longitude in with_least(self.west, self.east) {
            for latitude in with_least(self.south, self.north) {
                rect = rect.with(place(longitude, latitude));
            }
        }
        rect
    }
}
