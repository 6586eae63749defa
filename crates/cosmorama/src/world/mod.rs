//! Worlds: radiance by direction, held as a set of views.

mod blend;
mod bounding_cone;
mod edge_decontamination;
mod halved;
pub(crate) mod mask;
mod overlap;
#[cfg(test)]
mod panorama;
mod solid_angles;
mod st_pixels;
mod watertight;
#[allow(clippy::module_inception)]
mod world;

pub use blend::Blend;
pub use edge_decontamination::RimTexels;
pub(crate) use halved::held;
pub use mask::mask::ViewMask;
pub use mask::shape::MaskShape;
#[cfg(test)]
pub(crate) use panorama::panorama;
pub use solid_angles::SolidAngles;
pub use st_pixels::{ST_NOWHERE, StPixel};
pub(crate) use world::TexelPlace;
pub use world::{Source, World, WorldError, WorldView};
