//! One file for each format: `probe` reads a header, `read` reads pixels, `write` writes them.

use std::path::Path;

use cosmorama::raster::{EncodedImage, Samples};

use crate::{Header, ImageFile, IoError};

pub(crate) mod exr;
pub(crate) mod jpeg;
pub(crate) mod png;
pub(crate) mod radiance;
pub mod svg;
pub(crate) mod texture;
pub(crate) mod tga;
pub(crate) mod tiff;
mod write_options;

pub use write_options::{Compression, WriteOptions};

/// Whether this thread is one of a pool: the others have files of their own then, and one does all of this file.
fn is_beside_others() -> bool {
    rayon::current_thread_index().is_some()
}

/// The file that a header announced, with its samples.
fn whole_image(path: &Path, header: Header, samples: Samples) -> Result<ImageFile, IoError> {
    let Header { format, width, height, channels, depth, metadata, window } = header;
    let image = EncodedImage::new(width, height, channels, depth, samples)
        .map_err(|error| IoError::damaged(path, format, error))?;
    Ok(ImageFile { format, image, metadata, window })
}
