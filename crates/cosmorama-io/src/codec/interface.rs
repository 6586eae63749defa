use std::io::{BufRead, Seek, Write};
use std::path::Path;

use cosmorama::raster::{EncodedImage, Samples};

use crate::header::{Header, ImageFile};
use crate::{IoError, Limits, WriteOptions};

/// Bytes of a file, wherever they come from: a file on disk, a slice of memory, standard input read into memory.
///
/// Implemented by every buffered reader that can seek.
pub trait ReadSeek: BufRead + Seek {}

impl<T: BufRead + Seek + ?Sized> ReadSeek for T {}

/// Place that the bytes of a file go to.
pub(crate) trait WriteSeek: Write + Seek {}

impl<T: Write + Seek + ?Sized> WriteSeek for T {}

/// Reader of a decoder. It stands at the file's first byte.
pub(crate) type Source<'a> = &'a mut (dyn ReadSeek + 'a);

/// Writer of an encoder. It stands where the file's first byte goes.
pub(crate) type Sink<'a> = &'a mut (dyn WriteSeek + 'a);

/// Decoder and encoder of a file format. `path` is what messages call the file.
pub(crate) trait Codec: Sync {
    /// Returns whether a file whose first bytes are `start` bears the mark of this format.
    fn recognises(&self, start: &[u8]) -> bool;

    /// Reads what a file says of itself, without its pixels.
    fn probe(&self, path: &Path, source: Source<'_>) -> Result<Header, IoError>;

    /// Reads a file's pixels, unless they need more memory than `limits` allow.
    fn decode(&self, path: &Path, source: Source<'_>, limits: &Limits) -> Result<ImageFile, IoError>;

    /// Writes a picture whose depth and channels the format supports.
    fn encode(
        &self,
        path: &Path,
        output: Sink<'_>,
        image: &EncodedImage,
        options: &WriteOptions,
    ) -> Result<(), IoError>;

    /// Writes a picture and its mip levels, the largest first. Only asked of formats that hold levels.
    fn encode_levels(
        &self,
        path: &Path,
        output: Sink<'_>,
        levels: &[EncodedImage],
        options: &WriteOptions,
    ) -> Result<(), IoError> {
        match levels {
            [image] => self.encode(path, output, image, options),
            _ => Err(IoError::write(path, "the format holds one picture")),
        }
    }

    /// Reads what a file says of the two channels of its st map.
    fn probe_pairs(&self, path: &Path, source: Source<'_>) -> Result<Header, IoError> {
        self.probe(path, source)
    }

    /// Reads the two channels of an st map, and others if they come with them.
    fn decode_pairs(&self, path: &Path, source: Source<'_>, limits: &Limits) -> Result<ImageFile, IoError> {
        self.decode(path, source, limits)
    }
}

/// Returns whether this thread belongs to a pool. The pool's other threads have files of their own then, and one thread does
/// all of this file.
pub(crate) fn is_beside_others() -> bool {
    rayon::current_thread_index().is_some()
}

/// Builds the file that a header announced from its samples.
pub(crate) fn whole_image(path: &Path, header: Header, samples: Samples) -> Result<ImageFile, IoError> {
    let Header { format, width, height, channels, depth, metadata, window } = header;
    let image = EncodedImage::new(width, height, channels, depth, samples)
        .map_err(|error| IoError::damaged(path, format, error))?;
    Ok(ImageFile { format, image, metadata, window })
}
