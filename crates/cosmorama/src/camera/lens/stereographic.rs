use glam::DVec2;

use crate::camera::error::{check_field_of_view, check_positive};
use crate::camera::{Camera, CameraError, CameraModel, FieldStop, PixelGrid, PixelPoint, View};
use crate::projection::ProjectionKind;
use crate::projection::azimuthal::{FisheyeLens, Lens, Stereographic};
use crate::sphere::{Angle, Orientation};

/// A stereographic picture that fills its image, corners included. Looking straight down it is a little planet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StereographicCamera {
    /// Horizontal field of view, from edge to edge.
    pub field_of_view: Angle,
    /// A pixel's width over its height.
    pub pixel_aspect: f64,
}

impl Default for StereographicCamera {
    fn default() -> Self {
        Self { field_of_view: Angle::from_degrees(270.0), pixel_aspect: 1.0 }
    }
}

impl Camera for StereographicCamera {
    fn view(&self, width: usize, height: usize) -> Result<View, CameraError> {
        let what = "the field of view";
        check_field_of_view(what, self.field_of_view, 360.0, true)?;
        check_positive("the pixel aspect", self.pixel_aspect)?;
        let beyond =
            CameraError::FieldOfView { what, found: self.field_of_view.degrees(), greatest: 360.0, below: true };
        let edge = Stereographic.radius(self.field_of_view.radians() / 2.0).ok_or(beyond)?;
        let (w, h) = (width as f64, height as f64);
        let step = 2.0 * edge / w;
        Ok(View {
            projection: ProjectionKind::fisheye(FisheyeLens::STEREOGRAPHIC),
            orientation: Orientation::IDENTITY,
            grid: PixelGrid::centred(
                width,
                height,
                PixelPoint::new(w / 2.0, h / 2.0),
                DVec2::new(step, step / self.pixel_aspect),
            ),
            stop: FieldStop::NONE,
        })
    }

    fn with_field_of_view(&self, field_of_view: Angle) -> Option<CameraModel> {
        Some(Self { field_of_view, ..*self }.into())
    }

    fn natural_ratio(&self) -> f64 {
        self.pixel_aspect
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::Direction;

    #[test]
    fn the_edges_are_half_a_field_from_the_axis_and_the_corners_more() {
        let view = StereographicCamera::default().view(100, 100).unwrap();
        let angle = |x, y| view.direction(PixelPoint::new(x, y)).unwrap().angle_to(Direction::FRONT).degrees();
        assert!((angle(0.0, 50.0) - 135.0).abs() < 1e-9 && angle(0.0, 0.0) > 135.0);
        assert!(view.shows(PixelPoint::new(0.5, 0.5)));
    }
}
