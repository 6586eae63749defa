//! TIFF.

mod carried;
mod extent;
mod jpeg_parts;
mod reader;
mod writer;

use std::path::Path;

use cosmorama::raster::{EncodedImage, FramePool};

use crate::codec::interface::{Codec, Sink, Source};
use crate::header::{Header, ImageFile, Picture};
use crate::{Choice, IoError, Limits, MadeRows, WriteOptions};

/// Codec of TIFF.
pub(crate) struct Tiff;

impl Codec for Tiff {
    fn probe(&self, path: &Path, source: Source<'_>) -> Result<Header, IoError> {
        reader::probe(path, source)
    }

    fn decode(&self, path: &Path, source: Source<'_>, limits: &Limits, pool: &FramePool) -> Result<ImageFile, IoError> {
        reader::read(path, source, limits, pool)
    }

    fn check_chosen(&self, path: &Path, source: Source<'_>, limits: &Limits, _: &Choice) -> Result<(), IoError> {
        reader::check(path, source, limits)
    }

    fn encode(
        &self,
        path: &Path,
        output: Sink<'_>,
        image: &EncodedImage,
        options: &WriteOptions,
    ) -> Result<(), IoError> {
        writer::write(path, output, Picture::Held(image), options)
    }

    fn encode_rows(
        &self,
        path: &Path,
        output: Sink<'_>,
        rows: MadeRows<'_>,
        options: &WriteOptions,
    ) -> Result<(), IoError> {
        writer::write(path, output, Picture::Made(rows), options)
    }
}
