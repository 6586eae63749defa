use glam::DVec2;

use super::error::{check_field_of_view, check_positive};
use super::{FrameError, LensCircle};
use crate::projection::ProjectionKind;
use crate::sphere::{Angle, Orientation};
use crate::world::{FieldStop, PixelGrid, PixelPoint, View};

/// Which length of the image the fisheye's circle spans.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FisheyeFit {
    /// The shorter side: the whole circle is in the image.
    #[default]
    Short,
    /// The longer side: the circle is cut off at the other two.
    Long,
    /// The width.
    Width,
    /// The height.
    Height,
    /// The diagonal: no corner is dark.
    Diagonal,
}

impl FisheyeFit {
    fn of(self, width: f64, height: f64) -> f64 {
        match self {
            Self::Short => width.min(height),
            Self::Long => width.max(height),
            Self::Width => width,
            Self::Height => height,
            Self::Diagonal => width.hypot(height),
        }
    }
}

/// An equidistant fisheye's picture; the field of view ends at its circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FisheyeFrame {
    /// The angle that the circle's diameter spans.
    pub field_of_view: Angle,
    /// Which length of the image that diameter is.
    pub fit: FisheyeFit,
    /// Where the circle lies, if not in the middle.
    pub circle: LensCircle,
    /// A pixel's width over its height.
    pub pixel_aspect: f64,
}

impl Default for FisheyeFrame {
    fn default() -> Self {
        Self { field_of_view: Angle::HALF_TURN, fit: FisheyeFit::Short, circle: LensCircle::FITTED, pixel_aspect: 1.0 }
    }
}

impl FisheyeFrame {
    pub(super) fn view(&self, width: usize, height: usize) -> Result<View, FrameError> {
        check_field_of_view("the field of view", self.field_of_view, 360.0, false)?;
        check_positive("the pixel aspect", self.pixel_aspect)?;
        let (w, h) = (width as f64, height as f64);
        let radius = self.field_of_view.radians() / 2.0;
        // Lengths are measured in heights of a pixel, so that the circle is round.
        let step = 2.0 * radius / self.fit.of(w * self.pixel_aspect, h);
        let centre = PixelPoint::new(w / 2.0, h / 2.0);
        let fitted = PixelGrid::centred(width, height, centre, DVec2::new(step * self.pixel_aspect, step));
        Ok(View {
            projection: ProjectionKind::EQUIDISTANT,
            orientation: Orientation::IDENTITY,
            grid: self.circle.place(fitted, radius)?,
            stop: FieldStop::circle(radius),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn angle_from_axis(frame: &FisheyeFrame, x: f64, y: f64) -> f64 {
        let view = frame.view(400, 300).unwrap();
        let direction = view.direction(PixelPoint::new(x, y)).unwrap();
        direction.angle_to(crate::sphere::Direction::FRONT).degrees()
    }

    #[test]
    fn the_circle_spans_what_is_asked_for() {
        for (fit, edge) in [
            (FisheyeFit::Short, (200.0, 0.0)),
            (FisheyeFit::Height, (200.0, 300.0)),
            (FisheyeFit::Long, (0.0, 150.0)),
            (FisheyeFit::Width, (400.0, 150.0)),
            (FisheyeFit::Diagonal, (400.0, 300.0)),
        ] {
            let frame = FisheyeFrame { fit, ..FisheyeFrame::default() };
            assert!((angle_from_axis(&frame, edge.0, edge.1) - 90.0).abs() < 1e-9, "{fit:?}");
        }
    }

    #[test]
    fn the_circle_may_be_placed() {
        let circle = LensCircle { centre: Some(PixelPoint::new(100.0, 50.0)), radius: Some(80.0) };
        let frame = FisheyeFrame { circle, ..FisheyeFrame::default() };
        assert!(angle_from_axis(&frame, 100.0, 50.0) < 1e-9);
        assert!((angle_from_axis(&frame, 180.0, 50.0) - 90.0).abs() < 1e-9);
    }

    #[test]
    fn a_fisheye_may_see_everything_but_no_more() {
        let frame = |degrees| FisheyeFrame { field_of_view: Angle::from_degrees(degrees), ..FisheyeFrame::default() };
        assert!(frame(360.0).view(4, 4).is_ok());
        assert!(frame(361.0).view(4, 4).is_err());
        assert!(frame(0.0).view(4, 4).is_err());
    }
}
