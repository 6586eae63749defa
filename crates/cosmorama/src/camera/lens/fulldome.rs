use crate::camera::error::check_field_of_view;
use crate::camera::{Camera, CameraError, CameraModel, FisheyeCamera, View};
use crate::sphere::{Angle, Orientation};

/// A domemaster: an equidistant fisheye whose circle is tangent to the square, seen looking up into the dome.
///
/// Without tilt the zenith is at the centre, the front at the bottom, and the right on the right: the picture of a
/// camera that looks ahead and then pitches up by 90°. `tilt` leans the dome towards the front, so its centre looks
/// that much lower.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FulldomeCamera {
    /// The angle that the dome spans.
    pub field_of_view: Angle,
    /// Angle by which the dome leans to the front.
    pub tilt: Angle,
    /// A pixel's width over its height.
    pub pixel_aspect: f64,
}

impl Default for FulldomeCamera {
    fn default() -> Self {
        Self { field_of_view: Angle::HALF_TURN, tilt: Angle::ZERO, pixel_aspect: 1.0 }
    }
}

impl Camera for FulldomeCamera {
    fn view(&self, width: usize, height: usize) -> Result<View, CameraError> {
        check_field_of_view("the field of view", self.field_of_view, 360.0, false)?;
        let fisheye = FisheyeCamera {
            field_of_view: self.field_of_view,
            pixel_aspect: self.pixel_aspect,
            ..FisheyeCamera::default()
        };
        let elevation = Angle::from_degrees(90.0) - self.tilt;
        let orientation = Orientation::from_yaw_pitch_roll(Angle::ZERO, elevation, Angle::ZERO);
        Ok(View { orientation, ..fisheye.view(width, height)? })
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
    use crate::camera::PixelPoint;
    use crate::sphere::Direction;

    fn assert_sees(frame: FulldomeCamera, (x, y): (f64, f64), expected: Direction) {
        let seen = frame.view(100, 100).unwrap().direction(PixelPoint::new(x, y)).unwrap();
        assert!(seen.angle_to(expected).degrees() < 1e-9, "({x}, {y}) sees {seen:?}, not {expected:?}");
    }

    #[test]
    fn the_front_is_at_the_bottom_and_the_zenith_in_the_centre() {
        let dome = FulldomeCamera::default();
        assert_sees(dome, (50.0, 50.0), Direction::UP);
        assert_sees(dome, (50.0, 100.0), Direction::FRONT);
        assert_sees(dome, (50.0, 0.0), Direction::BACK);
        assert_sees(dome, (100.0, 50.0), Direction::RIGHT);
        assert_sees(dome, (0.0, 50.0), Direction::LEFT);
    }

    #[test]
    fn a_tilted_dome_leans_to_the_front() {
        let dome = FulldomeCamera { tilt: Angle::from_degrees(30.0), ..FulldomeCamera::default() };
        let ahead = Direction::from_longitude_latitude(Angle::ZERO, Angle::from_degrees(60.0));
        assert_sees(dome, (50.0, 50.0), ahead);
        assert_sees(dome, (100.0, 50.0), Direction::RIGHT);
        // 90° from the axis, straight down the picture: 30° under the horizon.
        let below = Direction::from_longitude_latitude(Angle::ZERO, Angle::from_degrees(-30.0));
        assert_sees(dome, (50.0, 100.0), below);
    }
}
