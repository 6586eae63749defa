//! What files say of themselves before their pixels, and the formats that they are of.

mod format;

use cosmorama::raster::{Channels, Depth, EncodedImage, Image, Rgba, Transfer};

pub use format::Format;

use crate::metadata::{Metadata, Window};

/// What a file says of itself before its pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    /// Format, found from the file's content.
    pub format: Format,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Channels that [`read`](crate::read) gives.
    pub channels: Channels,
    /// Depth that [`read`](crate::read) gives.
    pub depth: Depth,
    /// What the file says about its pixels.
    pub metadata: Metadata,
    /// Where the pixels lie in a larger canvas; `None` where they are all of it.
    pub window: Option<Window>,
}

/// A file in memory: its pixels and what it says about them.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageFile {
    /// Format, found from the file's content.
    pub format: Format,
    /// Pixels as the file codes them.
    pub image: EncodedImage,
    /// What the file says about its pixels.
    pub metadata: Metadata,
    /// Where the pixels lie in a larger canvas; `None` where they are all of it.
    pub window: Option<Window>,
}

impl ImageFile {
    /// Returns how the file's code values relate to light: linear where they are floats, else as the file says, else sRGB.
    pub fn transfer(&self) -> Transfer {
        if self.image.depth().is_float() {
            return Transfer::Linear;
        }
        self.metadata.transfer.clone().unwrap_or_default()
    }

    /// Computes the file's linear light.
    pub fn to_light(&self) -> Image<Rgba> {
        self.image.to_light(&self.transfer())
    }
}
