//! Codecs: a file or a folder for each format, and the table that finds the codec of a format.
//!
//! To add a format: a variant of [`Format`] with its properties, a type that implements [`Codec`], and its line in [`codec`].

pub(crate) mod behind;
mod exr;
mod interface;
mod jpeg;
mod png;
mod radiance;
#[cfg(feature = "diagrams")]
pub mod svg;
mod texture;
mod tga;
mod tiff;
mod write_options;

use std::io::Read;
use std::path::Path;

pub(crate) use exr::{write_layers, write_planes};
pub use interface::ReadSeek;
pub use interface::is_contained;
pub(crate) use interface::{Codec, Source, contained, is_beside_others};
pub(crate) use texture::write_flat;
pub use write_options::{Compression, WriteOptions};

use crate::IoError;
use crate::header::Format;

/// Returns the codec of a format.
pub(crate) fn codec(format: Format) -> &'static dyn Codec {
    match format {
        Format::Png => &png::Png,
        Format::Jpeg => &jpeg::Jpeg,
        Format::Tiff => &tiff::Tiff,
        Format::Tga => &tga::Tga,
        Format::Hdr => &radiance::Hdr,
        Format::Exr => &exr::Exr,
        Format::Ktx2 => &texture::Ktx2,
        Format::Ktx => &texture::Ktx,
        Format::Dds => &texture::Dds,
        Format::Video | Format::Pfm => &interface::Elsewhere,
    }
}

/// Number of bytes at the start of a file that identify its format.
const START: u64 = 16;

/// Finds the format of a file by its first bytes, which are not consumed.
pub(crate) fn recognise(path: &Path, source: Source<'_>) -> Result<Format, IoError> {
    let mut start = Vec::with_capacity(START as usize);
    let mut begin = || {
        source.rewind()?;
        (&mut *source).take(START).read_to_end(&mut start)?;
        source.rewind()
    };
    begin().map_err(|error| IoError::open(path, error))?;
    if start.is_empty() {
        return Err(IoError::Empty { path: path.to_owned() });
    }
    let by_mark = Format::ALL.into_iter().find(|format| codec(*format).recognises(&start));
    // TGA files begin with no mark, so that only the name tells.
    let by_name = || Format::from_extension(path).ok().filter(|format| *format == Format::Tga);
    by_mark.or_else(by_name).ok_or_else(|| IoError::UnknownContent { path: path.to_owned() })
}

impl Format {
    /// Returns the format for a file name's extension.
    ///
    /// # Errors
    /// When the extension is unknown or missing.
    pub fn from_extension(path: &Path) -> Result<Self, IoError> {
        let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
        Self::of_extension(extension).ok_or_else(|| IoError::UnknownExtension { path: path.to_owned() })
    }
}
