//! OpenEXR.

mod colour;
mod dwa;
mod reader;
mod selection;
mod window;
mod writer;

use std::path::Path;

use cosmorama::raster::{EncodedImage, FramePool};

use crate::codec::interface::{Codec, Sink, Source};
use crate::header::{Header, ImageFile};
use crate::{IoError, Limits, WriteOptions};

pub(crate) use writer::write_planes;

/// Codec of OpenEXR.
pub(crate) struct Exr;

impl Codec for Exr {
    fn recognises(&self, start: &[u8]) -> bool {
        start.starts_with(&reader::MARK)
    }

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
        writer::write(path, output, image, options)
    }

    fn probe_pairs(&self, path: &Path, source: Source<'_>) -> Result<Header, IoError> {
        reader::probe_pairs(path, source)
    }

    fn decode_pairs(&self, path: &Path, source: Source<'_>, limits: &Limits) -> Result<ImageFile, IoError> {
        reader::read_pairs(path, source, limits)
    }
}
