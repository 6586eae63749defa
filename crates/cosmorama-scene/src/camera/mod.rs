//! Cameras: any view of the library from an eye, and parallel rays.

mod orthographic;
mod place;

use cosmorama::camera::{PixelPoint, View};
use cosmorama::sphere::{Direction, Orientation};
use glam::{DMat3, DQuat, DVec3};

use crate::error::SceneError;
use crate::ray::{Ray, RayChange};

pub use orthographic::Orthographic;
pub use place::Place;

/// A camera: the beam that each pixel of a picture sees.
#[derive(Clone, Debug, PartialEq)]
pub enum Camera {
    /// A view of the library in an eye: perspective, fisheye, panorama or any other.
    Lens {
        /// Place of the eye.
        eye: DVec3,
        /// Directions of the pixels.
        view: Box<View>,
    },
    /// Parallel rays.
    Orthographic(Orthographic),
}

impl Camera {
    /// Returns a camera of the library at a place. The view's own orientation is kept, relative to what it looks at.
    ///
    /// # Errors
    /// When the place has no direction.
    pub fn lens(place: Place, view: View) -> Result<Self, SceneError> {
        let orientation = view.orientation.within(place.orientation()?);
        Ok(Self::Lens { eye: place.eye, view: Box::new(View { orientation, ..view }) })
    }

    /// Returns the camera in another frame.
    pub(crate) fn turned(&self, turn: &DMat3) -> Self {
        match self {
            Self::Lens { eye, view } => {
                let outer = Orientation::from_rotation(DQuat::from_mat3(turn));
                let orientation = view.orientation.within(outer);
                Self::Lens { eye: *turn * *eye, view: Box::new(View { orientation, ..(**view).clone() }) }
            }
            Self::Orthographic(camera) => Self::Orthographic(camera.in_frame(turn)),
        }
    }

    /// Returns the number of columns.
    pub fn width(&self) -> usize {
        match self {
            Self::Lens { view, .. } => view.width(),
            Self::Orthographic(camera) => camera.width,
        }
    }

    /// Returns the number of rows.
    pub fn height(&self) -> usize {
        match self {
            Self::Lens { view, .. } => view.height(),
            Self::Orthographic(camera) => camera.height,
        }
    }

    /// Returns the ray through a point of the picture; `None` where the lens shows nothing.
    pub fn ray(&self, pixel: PixelPoint) -> Option<Ray> {
        match self {
            Self::Lens { eye, view } => {
                let footprint = view.footprint(pixel)?;
                let change = |direction: DVec3| RayChange { origin: DVec3::ZERO, direction };
                Some(Ray {
                    origin: *eye,
                    direction: footprint.direction.vector(),
                    dx: change(footprint.jacobian.dx),
                    dy: change(footprint.jacobian.dy),
                })
            }
            Self::Orthographic(camera) => Some(camera.ray(pixel)),
        }
    }

    /// Returns the place of a point in the picture; `None` where the lens does not show it.
    pub(crate) fn pixel(&self, point: DVec3) -> Option<PixelPoint> {
        match self {
            Self::Lens { eye, view } => Direction::new(point - *eye).and_then(|direction| view.pixel(direction)),
            Self::Orthographic(camera) => camera.pixel(point),
        }
    }

    /// Returns the direction in which a point is seen; `None` from the point itself.
    pub(crate) fn towards(&self, point: DVec3) -> Option<DVec3> {
        match self {
            Self::Lens { eye, .. } => (point - *eye).try_normalize(),
            Self::Orthographic(camera) => Some(camera.direction().vector()),
        }
    }

    /// Returns the part of a pixel that the lens shows.
    pub(crate) fn coverage(&self, i: usize, j: usize) -> f64 {
        match self {
            Self::Lens { view, .. } => view.screen_pixel(i, j).map_or(0.0, |pixel| pixel.coverage),
            Self::Orthographic(_) => 1.0,
        }
    }
}
