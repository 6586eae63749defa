//! Whole pictures: fast application of a filter to every pixel of a target.

pub(crate) mod apply;
pub(crate) mod batch;
mod picture;
pub(crate) mod plan;
mod progress;
pub(crate) mod pyramid;
pub(crate) mod required;
pub(crate) mod resampler;
pub(crate) mod scan;
mod watched;
mod whole_picture;

pub use picture::picture;
pub use plan::{Arithmetic, Plan};
pub use progress::{Progress, Share, Stopped};
pub(crate) use pyramid::{Pyramid, TexelCount};
pub use required::need::{Accuracy, Need, Needs};
pub use required::require::MissingLight;
pub use required::screen_mask::ScreenMask;
pub use required::uncovered::Uncovered;
pub use resampler::Resampler;
pub use watched::Watched;
