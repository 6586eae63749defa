//! Portable float maps (PF, Pf), one behind the other: light as 32-bit floats, rows from below.

use std::io::{BufRead, Write};

use cosmorama::raster::EncodedImage;

use crate::VideoError;

/// Order of the bytes of a float.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ByteOrder {
    /// Least significant byte first.
    #[default]
    Little,
    /// Most significant byte first.
    Big,
}

/// Reader of portable float maps, all alike, one behind the other.
#[derive(Debug)]
pub struct PfmReader<R> {
    source: R,
    name: String,
    memory: u64,
}

impl<R: BufRead> PfmReader<R> {
    /// Creates a reader. `name` is for messages; a frame may take `memory` bytes.
    pub fn new(source: R, name: &str, memory: u64) -> Self {
        Self { source, name: name.to_owned(), memory }
    }

    /// Returns the next picture, grey or RGB floats; `None` at the end of the stream. Values are multiplied by the header's scale.
    ///
    /// # Errors
    /// When the stream ends within a picture, a header is damaged, a picture is larger than permitted, or unlike the first.
    pub fn next_frame(&mut self) -> Result<Option<EncodedImage>, VideoError> {
        todo!()
    }
}

/// Writer of portable float maps, one behind the other.
#[derive(Debug)]
pub struct PfmWriter<W> {
    sink: W,
    name: String,
    order: ByteOrder,
}

impl<W: Write> PfmWriter<W> {
    /// Creates a writer. `name` is for messages.
    pub fn new(sink: W, name: &str, order: ByteOrder) -> Self {
        Self { sink, name: name.to_owned(), order }
    }

    /// Writes a picture of grey or RGB floats.
    ///
    /// # Errors
    /// When the picture has integers or an alpha, or nothing can be written.
    pub fn write(&mut self, _frame: &EncodedImage) -> Result<(), VideoError> {
        todo!()
    }

    /// Writes what is left in buffers.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn finish(self) -> Result<W, VideoError> {
        todo!()
    }
}
