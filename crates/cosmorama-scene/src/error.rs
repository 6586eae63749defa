use cosmorama::camera::CameraError;
use cosmorama::filter::PrepareError;
use cosmorama::layout::LayoutError;
use cosmorama::lighting::LobeError;
use cosmorama::world::{LightError, PictureError};
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
    /// A camera's numbers make no view.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// A material is out of range.
    #[error(transparent)]
    Material(#[from] MaterialError),
    /// The light is not that of the world.
    #[error(transparent)]
    Light(#[from] LightError),
    /// Pictures do not make a world.
    #[error(transparent)]
    Pictures(#[from] PictureError),
    /// Faces of a size cannot be laid out.
    #[error(transparent)]
    Layout(#[from] LayoutError),
    /// The filter of reflections cannot be prepared.
    #[error(transparent)]
    Filter(#[from] PrepareError),
    /// A lobe is out of range.
    #[error(transparent)]
    Lobe(#[from] LobeError),
    /// The maps of light are not those of the scene's materials.
    #[error("the maps of light are of another scene: there is none for {0}")]
    NoMap(&'static str),
    /// A ball is nowhere, or has no surface.
    #[error("a ball of radius {radius} at {centre:?} is none; expected finite numbers, and a radius more than 0")]
    Ball {
        /// Its centre.
        centre: [f64; 3],
        /// Its radius.
        radius: f64,
    },
    /// A mesh of glass bounds no solid.
    #[error(
        "glass must be closed, but the mesh ends or turns inside out at the edge from {:?} to {:?}; mend it, or give it another \
         material",
        .0[0], .0[1]
    )]
    Open([[f64; 3]; 2]),
    /// A thing stands under a world that there is none of.
    #[error("a thing stands under world number {number}, but there are {count}, from 0 on")]
    NoWorld {
        /// The world's number.
        number: usize,
        /// Number of worlds.
        count: usize,
    },
    /// A triangle names a part that the thing does not have.
    #[error("a triangle is of part number {part}, but the thing has {count}, from 0 on")]
    NoPart {
        /// The part's number.
        part: usize,
        /// Number of parts.
        count: usize,
    },
    /// A row of spheres without spheres, or with too many.
    #[error("a row of {count} spheres: expected 1 to {most}")]
    Count {
        /// Number asked for.
        count: usize,
        /// Greatest number.
        most: usize,
    },
}
