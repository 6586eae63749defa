use crate::projection::{PlanePoint, PlaneRect, ProjectionKind, StMap};
use crate::sphere::Orientation;
use crate::world::{FieldStop, PixelGrid, View};

/// A picture whose mapping is a table: it fills its image, whatever the size of that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StMapFrame {
    /// The table.
    pub map: StMap,
    /// The height over the width that suits it.
    pub natural_ratio: f64,
}

impl StMapFrame {
    pub(super) fn view(&self, width: usize, height: usize) -> View {
        let square = PlaneRect { min: PlanePoint::new(-0.5, -0.5), max: PlanePoint::new(0.5, 0.5) };
        View {
            projection: ProjectionKind::StMap(self.map),
            orientation: Orientation::IDENTITY,
            grid: PixelGrid::spanning(width, height, square),
            stop: FieldStop::NONE,
        }
    }
}
