//! Headers of files, and file formats.

mod choice;
mod format;
mod plane;
mod rows;

use cosmorama::raster::{Channels, Depth, EncodedImage, Image, Rgba, Transfer};

pub use choice::Choice;
pub use format::Format;
pub use plane::{LayeredImage, Plane, PlaneSamples};
pub use rows::{LayeredRows, MadeLayers, MadeRows};

pub(crate) use choice::matches;
pub(crate) use rows::Picture;
#[cfg(feature = "exr")]
pub(crate) use rows::visit;

use crate::metadata::{Metadata, Window};

/// Header of a file: everything before its pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    /// Format, found from the file's content.
    pub format: Format,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Channels of the image that [`read`](crate::read) returns.
    pub channels: Channels,
    /// Depth of the image that [`read`](crate::read) returns.
    pub depth: Depth,
    /// Metadata about the pixels.
    pub metadata: Metadata,
    /// Place of the pixels in a larger canvas; `None` if they are all of it.
    pub window: Option<Window>,
}

/// A file in memory: its pixels and metadata.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageFile {
    /// Format, found from the file's content.
    pub format: Format,
    /// Encoded pixels.
    pub image: EncodedImage,
    /// Metadata about the pixels.
    pub metadata: Metadata,
    /// Place of the pixels in a larger canvas; `None` if they are all of it.
    pub window: Option<Window>,
}

impl ImageFile {
    /// Returns the file's transfer function: linear for floats, else the one that the file names, else sRGB.
    pub fn transfer(&self) -> Transfer {
        if self.image.depth().is_float() {
            return Transfer::Linear;
        }
        self.metadata.transfer.clone().unwrap_or_default()
    }

    /// Decodes the file to linear light.
    pub fn to_light(&self) -> Image<Rgba> {
        self.image.to_light(&self.transfer())
    }
}
