//! Filters: what is averaged over a footprint.

pub(crate) mod ellipse;
pub(crate) mod ewa_paper;
pub(crate) mod gather;
pub(crate) mod kernel;
pub(crate) mod lookup;
pub(crate) mod pixel_taps;
pub(crate) mod reference;
pub(crate) mod rim;
pub(crate) mod settings;
#[cfg(test)]
pub(crate) mod simd_levels;
pub(crate) mod taps;

pub use ellipse::Ellipse;
pub(crate) use ellipse::semi_axes;
pub use ewa_paper::{TextureDerivatives, WeightTable, ewa};
pub(crate) use kernel::KernelTable;
pub use kernel::{CrossSection, Kernel};
pub(crate) use pixel_taps::PixelTaps;
pub use settings::{Filter, FilterKind};
