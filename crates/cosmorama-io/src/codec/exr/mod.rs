//! OpenEXR.

mod attributes;
mod colour;
mod dwa;
mod in_order;
mod offer;
mod planes;
mod reader;
mod selection;
mod window;
mod writer;

use std::path::Path;

use cosmorama::raster::{EncodedImage, FramePool};

use crate::codec::interface::{Codec, Sink, Source};
use crate::header::{Header, ImageFile};
use crate::{Choice, IoError, LayeredImage, Limits, MadeLayers, MadeRows, Plane, WriteOptions};

/// Codec of OpenEXR.
pub(crate) struct Exr;

impl Codec for Exr {
    fn probe(&self, path: &Path, source: Source<'_>) -> Result<Header, IoError> {
        reader::probe(path, source, &Choice::default())
    }

    fn decode(&self, path: &Path, source: Source<'_>, limits: &Limits, pool: &FramePool) -> Result<ImageFile, IoError> {
        reader::read(path, source, (limits, pool), &Choice::default())
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

    fn encode_rows(
        &self,
        path: &Path,
        output: Sink<'_>,
        rows: MadeRows<'_>,
        options: &WriteOptions,
    ) -> Result<(), IoError> {
        writer::write_rows(path, output, rows, options)
    }

    fn encode_levels(
        &self,
        path: &Path,
        output: Sink<'_>,
        levels: &[EncodedImage],
        options: &WriteOptions,
    ) -> Result<(), IoError> {
        writer::write_levels(path, output, levels, options)
    }

    fn encode_layers(
        &self,
        path: &Path,
        output: Sink<'_>,
        layered: LayeredImage<'_>,
        options: &WriteOptions,
    ) -> Result<(), IoError> {
        writer::write_layers(path, output, layered, options)
    }

    fn encode_layer_rows(
        &self,
        path: &Path,
        output: Sink<'_>,
        layers: MadeLayers<'_>,
        options: &WriteOptions,
    ) -> Result<(), IoError> {
        writer::write_layer_rows(path, output, layers, options)
    }

    fn probe_chosen(&self, path: &Path, source: Source<'_>, choice: &Choice) -> Result<Header, IoError> {
        reader::probe(path, source, choice)
    }

    fn decode_chosen(
        &self,
        path: &Path,
        source: Source<'_>,
        memory: (&Limits, &FramePool),
        choice: &Choice,
    ) -> Result<ImageFile, IoError> {
        reader::read(path, source, memory, choice)
    }

    fn check_chosen(&self, path: &Path, source: Source<'_>, limits: &Limits, choice: &Choice) -> Result<(), IoError> {
        reader::check(path, source, limits, choice)
    }

    fn decode_planes(
        &self,
        path: &Path,
        source: Source<'_>,
        limits: &Limits,
        wanted: (&Choice, &[&str]),
    ) -> Result<Vec<Plane>, IoError> {
        planes::read_planes(path, source, limits, wanted)
    }

    fn probe_pairs(&self, path: &Path, source: Source<'_>) -> Result<Header, IoError> {
        reader::probe_pairs(path, source)
    }

    fn decode_pairs(&self, path: &Path, source: Source<'_>, limits: &Limits) -> Result<ImageFile, IoError> {
        reader::read_pairs(path, source, limits)
    }
}
