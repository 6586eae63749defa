//! Images in memory: linear light for filtering, encoded samples as files hold them, and the transfer functions between.

mod encoded;
mod image;
mod rgba;
mod transfer;

pub use encoded::{Channels, Depth, EncodedImage, Samples};
pub use image::{Image, ImageError};
pub use rgba::Rgba;
pub use transfer::{ToneCurve, Transfer};
