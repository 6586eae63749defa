use glam::DVec2;

use crate::camera::error::{check_field_of_view, check_positive};
use crate::camera::{Camera, CameraError, FieldStop, PixelGrid, PixelPoint, View};
use crate::projection::ProjectionKind;
use crate::sphere::{Angle, Orientation};

/// Position of the first and last samples of a row or column.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SamplePositions {
    /// Half a pixel inside the edges: the pixels tile the field of view.
    #[default]
    Centres,
    /// On the edges themselves, as in OpenEXR's environment maps: the first and the last column show the same.
    Edges,
}

/// An equirectangular panorama with the front in its middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EquirectCamera {
    /// Range of longitudes.
    pub horizontal: Angle,
    /// Range of latitudes.
    pub vertical: Angle,
    /// Position of the outermost samples.
    pub samples: SamplePositions,
}

impl Default for EquirectCamera {
    fn default() -> Self {
        Self { horizontal: Angle::TURN, vertical: Angle::HALF_TURN, samples: SamplePositions::Centres }
    }
}

impl Camera for EquirectCamera {
    fn view(&self, width: usize, height: usize) -> Result<View, CameraError> {
        check_field_of_view("the horizontal field of view", self.horizontal, 360.0, false)?;
        check_field_of_view("the vertical field of view", self.vertical, 180.0, false)?;
        let (w, h) = (width as f64, height as f64);
        let intervals = |pixels: f64| match self.samples {
            SamplePositions::Centres => pixels,
            SamplePositions::Edges => pixels - 1.0,
        };
        check_positive("the number of columns less one", intervals(w))?;
        check_positive("the number of rows less one", intervals(h))?;
        let step = DVec2::new(self.horizontal.radians() / intervals(w), self.vertical.radians() / intervals(h));
        Ok(View {
            projection: ProjectionKind::EQUIRECTANGULAR,
            orientation: Orientation::IDENTITY,
            grid: PixelGrid::centred(width, height, PixelPoint::new(w / 2.0, h / 2.0), step),
            stop: FieldStop::NONE,
        })
    }

    fn natural_ratio(&self) -> f64 {
        self.vertical.radians() / self.horizontal.radians()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::Direction;

    #[test]
    fn the_front_is_in_the_middle_and_the_right_to_the_right() {
        let view = EquirectCamera::default().view(400, 200).unwrap();
        let sees = |x, y, expected: Direction| {
            let seen = view.direction(PixelPoint::new(x, y)).unwrap();
            assert!(seen.angle_to(expected).degrees() < 1e-9, "({x}, {y}) sees {seen:?}");
        };
        sees(200.0, 100.0, Direction::FRONT);
        sees(300.0, 100.0, Direction::RIGHT);
        sees(0.0, 100.0, Direction::BACK);
        sees(200.0, 0.0, Direction::UP);
    }

    #[test]
    fn samples_on_the_edges() {
        let frame = EquirectCamera { samples: SamplePositions::Edges, ..EquirectCamera::default() };
        let view = frame.view(401, 201).unwrap();
        let (first, last) = (view.direction(PixelPoint::centre(0, 100)), view.direction(PixelPoint::centre(400, 100)));
        assert!(first.unwrap().angle_to(last.unwrap()).degrees() < 1e-9);
        assert_eq!(view.period(), Some(400));
        assert!(view.direction(PixelPoint::centre(200, 0)).unwrap().angle_to(Direction::UP).degrees() < 1e-9);
        assert!(frame.view(1, 1).is_err());
    }
}
