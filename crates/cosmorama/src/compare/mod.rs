//! Comparison of two pictures in value (PSNR, largest difference) and in place (sub-pixel registration).
//!
//! Value alone is not enough. Pictures half a pixel apart can still score 54 dB away from edges, and a sharper filter
//! scores worse than a blurrier one that is displaced. So [`compare`] measures both.

mod comparison;
mod difference;
mod difference_image;
mod edges;
mod error;
mod likeness;
mod mask;
mod own_peak;
mod pair;
mod quantile;
mod registration;

pub(crate) use comparison::linear_difference;
pub use comparison::{Comparison, EdgeFree, compare};
pub use difference::{Difference, Largest};
pub use difference_image::difference_image;
pub use error::CompareError;
pub use likeness::likeness;
pub use mask::Mask;
pub use own_peak::OwnPeak;
pub use registration::Registration;
