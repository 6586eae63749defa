use cosmorama::camera::PixelPoint;
use cosmorama::sphere::{Direction, Orientation};
use glam::{DMat3, DVec3};

use super::Place;
use crate::error::SceneError;
use crate::ray::{Ray, RayChange};

/// A camera whose rays are parallel: it sees one direction of the world, and things without perspective.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orthographic {
    /// Place of the eye, in the middle of the picture.
    eye: DVec3,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    /// Length of a pixel's side.
    step: f64,
    /// Number of columns.
    pub(crate) width: usize,
    /// Number of rows.
    pub(crate) height: usize,
}

impl Orthographic {
    /// Returns the camera at a place whose picture is so high, in the units of the scene.
    ///
    /// # Errors
    /// When the place has no direction, the height is not more than 0, or there are no pixels.
    pub fn new(place: Place, height: f64, pixels: [usize; 2]) -> Result<Self, SceneError> {
        Self::turned((place.eye, place.orientation()?), height, pixels)
    }

    /// Returns the camera of an eye with an orientation.
    pub(crate) fn turned(
        (eye, orientation): (DVec3, Orientation),
        height: f64,
        pixels: [usize; 2],
    ) -> Result<Self, SceneError> {
        if !(height.is_finite() && height > 0.0) {
            return Err(SceneError::Height(height));
        }
        if pixels.contains(&0) {
            return Err(SceneError::NoPixels(pixels));
        }
        let axis = |direction: Direction| orientation.to_world(direction).vector();
        Ok(Self {
            eye,
            right: axis(Direction::RIGHT),
            up: axis(Direction::UP),
            forward: axis(Direction::FRONT),
            step: height / pixels[1] as f64,
            width: pixels[0],
            height: pixels[1],
        })
    }

    /// Returns the camera in another frame.
    pub(super) fn in_frame(&self, turn: &DMat3) -> Self {
        let [eye, right, up, forward] = [self.eye, self.right, self.up, self.forward].map(|vector| *turn * vector);
        Self { eye, right, up, forward, ..*self }
    }

    /// Returns the direction that it sees.
    pub fn direction(&self) -> Direction {
        Direction::from_unit(self.forward)
    }

    /// Returns the place of a point in the picture; `None` behind the eye.
    pub(super) fn pixel(&self, point: DVec3) -> Option<PixelPoint> {
        let offset = point - self.eye;
        let place = || {
            let (x, y) = (offset.dot(self.right) / self.step, offset.dot(self.up) / self.step);
            PixelPoint::new(x + self.width as f64 / 2.0, self.height as f64 / 2.0 - y)
        };
        (offset.dot(self.forward) > 0.0).then(place)
    }

    /// Returns the ray through a point of the picture.
    pub(super) fn ray(&self, pixel: PixelPoint) -> Ray {
        let (x, y) = (pixel.x - self.width as f64 / 2.0, self.height as f64 / 2.0 - pixel.y);
        let change = |origin: DVec3| RayChange { origin, direction: DVec3::ZERO };
        Ray {
            origin: self.eye + (self.right * x + self.up * y) * self.step,
            direction: self.forward,
            dx: change(self.right * self.step),
            dy: change(self.up * -self.step),
        }
    }
}
