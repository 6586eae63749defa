use crate::camera::error::check_positive;
use crate::camera::{Camera, CameraError, FieldStop, LensCircle, OmnimaxFraming, View};
use crate::projection::ProjectionKind;
use crate::sphere::{Angle, Orientation};

/// An Omnimax film frame (Greene & Heckbert 1986).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OmnimaxCamera {
    /// Placement of the limiting circle in the frame.
    pub framing: OmnimaxFraming,
    /// Angle below the axis of the great circle that cuts off the bottom; `None` shows the whole circle.
    pub lower: Option<Angle>,
    /// Place of the limiting circle, if it differs from the framing's.
    pub circle: LensCircle,
    /// Elevation of the axis of projection: 11° in a theatre.
    pub axis: Angle,
    /// A pixel's width over its height.
    pub pixel_aspect: f64,
}

/// Height over width of the paper's film frame.
const FILM_RATIO: f64 = 1436.0 / 1966.0;

impl Default for OmnimaxCamera {
    fn default() -> Self {
        Self {
            framing: OmnimaxFraming::Fit,
            lower: Some(Angle::from_degrees(45.0)),
            circle: LensCircle::FITTED,
            axis: Angle::ZERO,
            pixel_aspect: 1.0,
        }
    }
}

impl Camera for OmnimaxCamera {
    fn view(&self, width: usize, height: usize) -> Result<View, CameraError> {
        check_positive("the pixel aspect", self.pixel_aspect)?;
        if let Some(lower) = self.lower {
            let found = lower.degrees();
            if !(found > 0.0 && found <= 90.0 + 1e-9) {
                let (unit, range) = ("° below the axis", "more than 0° and at most 90°");
                return Err(CameraError::OutOfRange { what: "the lower cut", found, unit, range });
            }
        }
        let fitted = self.framing.grid(width, height, self.pixel_aspect);
        let rim = FieldStop::circle(1.0);
        Ok(View {
            projection: ProjectionKind::OMNIMAX,
            orientation: Orientation::from_yaw_pitch_roll(Angle::ZERO, self.axis, Angle::ZERO),
            grid: self.circle.place(fitted, 1.0)?,
            stop: self.lower.map_or(rim, |lower| rim.with_lower(lower)),
        })
    }

    fn natural_ratio(&self) -> f64 {
        match self.framing {
            OmnimaxFraming::Fit => FILM_RATIO * self.pixel_aspect,
            OmnimaxFraming::Circle => self.pixel_aspect,
        }
    }

    fn is_measured_in_pixels(&self) -> bool {
        self.circle != LensCircle::FITTED
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::PixelPoint;
    use crate::sphere::Direction;

    #[test]
    fn the_axis_is_raised() {
        let frame = OmnimaxCamera { axis: Angle::from_degrees(11.0), ..OmnimaxCamera::default() };
        let view = frame.view(1966, 1436).unwrap();
        let centre = view.direction(PixelPoint::new(983.0, 921.523)).unwrap();
        assert!((Direction::UP.angle_to(centre).degrees() - 79.0).abs() < 1e-3);
    }

    #[test]
    fn the_circle_may_be_placed() {
        let circle = LensCircle { centre: Some(PixelPoint::new(300.0, 400.0)), radius: Some(250.0) };
        let view = OmnimaxCamera { circle, lower: None, ..OmnimaxCamera::default() }.view(600, 600).unwrap();
        let rim = view.direction(PixelPoint::new(550.0, 400.0)).unwrap();
        assert!((rim.angle_to(Direction::FRONT).degrees() - 90.162).abs() < 1e-3);
        assert!(view.shows(PixelPoint::new(300.0, 400.0 - 249.9)) && !view.shows(PixelPoint::new(300.0, 149.0)));
    }

    #[test]
    fn a_cut_above_the_axis_is_refused() {
        let frame = OmnimaxCamera { lower: Some(Angle::from_degrees(-5.0)), ..OmnimaxCamera::default() };
        let error = frame.view(10, 10).unwrap_err().to_string();
        assert_eq!(error, "the lower cut is -5° below the axis; it must be more than 0° and at most 90°");
    }
}
