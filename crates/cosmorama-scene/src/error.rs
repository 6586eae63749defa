use cosmorama::world::LightError;
use thiserror::Error;

use crate::material::MaterialError;

/// Reason why there is no picture of a scene.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SceneError {
    /// The eye looks nowhere.
    #[error("the eye at {eye:?} looks at {target:?}, which is no direction; give a target away from the eye")]
    NoDirection {
        /// The eye.
        eye: [f64; 3],
        /// The point that it looks at.
        target: [f64; 3],
    },
    /// A picture without height.
    #[error("a picture {0} units high shows nothing; expected a height more than 0")]
    Height(f64),
    /// A picture without pixels.
    #[error("a picture of {}x{} has no pixels", .0[0], .0[1])]
    NoPixels([usize; 2]),
    /// A material is out of range.
    #[error(transparent)]
    Material(#[from] MaterialError),
    /// The light is not that of the world.
    #[error(transparent)]
    Light(#[from] LightError),
    /// A table of chrome without colours, or out of order.
    #[error("a table of chrome needs colours at elevations that rise from −90° to 90°")]
    Stops,
    /// A row of spheres without spheres, or with too many.
    #[error("a row of {count} spheres: expected 1 to {most}")]
    Count {
        /// Number asked for.
        count: usize,
        /// Greatest number.
        most: usize,
    },
}
