use cosmorama::camera::{CameraModel, FieldOfView, PerspectiveCamera, Placement, View};
use cosmorama::sphere::{Angle, Orientation};
use glam::DVec3;

use crate::camera::{Camera, Orthographic};
use crate::error::SceneError;
use crate::shape::Placing;

/// A camera that a model's file has.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelCamera {
    /// Its name, perhaps empty.
    pub name: String,
    /// Place of the eye.
    pub eye: DVec3,
    /// Orientation.
    pub orientation: Orientation,
    /// Lens.
    pub lens: ModelLens,
}

/// Lens of a model's camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ModelLens {
    /// Perspective.
    Perspective {
        /// Field of view from top to bottom.
        height: Angle,
        /// Width over height, if the file says.
        aspect: Option<f64>,
    },
    /// Parallel rays.
    Orthographic {
        /// Height of what is seen.
        height: f64,
        /// Width over height, if the file says.
        aspect: Option<f64>,
    },
}

impl ModelCamera {
    /// Returns the camera of a model that is placed.
    pub(super) fn placed(&self, placing: &Placing) -> Self {
        let lens = match self.lens {
            ModelLens::Orthographic { height, aspect } => {
                ModelLens::Orthographic { height: height * placing.scale, aspect }
            }
            perspective @ ModelLens::Perspective { .. } => perspective,
        };
        Self {
            name: self.name.clone(),
            eye: placing.point(self.eye),
            orientation: self.orientation.within(placing.turn),
            lens,
        }
    }

    /// Returns the rows of a picture of so many columns.
    pub fn rows(&self, columns: usize) -> usize {
        /// Shape of pictures of cameras that have none of their own.
        const USUAL: f64 = 4.0 / 3.0;
        let (ModelLens::Perspective { aspect, .. } | ModelLens::Orthographic { aspect, .. }) = self.lens;
        let aspect = aspect.filter(|aspect| aspect.is_finite() && *aspect > 0.0).unwrap_or(USUAL);
        ((columns as f64 / aspect).round() as usize).max(1)
    }

    /// Returns the camera for a picture of so many pixels. Its height is what the file says.
    ///
    /// # Errors
    /// When the file's numbers make no camera, or there are no pixels.
    pub fn camera(&self, pixels: [usize; 2]) -> Result<Camera, SceneError> {
        match self.lens {
            ModelLens::Orthographic { height, .. } => {
                Ok(Camera::Orthographic(Orthographic::turned((self.eye, self.orientation), height, pixels)?))
            }
            ModelLens::Perspective { height, .. } => {
                let lens = CameraModel::from(PerspectiveCamera::new(FieldOfView::Vertical(height)));
                let placement = Placement { orientation: self.orientation, ..Placement::new(lens) };
                let view: View = placement.view(pixels[0], pixels[1])?;
                Ok(Camera::Lens { eye: self.eye, view: Box::new(view) })
            }
        }
    }
}
