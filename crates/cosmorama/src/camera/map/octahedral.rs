use crate::camera::{Camera, CameraError, FieldStop, PixelGrid, View};
use crate::projection::{Octahedral, OctahedralKind, PlanePoint, PlaneRect, ProjectionKind};
use crate::sphere::Orientation;

/// The whole world on an octahedron unfolded into the image, with the front in its middle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OctahedralCamera {
    /// Mapping of the sphere to the octahedron.
    pub kind: OctahedralKind,
}

impl Camera for OctahedralCamera {
    fn view(&self, width: usize, height: usize) -> Result<View, CameraError> {
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
    use crate::camera::PixelPoint;
    use crate::sphere::Direction;

    #[test]
    fn the_front_is_in_the_middle_and_the_back_in_the_corners() {
        for kind in [OctahedralKind::EqualArea, OctahedralKind::Plain] {
            let view = OctahedralCamera { kind }.view(100, 100).unwrap();
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
