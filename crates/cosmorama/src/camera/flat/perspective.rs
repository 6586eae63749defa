use glam::DVec2;

use crate::camera::error::{check_field_of_view, check_positive};
use crate::camera::{Camera, CameraError, CameraModel, FieldOfView, FieldStop, PixelGrid, PixelPoint, View};
use crate::projection::ProjectionKind;
use crate::sphere::{Angle, Orientation};

/// A pinhole camera whose axis is in the middle of the image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PerspectiveCamera {
    /// Field of view.
    pub field_of_view: FieldOfView,
    /// A pixel's width over its height; unused where the field of view is given both ways.
    pub pixel_aspect: f64,
}

/// Default height over width.
const DEFAULT_RATIO: f64 = 3.0 / 4.0;

impl PerspectiveCamera {
    /// Returns a camera with square pixels.
    pub const fn new(field_of_view: FieldOfView) -> Self {
        Self { field_of_view, pixel_aspect: 1.0 }
    }
}

impl Camera for PerspectiveCamera {
    fn view(&self, width: usize, height: usize) -> Result<View, CameraError> {
        self.check()?;
        let (w, h) = (width as f64, height as f64);
        let half = |angle: Angle| (angle * 0.5).tan();
        let by_width = |step: f64| DVec2::new(step, step / self.pixel_aspect);
        let step = match self.field_of_view {
            FieldOfView::Horizontal(angle) => by_width(2.0 * half(angle) / w),
            FieldOfView::Vertical(angle) => by_width(2.0 * half(angle) / h * self.pixel_aspect),
            FieldOfView::Diagonal(angle) => by_width(2.0 * half(angle) / w.hypot(h / self.pixel_aspect)),
            FieldOfView::Both { horizontal, vertical } => {
                DVec2::new(2.0 * half(horizontal) / w, 2.0 * half(vertical) / h)
            }
        };
        Ok(View {
            projection: ProjectionKind::PERSPECTIVE,
            orientation: Orientation::IDENTITY,
            grid: PixelGrid::centred(width, height, PixelPoint::new(w / 2.0, h / 2.0), step),
            stop: FieldStop::NONE,
        })
    }

    fn with_field_of_view(&self, field_of_view: Angle) -> Option<CameraModel> {
        let field_of_view = self.field_of_view.with_angle(field_of_view)?;
        Some(Self { field_of_view, ..*self }.into())
    }

    fn natural_ratio(&self) -> f64 {
        match self.field_of_view {
            FieldOfView::Both { horizontal, vertical } => (vertical * 0.5).tan() / (horizontal * 0.5).tan(),
            _ => DEFAULT_RATIO * self.pixel_aspect,
        }
    }
}

impl PerspectiveCamera {
    fn check(&self) -> Result<(), CameraError> {
        let check = |what, angle| check_field_of_view(what, angle, 180.0, true);
        match self.field_of_view {
            FieldOfView::Horizontal(angle) => check("the horizontal field of view", angle)?,
            FieldOfView::Vertical(angle) => check("the vertical field of view", angle)?,
            FieldOfView::Diagonal(angle) => check("the diagonal field of view", angle)?,
            FieldOfView::Both { horizontal, vertical } => {
                check("the horizontal field of view", horizontal)?;
                check("the vertical field of view", vertical)?;
            }
        }
        check_positive("the pixel aspect", self.pixel_aspect)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::Direction;

    /// Returns the angle in degrees between what two points of the image see.
    fn angle(view: &View, a: (f64, f64), b: (f64, f64)) -> f64 {
        let direction = |(x, y)| -> Direction { view.direction(PixelPoint::new(x, y)).unwrap() };
        direction(a).angle_to(direction(b)).degrees()
    }

    #[test]
    fn fields_of_view_are_measured_where_they_say() {
        let sixty = Angle::from_degrees(60.0);
        let view = |field_of_view| PerspectiveCamera { field_of_view, pixel_aspect: 1.25 }.view(640, 480).unwrap();
        let horizontal = view(FieldOfView::Horizontal(sixty));
        assert!((angle(&horizontal, (0.0, 240.0), (640.0, 240.0)) - 60.0).abs() < 1e-9);
        let vertical = view(FieldOfView::Vertical(sixty));
        assert!((angle(&vertical, (320.0, 0.0), (320.0, 480.0)) - 60.0).abs() < 1e-9);
        let diagonal = view(FieldOfView::Diagonal(sixty));
        assert!((angle(&diagonal, (0.0, 0.0), (640.0, 480.0)) - 60.0).abs() < 1e-9);
        for view in [horizontal, vertical, diagonal] {
            assert!((view.grid.step().x / view.grid.step().y - 1.25).abs() < 1e-12);
        }
    }

    #[test]
    fn a_camera_sees_less_than_half_the_world() {
        let error = PerspectiveCamera::new(FieldOfView::Vertical(Angle::HALF_TURN)).view(4, 4).unwrap_err();
        assert_eq!(error.to_string(), "the vertical field of view is 180°; it must be more than 0° and less than 180°");
    }
}
