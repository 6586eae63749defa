//! Split-sum tables: the light that a rough surface reflects of a white world, by angle of view and roughness.

mod albedo;
mod charlie;
mod gauss;
mod ggx;
mod half_vectors;
mod model;

pub use albedo::Albedo;
pub use model::{BrdfChannels, BrdfError, BrdfModel, LARGEST_BRDF_TABLE};

#[cfg(test)]
mod tests;
