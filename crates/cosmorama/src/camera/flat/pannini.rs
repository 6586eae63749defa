use glam::DVec2;

use crate::camera::error::{check_field_of_view, check_positive};
use crate::camera::{Camera, CameraError, CameraModel, FieldStop, PixelGrid, PixelPoint, View};
use crate::projection::{Pannini, ProjectionKind};
use crate::sphere::{Angle, Orientation};

/// A wide picture in Pannini projection: vertical lines, and lines through the centre, stay straight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PanniniCamera {
    /// Distance d of the eye behind the cylinder's axis: 0 is a pinhole camera, 1 Pannini's own view.
    pub distance: f64,
    /// Horizontal field of view, from edge to edge.
    pub field_of_view: Angle,
    /// A pixel's width over its height.
    pub pixel_aspect: f64,
}

impl Default for PanniniCamera {
    fn default() -> Self {
        Self { distance: 1.0, field_of_view: Angle::HALF_TURN, pixel_aspect: 1.0 }
    }
}

/// Default height over width.
const DEFAULT_RATIO: f64 = 1.0 / 2.0;

impl Camera for PanniniCamera {
    fn view(&self, width: usize, height: usize) -> Result<View, CameraError> {
        let found = self.distance;
        let (what, range) = ("Pannini's distance d", "from 0 (a pinhole) to 1000000");
        let beyond = CameraError::OutOfRange { what, found, unit: "", range };
        let pannini = Pannini::from_distance(found).ok_or(beyond)?;
        let widest = pannini.limit().degrees() * 2.0;
        check_field_of_view("the horizontal field of view", self.field_of_view, widest, true)?;
        check_positive("the pixel aspect", self.pixel_aspect)?;
        let (w, h) = (width as f64, height as f64);
        let step = 2.0 * pannini.across(self.field_of_view * 0.5) / w;
        let centre = PixelPoint::new(w / 2.0, h / 2.0);
        Ok(View {
            projection: ProjectionKind::Pannini(pannini),
            orientation: Orientation::IDENTITY,
            grid: PixelGrid::centred(width, height, centre, DVec2::new(step, step / self.pixel_aspect)),
            stop: FieldStop::NONE,
        })
    }

    fn with_field_of_view(&self, field_of_view: Angle) -> Option<CameraModel> {
        Some(Self { field_of_view, ..*self }.into())
    }

    fn natural_ratio(&self) -> f64 {
        DEFAULT_RATIO * self.pixel_aspect
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::Direction;

    #[test]
    fn the_field_of_view_is_horizontal() {
        for (distance, degrees) in [(0.0, 100.0), (0.5, 200.0), (1.0, 300.0), (2.0, 230.0)] {
            let field_of_view = Angle::from_degrees(degrees);
            let frame = PanniniCamera { distance, field_of_view, ..PanniniCamera::default() };
            let left = frame.view(100, 50).unwrap().direction(PixelPoint::new(0.0, 25.0)).unwrap();
            assert!((left.angle_to(Direction::FRONT).degrees() - degrees / 2.0).abs() < 1e-6, "{distance}: {left:?}");
        }
        let frame = |distance, degrees| {
            let field_of_view = Angle::from_degrees(degrees);
            PanniniCamera { distance, field_of_view, ..PanniniCamera::default() }.view(4, 4).is_err()
        };
        assert!(frame(0.0, 180.0) && frame(2.0, 240.1) && frame(-1.0, 90.0) && frame(f64::NAN, 90.0));
    }
}
