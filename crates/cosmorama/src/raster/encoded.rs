use half::f16;

use super::{Image, ImageError, Rgba, Transfer};

/// Which channels a pixel has in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Channels {
    /// Grey.
    Grey,
    /// Grey and alpha.
    GreyAlpha,
    /// Red, green, blue.
    Rgb,
    /// Red, green, blue, alpha.
    Rgba,
}

impl Channels {
    /// Samples in a pixel.
    pub const fn count(self) -> usize {
        match self {
            Self::Grey => 1,
            Self::GreyAlpha => 2,
            Self::Rgb => 3,
            Self::Rgba => 4,
        }
    }

    /// Whether there is an alpha channel.
    pub const fn has_alpha(self) -> bool {
        matches!(self, Self::GreyAlpha | Self::Rgba)
    }
}

/// Sample type of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Depth {
    /// 8-bit integers.
    Eight,
    /// 10 significant bits, spread over 16-bit integers.
    Ten,
    /// 12 significant bits, spread over 16-bit integers.
    Twelve,
    /// 16-bit integers.
    Sixteen,
    /// 16-bit floats.
    Half,
    /// 32-bit floats.
    Float,
}

/// The samples of an image, interleaved, row by row, as a file holds them: encoded, alpha not premultiplied.
#[derive(Clone, Debug, PartialEq)]
pub enum Samples {
    /// 8-bit integers.
    U8(Vec<u8>),
    /// 16-bit integers.
    U16(Vec<u16>),
    /// Half floats.
    Half(Vec<f16>),
    /// Floats.
    Float(Vec<f32>),
}

/// An image as a file holds it.
#[derive(Clone, Debug, PartialEq)]
pub struct EncodedImage {
    width: usize,
    height: usize,
    channels: Channels,
    samples: Samples,
}
