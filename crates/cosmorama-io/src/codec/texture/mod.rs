//! Cube maps in textures for graphics cards: DirectDraw surfaces and Khronos textures.

mod cube;
mod dds;
mod ktx;
mod ktx2;
mod packing;
mod texel;

pub(crate) use dds::Dds;
pub(crate) use ktx::Ktx;
pub(crate) use ktx2::Ktx2;
