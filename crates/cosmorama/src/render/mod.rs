//! Whole pictures: fast application of a filter to every pixel of a target.

// Words of this room:
// - A *patch* is 8 × 8 pixels of the target, and a *band* is 32 rows of it.
// - A *window* is the rectangle of texels that make a pixel. A *single* is a pixel with a list of texels instead.
// - A *run* is up to eight neighbouring pixels of a row, a *lane* each, with windows of one size in one view.
// - A *group* is the runs of one patch that lie in one view.
// - A *mirror image* is a symmetric copy of the pixels that are computed. In a *transposed* one ("turned" in names),
//   rows are columns. A *walk* is the order in which it reads the texels of a window.
// - A *pass* is a group in up to four mirror images at once.
// - A texel lies *under* a pixel if it is near the pixel's centre. Anti-ringing clamps the pixel to these texels, and
//   *marks* are the bits that tell which they are.

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
pub(crate) use plan::wanted;
pub use plan::{Arithmetic, Plan};
pub use progress::{Progress, Share, Stopped};
pub(crate) use pyramid::{Pyramid, TexelCount};
pub use required::continuation::{Beyond, Continuation};
pub use required::need::{Accuracy, Need, Needs};
pub use required::require::MissingLight;
pub use required::screen_mask::ScreenMask;
pub use required::uncovered::Uncovered;
pub use resampler::Resampler;
pub(crate) use scan::sampling::Sampling;
pub(crate) use scan::wanted::Wanted;
pub use watched::Watched;
