//! Imports for most programs, in one `use`.
//!
//! ```
//! use cosmorama::prelude::*;
//!
//! let (world, light) = World::from_panorama(Image::filled(64, 32, Rgba::opaque(0.5, 0.5, 0.5)))?;
//! let dome = CameraModel::from(FulldomeCamera::default()).view(32, 32)?;
//! let frame = Resampler::new(&world, &dome).render(light.texels());
//! let codes = frame.to_codes(Depth::Eight, &Transfer::Srgb);
//! assert_eq!((codes.width(), codes.height()), (32, 32));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub use crate::camera::{
    CameraModel, Covariance, CubeFaceCamera, EquirectCamera, FieldOfView, FisheyeCamera, Footprint, FulldomeCamera,
    MirrorBallCamera, OmnimaxCamera, PerspectiveCamera, PixelPoint, Placement, SamplePositions, View,
};
pub use crate::filter::{Ewa, EwaPyramid, Filter, FilterKind, FilterSettings, Kernel, Prepared};
pub use crate::raster::{Channels, Depth, EncodedImage, Image, Rgba, Transfer};
pub use crate::render::Resampler;
pub use crate::sphere::{Angle, CubeFace, Direction, Orientation};
pub use crate::world::{Light, World};
