use cosmorama::sphere::{Angle, Direction};
use glam::DVec3;

/// Azimuth (0 at the front, growing to the right, −180° to 180°) and elevation of a direction on the dome.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Compass {
    pub(crate) azimuth: Angle,
    pub(crate) elevation: Angle,
    direction: DVec3,
    /// Cosine of the elevation.
    pub(crate) cosine: f64,
}

/// Cosine of the elevation below which azimuths are undefined.
const POLE: f64 = 1e-9;

impl Compass {
    pub(crate) fn of(direction: Direction) -> Self {
        let (azimuth, elevation) = direction.longitude_latitude();
        let vector = direction.vector();
        let cosine = (vector.x * vector.x + vector.z * vector.z).sqrt();
        Self { azimuth, elevation, direction: vector, cosine }
    }

    /// Returns the unit vector towards growing azimuth.
    fn east(&self) -> Option<DVec3> {
        let DVec3 { x, z, .. } = self.direction;
        (self.cosine > POLE).then(|| DVec3::new(-z, 0.0, x) / self.cosine)
    }

    /// Returns the gradient of the azimuth; `None` at the poles.
    pub(crate) fn azimuth_gradient(&self) -> Option<DVec3> {
        Some(self.east()? / self.cosine)
    }

    /// Returns the gradient of the elevation; `None` at the poles.
    pub(crate) fn elevation_gradient(&self) -> Option<DVec3> {
        Some(self.east()?.cross(self.direction))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gradients_point_to_growing_angles() {
        let at = |azimuth: f64, elevation: f64| {
            let (azimuth, elevation) = (Angle::from_degrees(azimuth), Angle::from_degrees(elevation));
            Compass::of(Direction::from_longitude_latitude(azimuth, elevation))
        };
        for (azimuth, elevation) in [(0.0, 0.0), (70.0, 40.0), (-130.0, -75.0)] {
            let (here, east, north) =
                (at(azimuth, elevation), at(azimuth + 0.01, elevation), at(azimuth, elevation + 0.01));
            let step = |to: &Compass, gradient: DVec3| (to.direction - here.direction).dot(gradient).to_degrees();
            assert!((step(&east, here.azimuth_gradient().unwrap()) - 0.01).abs() < 1e-6);
            assert!((step(&north, here.elevation_gradient().unwrap()) - 0.01).abs() < 1e-6);
        }
        assert!(at(0.0, 90.0).azimuth_gradient().is_none());
    }
}
