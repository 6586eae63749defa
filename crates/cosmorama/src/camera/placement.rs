use super::{CameraError, CameraModel, View};
use crate::sphere::Orientation;

/// Mirroring of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Mirror {
    /// Left to right.
    pub x: bool,
    /// Top to bottom.
    pub y: bool,
}

impl Mirror {
    /// Combines two mirrorings; the same one twice cancels.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self { x: self.x != other.x, y: self.y != other.y }
    }

    /// Returns whether text in the mirrored picture reads backwards.
    pub const fn is_backwards(self) -> bool {
        self.x != self.y
    }
}

/// A larger image of which the given image is a window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Canvas {
    /// Columns of the larger image.
    pub width: usize,
    /// Rows of the larger image.
    pub height: usize,
    /// Column of the larger image at which the window begins; negative where the window extends beyond it.
    pub left: i64,
    /// Row of the larger image at which the window begins.
    pub top: i64,
}

/// A camera model with its orientation, mirroring and crop.
#[derive(Clone, Debug, PartialEq)]
pub struct Placement {
    /// Camera model.
    pub frame: CameraModel,
    /// Orientation of the camera.
    pub orientation: Orientation,
    /// Mirroring of the picture; a crop is mirrored with its whole canvas.
    pub mirror: Mirror,
    /// The canvas, if the image is only a part of it.
    pub canvas: Option<Canvas>,
}

impl From<CameraModel> for Placement {
    fn from(camera: CameraModel) -> Self {
        Self::new(camera)
    }
}

impl Placement {
    /// Places a whole picture, neither turned nor mirrored.
    pub const fn new(frame: CameraModel) -> Self {
        Self { frame, orientation: Orientation::IDENTITY, mirror: Mirror { x: false, y: false }, canvas: None }
    }

    /// Returns the view of an image of `width` × `height` pixels.
    ///
    /// # Errors
    /// When a parameter of the camera model is out of its range, or the image has no pixels.
    pub fn view(&self, width: usize, height: usize) -> Result<View, CameraError> {
        if width == 0 || height == 0 {
            return Err(CameraError::NoPixels { width, height });
        }
        let canvas = self.canvas.unwrap_or(Canvas { width, height, left: 0, top: 0 });
        let whole = self.frame.view(canvas.width, canvas.height)?;
        let mut grid = whole.grid;
        if self.mirror.x {
            grid = grid.flipped_x();
        }
        if self.mirror.y {
            grid = grid.flipped_y();
        }
        Ok(View {
            grid: grid.window(width, height, canvas.left as f64, canvas.top as f64),
            orientation: whole.orientation.within(self.orientation),
            ..whole
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{CubeFaceCamera, PixelPoint};
    use crate::sphere::Direction;

    const FACE: Placement = Placement::new(CameraModel::CubeFace(CubeFaceCamera));

    #[test]
    fn a_window_sees_its_part_of_the_canvas() {
        let canvas = Some(Canvas { width: 100, height: 100, left: 50, top: 10 });
        let window = Placement { canvas, ..FACE }.view(50, 80).unwrap();
        let whole = FACE.view(100, 100).unwrap();
        assert_eq!(window.direction(PixelPoint::new(3.0, 4.0)), whole.direction(PixelPoint::new(53.0, 14.0)));
    }

    #[test]
    fn mirrors_mirror() {
        let mirrored = Placement { mirror: Mirror { x: true, y: false }, ..FACE }.view(100, 100).unwrap();
        let seen = mirrored.direction(PixelPoint::new(0.0, 50.0)).unwrap();
        assert!(seen.dot(Direction::RIGHT) > 0.7);
        let upside_down = Placement { mirror: Mirror { x: false, y: true }, ..FACE }.view(100, 100).unwrap();
        assert!(upside_down.direction(PixelPoint::new(50.0, 0.0)).unwrap().dot(Direction::DOWN) > 0.7);
    }

    #[test]
    fn a_dome_turns_with_its_placement() {
        use crate::sphere::Angle;
        let orientation = Orientation::from_yaw_pitch_roll(Angle::from_degrees(90.0), Angle::ZERO, Angle::ZERO);
        let dome =
            Placement { orientation, ..Placement::new(CameraModel::Fulldome(super::super::FulldomeCamera::default())) };
        let bottom = dome.view(100, 100).unwrap().direction(PixelPoint::new(50.0, 100.0)).unwrap();
        assert!(bottom.angle_to(Direction::RIGHT).degrees() < 1e-9);
    }
}
