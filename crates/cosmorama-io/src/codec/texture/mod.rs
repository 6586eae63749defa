//! Cubes in textures of graphics cards: DirectDraw surfaces and Khronos textures.

mod cube;
pub(crate) mod dds;
pub(crate) mod ktx;
pub(crate) mod ktx2;
mod packing;
mod texel;
