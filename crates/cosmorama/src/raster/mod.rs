//! Images in memory: linear light for filtering, encoded samples as in files, the transfer functions between them, and
//! the primaries of light.

mod channels;
pub(crate) mod codec;
mod depth;
mod encoded;
pub(crate) mod fixed_point;
mod image;
pub(crate) mod primaries;
mod rgba;
mod row_layout;
pub(crate) mod transfer;
mod uniform;

pub use channels::Channels;
pub use codec::decode::{Decoder, IrregularPixels};
pub use codec::encode::{Encoder, Threads};
pub use codec::frame_pool::{FramePool, Pixel, Sample};
pub use codec::samples::Samples;
pub use depth::Depth;
pub use encoded::{AlphaMode, EncodedImage};
pub(crate) use fixed_point::FixedCodes;
pub use fixed_point::light::FixedLight;
pub use fixed_point::{FixedCodec, FixedDecoder};
pub use image::{Image, ImageError};
pub use primaries::Primaries;
pub use primaries::colour_matrix::ColourMatrix;
pub use rgba::Rgba;
pub(crate) use row_layout::RowLayout;
pub use transfer::Transfer;
pub use transfer::colour_channel::ColourChannel;
pub use transfer::tone_curve::ToneCurve;
pub use uniform::Uniform;
