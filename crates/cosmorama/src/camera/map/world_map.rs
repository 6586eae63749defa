use std::f64::consts::{FRAC_PI_2, PI, SQRT_2};

use crate::camera::{Camera, CameraError, FieldStop, PixelGrid, View};
use crate::projection::{PlanePoint, PlaneRect, ProjectionKind};
use crate::sphere::Orientation;

/// A map of the whole world that just fits its image. Pixels are square only if the image is twice as wide as high.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WorldMapCamera {
    /// Hammer's.
    Hammer,
    /// Mollweide's.
    Mollweide,
    /// The sinusoidal map.
    Sinusoidal,
}

impl Camera for WorldMapCamera {
    fn view(&self, width: usize, height: usize) -> Result<View, CameraError> {
        let ellipse = (2.0 * SQRT_2, SQRT_2);
        let (projection, (x, y)) = match self {
            Self::Hammer => (ProjectionKind::HAMMER, ellipse),
            Self::Mollweide => (ProjectionKind::MOLLWEIDE, ellipse),
            Self::Sinusoidal => (ProjectionKind::SINUSOIDAL, (PI, FRAC_PI_2)),
        };
        let world = PlaneRect { min: PlanePoint::new(-x, -y), max: PlanePoint::new(x, y) };
        Ok(View {
            projection,
            orientation: Orientation::IDENTITY,
            grid: PixelGrid::spanning(width, height, world),
            stop: FieldStop::NONE,
        })
    }

    fn natural_ratio(&self) -> f64 {
        0.5
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::PixelPoint;
    use crate::sphere::Direction;

    #[test]
    fn the_world_just_fits() {
        for map in [WorldMapCamera::Hammer, WorldMapCamera::Mollweide, WorldMapCamera::Sinusoidal] {
            let view = map.view(400, 200).unwrap();
            let sees = |x, y, expected: Direction| {
                let seen = view.direction(PixelPoint::new(x, y)).unwrap();
                assert!(seen.angle_to(expected).degrees() < 1e-5, "{map:?}: ({x}, {y}) sees {seen:?}");
            };
            sees(200.0, 100.0, Direction::FRONT);
            sees(0.0, 100.0, Direction::BACK);
            sees(400.0, 100.0, Direction::BACK);
            sees(200.0, 0.0, Direction::UP);
            sees(200.0, 200.0, Direction::DOWN);
            assert_eq!(view.direction(PixelPoint::new(10.0, 10.0)), None);
        }
    }
}
