use std::f64::consts::FRAC_PI_4;

use super::error::check_positive;
use super::{FrameError, SamplePositions};
use crate::projection::{PlanePoint, PlaneRect, ProjectionKind};
use crate::sphere::Orientation;
use crate::world::{FieldStop, PixelGrid, View};

/// A face of a cube map whose pixels are not those of a pinhole camera that sees 90°: they see equal angles, or the
/// outermost samples lie on the cube's edges.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LayoutFaceFrame {
    /// How angles go with pixels.
    pub mapping: FaceMapping,
    /// Where the outermost samples lie.
    pub samples: SamplePositions,
}

/// How the pixels of a face of a cube see the world.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FaceMapping {
    /// As a pinhole camera does.
    #[default]
    Perspective,
    /// In equal angles, as in equi-angular cube maps.
    EquiAngular,
}

impl LayoutFaceFrame {
    pub(super) fn view(self, width: usize, height: usize) -> Result<View, FrameError> {
        let (projection, edge) = match self.mapping {
            FaceMapping::Perspective => (ProjectionKind::PERSPECTIVE, 1.0),
            FaceMapping::EquiAngular => (ProjectionKind::EQUI_ANGULAR, FRAC_PI_4),
        };
        let reach = |pixels: usize| match self.samples {
            SamplePositions::Centres => edge,
            // Half a pixel further, so that the outermost centres are on the edge.
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
    use crate::sphere::Direction;
    use crate::world::PixelPoint;

    fn angle(frame: LayoutFaceFrame, pixel: PixelPoint) -> f64 {
        frame.view(8, 8).unwrap().direction(pixel).unwrap().angle_to(Direction::FRONT).degrees()
    }

    #[test]
    fn samples_on_the_edges_see_45_degrees() {
        let frame = LayoutFaceFrame { samples: SamplePositions::Edges, ..LayoutFaceFrame::default() };
        // The middle row of eight lies between two.
        assert!((angle(frame, PixelPoint::new(0.5, 4.0)) - 45.0).abs() < 1e-9);
        assert!((angle(frame, PixelPoint::new(4.0, 7.5)) - 45.0).abs() < 1e-9);
        assert!(frame.view(1, 8).is_err());
    }

    #[test]
    fn equal_angles_for_equal_pixels() {
        let frame = LayoutFaceFrame { mapping: FaceMapping::EquiAngular, ..LayoutFaceFrame::default() };
        for pixels in 0..=4 {
            let expected = 45.0 * f64::from(pixels) / 4.0;
            assert!((angle(frame, PixelPoint::new(4.0 + f64::from(pixels), 4.0)) - expected).abs() < 1e-9);
        }
    }
}
