//! Resampling: from a world of views to the pixels of a target.

mod candidates;
mod ellipse;
mod ewa;
mod filter;
mod gather;
mod kernel;
mod lookup;
mod plan;
mod reference;
mod taps;

pub use ellipse::Ellipse;
pub use ewa::{TextureDerivatives, WeightTable, ewa};
pub use filter::{Filter, FilterKind};
pub use kernel::{CrossSection, Kernel};
pub use plan::{Plan, Resampler};
pub use taps::{Tap, Taps};
