//! What files say of themselves before their pixels, and the formats that they are of.

mod format;

use cosmorama::raster::{Channels, Depth, EncodedImage};

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
