use glam::DVec2;

use crate::camera::error::check_positive;
use crate::camera::{Camera, CameraError, FieldStop, LensCircle, PixelGrid, PixelPoint, View};
use crate::projection::{MirrorBall, ProjectionKind};
use crate::sphere::Orientation;

/// A photograph of a mirror ball: the camera looks ahead at it, and the ball's outline is a circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MirrorBallCamera {
    /// Distance from the camera to the ball's centre, in ball radii; `None` for a distant camera.
    pub distance: Option<f64>,
    /// Place of the outline, if it does not fit the image exactly.
    pub circle: LensCircle,
    /// A pixel's width over its height.
    pub pixel_aspect: f64,
}

impl Default for MirrorBallCamera {
    fn default() -> Self {
        Self { distance: None, circle: LensCircle::FITTED, pixel_aspect: 1.0 }
    }
}

impl Camera for MirrorBallCamera {
    fn view(&self, width: usize, height: usize) -> Result<View, CameraError> {
        check_positive("the pixel aspect", self.pixel_aspect)?;
        let ball = match self.distance {
            None => MirrorBall::DISTANT,
            Some(found) => MirrorBall::from_distance(found).ok_or(inside_the_ball(found))?,
        };
        let (w, h) = (width as f64, height as f64);
        let step = 2.0 / (w * self.pixel_aspect).min(h);
        let centre = PixelPoint::new(w / 2.0, h / 2.0);
        let fitted = PixelGrid::centred(width, height, centre, DVec2::new(step * self.pixel_aspect, step));
        Ok(View {
            projection: ProjectionKind::MirrorBall(ball),
            orientation: Orientation::IDENTITY,
            grid: self.circle.place(fitted, 1.0)?,
            stop: FieldStop::circle(1.0),
        })
    }

    fn natural_ratio(&self) -> f64 {
        self.pixel_aspect
    }

    fn is_measured_in_pixels(&self) -> bool {
        self.circle != LensCircle::FITTED
    }
}

fn inside_the_ball(found: f64) -> CameraError {
    let unit = " ball radii from the mirror ball's centre";
    CameraError::OutOfRange { what: "the camera", found, unit, range: "more than 1" }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::Direction;

    #[test]
    fn the_photographer_is_in_the_middle_and_the_front_all_around() {
        for distance in [None, Some(1000.0), Some(2.0)] {
            let view = MirrorBallCamera { distance, ..MirrorBallCamera::default() }.view(100, 100).unwrap();
            let sees = |x, y| view.direction(PixelPoint::new(x, y)).unwrap();
            assert!(sees(50.0, 50.0).angle_to(Direction::BACK).degrees() < 1e-9);
            let rim = sees(0.001, 50.0).angle_to(Direction::FRONT).degrees();
            assert!((rim < 2.0) == (distance != Some(2.0)), "{rim}° at {distance:?}");
            // What is on the right is seen on the right, as in a mirror.
            assert!(sees(80.0, 50.0).dot(Direction::RIGHT) > 0.5 && sees(50.0, 20.0).dot(Direction::UP) > 0.5);
        }
        let inside = MirrorBallCamera { distance: Some(1.0), ..MirrorBallCamera::default() };
        assert_eq!(inside.view(4, 4), Err(inside_the_ball(1.0)));
    }
}
