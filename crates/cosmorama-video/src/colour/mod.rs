//! Colour tags of video, by the numbers of ITU-T H.273.

mod frame;
mod hdr;
mod numbers;
mod rgb_to_yuv420;
mod yuv;
mod yuv420_to_rgb;

use cosmorama::raster::{Primaries, Transfer};
use cosmorama_io::transfer_of_number;

pub use hdr::{ContentLight, HdrTags, MasteringDisplay};
pub(crate) use numbers::Axis;
pub use numbers::transfer_number;
pub(crate) use rgb_to_yuv420::RgbToYuv420;
pub(crate) use yuv::Coding;
pub(crate) use yuv420_to_rgb::Yuv420ToRgb;

/// Colour tags of a video stream; `None` where it says nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ColourTags {
    /// Number of the primaries (H.273, table 2).
    pub primaries: Option<u8>,
    /// Number of the transfer function (H.273, table 3).
    pub transfer: Option<u8>,
    /// Number of the matrix from RGB to YUV (H.273, table 4); 0 for RGB itself.
    pub matrix: Option<u8>,
    /// Range of the codes.
    pub range: Option<SignalRange>,
    /// Place of the chroma samples, where they are fewer.
    pub chroma: Option<ChromaPlace>,
}

impl ColourTags {
    /// Creates the tags of pictures with these primaries and this transfer function; `None` for whatever has no number.
    pub fn of(primaries: &Primaries, transfer: &Transfer) -> Self {
        Self { primaries: primaries.number(), transfer: transfer_number(transfer), ..Self::default() }
    }

    /// Returns the primaries; `None` if they are not said, or unknown.
    pub fn known_primaries(&self) -> Option<Primaries> {
        self.primaries.and_then(Primaries::of_number)
    }

    /// Returns the transfer function; `None` if it is not said, or unknown. The curve of BT.709 cameras is read as displays show
    /// it, by BT.1886.
    pub fn known_transfer(&self) -> Option<Transfer> {
        self.transfer.and_then(transfer_of_number)
    }

    /// Returns whether the transfer function is one of high dynamic range: PQ or HLG.
    pub fn is_hdr(&self) -> bool {
        matches!(self.transfer, Some(16 | 18))
    }
}

/// Range of the codes of a video.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SignalRange {
    /// Black at 16 and white at 235, of 8 bits: "tv", "limited".
    Narrow,
    /// Black at 0 and white at 255, of 8 bits: "pc", "full".
    Full,
}

impl SignalRange {
    /// Returns ffmpeg's name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Narrow => "tv",
            Self::Full => "pc",
        }
    }
}

/// Place of a chroma sample between the luma samples around.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ChromaPlace {
    /// At the left column, between two rows: MPEG-2, H.264 by default.
    Left,
    /// In the middle of four luma samples: JPEG, MPEG-1.
    Centre,
    /// On the upper left luma sample: BT.2020, HDR10.
    TopLeft,
}
