use crate::camera::{Camera, CameraError, FieldStop, PixelGrid, View};
use crate::projection::{PlanePoint, PlaneRect, ProjectionKind};
use crate::sphere::Orientation;

/// A face of a cube. It spans 90° both ways, so its pixels are square only if the image is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CubeFaceCamera;

impl Camera for CubeFaceCamera {
    fn view(&self, width: usize, height: usize) -> Result<View, CameraError> {
        let face = PlaneRect { min: PlanePoint::new(-1.0, -1.0), max: PlanePoint::new(1.0, 1.0) };
        Ok(View {
            projection: ProjectionKind::PERSPECTIVE,
            orientation: Orientation::IDENTITY,
            grid: PixelGrid::spanning(width, height, face),
            stop: FieldStop::NONE,
        })
    }
}
