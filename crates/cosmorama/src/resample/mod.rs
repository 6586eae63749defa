//! Resampling: from a world of views to the pixels of a target.

mod bend;
mod block;
mod candidates;
mod cap;
mod cubics;
mod ellipse;
mod ellipses;
mod ewa;
mod field_edge;
mod filter;
mod gather;
mod kernel;
mod lookup;
mod moments;
mod need;
mod patch;
mod pixel_taps;
mod plan;
mod reference;
mod scan;
mod screen_mask;
mod slope;
mod surround;
mod taps;
mod texel_run;
mod window;

pub use ellipse::Ellipse;
pub use ewa::{TextureDerivatives, WeightTable, ewa};
pub use filter::{Filter, FilterKind};
pub(crate) use kernel::KernelTable;
pub use kernel::{CrossSection, Kernel};
pub use need::{Need, Needs, Uncovered};
pub(crate) use pixel_taps::PixelTaps;
pub use plan::{Plan, Resampler};
pub use screen_mask::ScreenMask;
use taps::{Tap, Taps};
