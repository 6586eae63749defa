use super::{FrameError, ImageFrame};
use crate::projection::{Octahedral, OctahedralKind, PlanePoint, PlaneRect, ProjectionKind};
use crate::sphere::Orientation;
use crate::world::{FieldStop, PixelGrid, View};

/// The whole world on an octahedron unfolded into the image, the front in its middle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OctahedralFrame {
    /// How the sphere is laid onto the octahedron.
    pub kind: OctahedralKind,
}

impl ImageFrame for OctahedralFrame {
    fn view(&self, width: usize, height: usize) -> Result<View, FrameError> {
        let square = PlaneRect { min: PlanePoint::new(-1.0, -1.0), max: PlanePoint::new(1.0, 1.0) };
        Ok(View {
            projection: ProjectionKind::Octahedral(Octahedral(self.kind)),
            orientation: Orientation::IDENTITY,
            grid: PixelGrid::spanning(width, height, square),
            stop: FieldStop::NONE,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::Direction;
    use crate::world::PixelPoint;

    #[test]
    fn the_front_is_in_the_middle_and_the_back_in_the_corners() {
        for kind in [OctahedralKind::EqualArea, OctahedralKind::Plain] {
            let view = OctahedralFrame { kind }.view(100, 100).unwrap();
            let sees = |x, y, expected: Direction| {
                let seen = view.direction(PixelPoint::new(x, y)).unwrap();
                assert!(seen.angle_to(expected).degrees() < 1e-6, "{kind:?}: ({x}, {y}) sees {seen:?}");
            };
            sees(50.0, 50.0, Direction::FRONT);
            sees(100.0, 50.0, Direction::RIGHT);
            sees(50.0, 0.0, Direction::UP);
            for corner in [(0.0, 0.0), (100.0, 0.0), (0.0, 100.0), (100.0, 100.0)] {
                sees(corner.0, corner.1, Direction::BACK);
            }
        }
    }
}
