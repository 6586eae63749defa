use crate::camera::error::{check_field_of_view, check_positive};
use crate::camera::{Camera, CameraError, FieldStop, PixelGrid, SamplePositions, View};
use crate::projection::{PlanePoint, PlaneRect, ProjectionKind};
use crate::sphere::{Angle, Orientation};

/// A face of a cube map that differs from a pinhole camera of 90°: it is equi-angular, its outermost samples lie on the
/// cube's edges, or it extends beyond them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayoutFaceCamera {
    /// Mapping of pixels to angles.
    pub mapping: FaceMapping,
    /// Position of the outermost samples.
    pub samples: SamplePositions,
    /// Field of view from edge to edge; a face of more than 90° overlaps its neighbours.
    pub field_of_view: Angle,
}

impl LayoutFaceCamera {
    /// Field of view of faces that meet at the cube's edges without overlap: 90°.
    pub const RIGHT_ANGLE: Angle = Angle::from_degrees(90.0);
}

impl Default for LayoutFaceCamera {
    fn default() -> Self {
        Self { mapping: FaceMapping::default(), samples: SamplePositions::default(), field_of_view: Self::RIGHT_ANGLE }
    }
}

/// Mapping of a cube face's pixels to directions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FaceMapping {
    /// As a pinhole camera does.
    #[default]
    Perspective,
    /// In equal angles, as in equi-angular cube maps.
    EquiAngular,
}

impl Camera for LayoutFaceCamera {
    fn view(&self, width: usize, height: usize) -> Result<View, CameraError> {
        check_field_of_view("a face's field of view", self.field_of_view, 180.0, true)?;
        let half = self.field_of_view * 0.5;
        let (projection, edge) = match self.mapping {
            FaceMapping::Perspective => (ProjectionKind::PERSPECTIVE, half.tan()),
            FaceMapping::EquiAngular => (ProjectionKind::EQUI_ANGULAR, half.radians()),
        };
        let reach = |pixels: usize| match self.samples {
            SamplePositions::Centres => edge,
            // Half a pixel farther on each side, so that the outermost centres are on the edge.
            SamplePositions::Edges => edge * (1.0 + 1.0 / (pixels as f64 - 1.0)),
        };
        check_positive("the columns of a face less one", 1.0 / reach(width))?;
        check_positive("the rows of a face less one", 1.0 / reach(height))?;
        let corner = PlanePoint::new(reach(width), reach(height));
        let face = PlaneRect { min: PlanePoint::new(-corner.x, -corner.y), max: corner };
        Ok(View {
            projection,
            orientation: Orientation::IDENTITY,
            grid: PixelGrid::spanning(width, height, face),
            stop: FieldStop::NONE,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::PixelPoint;
    use crate::sphere::Direction;

    fn angle(frame: LayoutFaceCamera, pixel: PixelPoint) -> f64 {
        frame.view(8, 8).unwrap().direction(pixel).unwrap().angle_to(Direction::FRONT).degrees()
    }

    #[test]
    fn samples_on_the_edges_see_45_degrees() {
        let frame = LayoutFaceCamera { samples: SamplePositions::Edges, ..LayoutFaceCamera::default() };
        // The middle of eight rows lies between two of them.
        assert!((angle(frame, PixelPoint::new(0.5, 4.0)) - 45.0).abs() < 1e-9);
        assert!((angle(frame, PixelPoint::new(4.0, 7.5)) - 45.0).abs() < 1e-9);
        assert!(frame.view(1, 8).is_err());
    }

    #[test]
    fn a_face_may_see_more_than_its_own() {
        for mapping in [FaceMapping::Perspective, FaceMapping::EquiAngular] {
            let wide = |degrees| LayoutFaceCamera {
                mapping,
                field_of_view: Angle::from_degrees(degrees),
                ..LayoutFaceCamera::default()
            };
            assert!((angle(wide(100.0), PixelPoint::new(8.0, 4.0)) - 50.0).abs() < 1e-9);
            assert!(wide(180.0).view(8, 8).is_err() && wide(0.0).view(8, 8).is_err());
        }
    }

    #[test]
    fn equal_angles_for_equal_pixels() {
        let frame = LayoutFaceCamera { mapping: FaceMapping::EquiAngular, ..LayoutFaceCamera::default() };
        for pixels in 0..=4 {
            let expected = 45.0 * f64::from(pixels) / 4.0;
            assert!((angle(frame, PixelPoint::new(4.0 + f64::from(pixels), 4.0)) - expected).abs() < 1e-9);
        }
    }
}
