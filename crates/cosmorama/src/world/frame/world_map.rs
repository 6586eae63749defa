use std::f64::consts::{FRAC_PI_2, PI, SQRT_2};

use super::{FrameError, ImageFrame};
use crate::projection::{PlanePoint, PlaneRect, ProjectionKind};
use crate::sphere::Orientation;
use crate::world::{FieldStop, PixelGrid, View};

/// A map of the whole world that just fits its image; images that are not twice as wide as high have pixels that are not
/// square.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WorldMapFrame {
    /// Hammer's.
    Hammer,
    /// Mollweide's.
    Mollweide,
    /// The sinusoidal one.
    Sinusoidal,
}

impl ImageFrame for WorldMapFrame {
    fn view(&self, width: usize, height: usize) -> Result<View, FrameError> {
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
    use crate::sphere::Direction;
    use crate::world::PixelPoint;

    #[test]
    fn the_world_just_fits() {
        for map in [WorldMapFrame::Hammer, WorldMapFrame::Mollweide, WorldMapFrame::Sinusoidal] {
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
