use crate::camera::{FieldStop, PixelGrid, View};
use crate::projection::{PlanePoint, PlaneRect, ProjectionKind};
use crate::sphere::Orientation;

/// An upright panorama of the whole sphere, for tests.
pub(crate) fn panorama(width: usize, height: usize) -> View {
    let (x, y) = (std::f64::consts::PI, std::f64::consts::FRAC_PI_2);
    let rect = PlaneRect { min: PlanePoint::new(-x, -y), max: PlanePoint::new(x, y) };
    View {
        projection: ProjectionKind::EQUIRECTANGULAR,
        orientation: Orientation::IDENTITY,
        grid: PixelGrid::spanning(width, height, rect),
        stop: FieldStop::NONE,
    }
}
