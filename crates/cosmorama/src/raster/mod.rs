//! Images in memory: linear light for filtering, encoded samples as files hold them, and the transfer functions between.

mod channels;
mod colour_channel;
mod decode;
mod depth;
mod encode;
mod encoded;
mod fixed;
mod fixed_light;
mod image;
mod quantizer;
mod rgba;
mod row_layout;
mod tone_curve;
mod transfer;
mod uniform;

pub use channels::Channels;
pub use colour_channel::ColourChannel;
pub use decode::Decoder;
pub use depth::Depth;
pub use encode::{Encoder, Threads};
pub use encoded::{AlphaMode, EncodedImage, Samples};
pub(crate) use fixed::FixedCodes;
pub use fixed::{FixedCodec, FixedDecoder};
pub use fixed_light::FixedLight;
pub use image::{Image, ImageError};
pub use rgba::Rgba;
pub(crate) use row_layout::RowLayout;
pub use tone_curve::ToneCurve;
pub use transfer::Transfer;
pub use uniform::Uniform;
