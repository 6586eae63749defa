//! Pictures of things against sums of many samples.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should stop where it stands")]

mod hostile;
mod meshes;
mod models;
mod occlusion;
mod rough;
mod spheres;
mod textures;
mod variants;
mod winding;
mod worlds;
