//! TIFF.

mod carried;
mod extent;
mod reader;
mod writer;

use std::path::Path;

use cosmorama::raster::{EncodedImage, FramePool};

use crate::codec::interface::{Codec, Sink, Source};
use crate::header::{Header, ImageFile};
use crate::{IoError, Limits, WriteOptions};

/// Codec of TIFF.
pub(crate) struct Tiff;

impl Codec for Tiff {
    fn probe(&self, path: &Path, source: Source<'_>) -> Result<Header, IoError> {
        reader::probe(path, source)
    }

    fn decode(&self, path: &Path, source: Source<'_>, limits: &Limits, pool: &FramePool) -> Result<ImageFile, IoError> {
        reader::read(path, source, limits, pool)
    }

    fn encode(
        &self,
        path: &Path,
        output: Sink<'_>,
        image: &EncodedImage,
        options: &WriteOptions,
    ) -> Result<(), IoError> {
        writer::write(path, output, image, &options.metadata, options.compression)
    }
}
