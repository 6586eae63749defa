//! Worlds: radiance by direction, held as a set of views.

mod blend;
mod closed;
mod coverage;
mod field_stop;
mod frame;
mod framing;
mod grid;
mod halved;
mod layout;
mod mask_shape;
mod overlap;
#[cfg(test)]
mod panorama;
mod rim_texels;
mod seen_cone;
mod solid_angles;
mod st_pixels;
mod suns;
mod view;
mod view_mask;
#[allow(clippy::module_inception)]
mod world;

pub use blend::Blend;
pub use coverage::ScreenPixel;
pub use field_stop::FieldStop;
pub use frame::*;
pub use framing::OmnimaxFraming;
pub use grid::{PixelBounds, PixelGrid, PixelPoint, PixelRect};
pub(crate) use halved::held;
pub use layout::{
    Arrangement, CubeLayout, DualFisheye, DualLens, Eye, FaceOrder, FacePart, FacePlacement, LayoutError, LayoutKind,
    LensSide, Naming, PlacedFace, PlacedLens, Stereo,
};
pub use mask_shape::MaskShape;
#[cfg(test)]
pub(crate) use panorama::panorama;
pub use rim_texels::RimTexels;
pub use solid_angles::SolidAngles;
pub use st_pixels::{ST_NOWHERE, StPixel};
pub use view::{Footprint, View};
pub use view_mask::ViewMask;
pub(crate) use world::TexelPlace;
pub use world::{Source, World, WorldError, WorldView};
