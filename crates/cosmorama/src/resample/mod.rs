//! Resampling: from a world of views to the pixels of a target.

mod block;
mod ellipse;
mod filter;
mod gather;
mod kernel;
mod lookup;
mod need;
mod plan;
mod reference;
mod screen_mask;
mod taps;

pub use ellipse::Ellipse;
pub use filter::{Filter, FilterKind};
pub use kernel::{CrossSection, Kernel};
pub use need::{Need, Needs, Uncovered};
pub use plan::{Plan, Resampler};
pub use screen_mask::ScreenMask;
pub use taps::{Tap, Taps};
