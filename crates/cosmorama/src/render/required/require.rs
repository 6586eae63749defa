use thiserror::Error;

use super::uncovered::Uncovered;
use crate::camera::View;
use crate::filter::FilterSettings;
use crate::render::{Accuracy, Needs};
use crate::world::World;

/// Error of a world that does not hold what a picture needs.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("{0}")]
pub struct MissingLight(pub Uncovered);

impl World {
    /// Checks that some view holds every direction that a target's pixels look at.
    ///
    /// Filters accept a partial world and average what there is. If you want a whole picture, call this first.
    ///
    /// ```
    /// use cosmorama::prelude::*;
    ///
    /// let half = CameraModel::from(FisheyeCamera::default());
    /// let (world, _) = World::from_lens(half, Image::filled(64, 64, Rgba::BLACK))?;
    /// let ahead = CameraModel::from(PerspectiveCamera::new(FieldOfView::Horizontal(Angle::from_degrees(60.0))));
    /// assert!(world.require(&ahead.view(32, 24)?).is_ok());
    /// let around = CameraModel::from(EquirectCamera::default()).view(64, 32)?;
    /// assert!(world.require(&around).unwrap_err().to_string().contains("look where no view does"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`MissingLight`] says how many pixels look where no view does, and where.
    pub fn require(&self, target: &View) -> Result<(), MissingLight> {
        let needs = Needs::of(self, std::slice::from_ref(target), &FilterSettings::DEFAULT, Accuracy::Bounds);
        needs.uncovered.map_or(Ok(()), |uncovered| Err(MissingLight(uncovered)))
    }
}
