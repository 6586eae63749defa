//! Netpbm's pictures, one behind the other: PGM (P5), PPM (P6) and PAM (P7) of 8 or 16 bits.

use std::io::{BufRead, Write};

use cosmorama::raster::EncodedImage;

use crate::VideoError;

/// Reader of pictures in PGM, PPM or PAM, all alike, one behind the other.
#[derive(Debug)]
pub struct PamReader<R> {
    source: R,
    name: String,
    memory: u64,
}

impl<R: BufRead> PamReader<R> {
    /// Creates a reader. `name` is for messages; a frame may take `memory` bytes.
    pub fn new(source: R, name: &str, memory: u64) -> Self {
        Self { source, name: name.to_owned(), memory }
    }

    /// Returns the next picture; `None` at the end of the stream. Values below the greatest of 8 or 16 bits are scaled to it.
    ///
    /// # Errors
    /// When the stream ends within a picture, a header is damaged, a picture is larger than permitted, or unlike the first.
    pub fn next_frame(&mut self) -> Result<Option<EncodedImage>, VideoError> {
        todo!()
    }
}

/// Writer of pictures in PAM (P7), one behind the other.
#[derive(Debug)]
pub struct PamWriter<W> {
    sink: W,
    name: String,
}

impl<W: Write> PamWriter<W> {
    /// Creates a writer. `name` is for messages.
    pub fn new(sink: W, name: &str) -> Self {
        Self { sink, name: name.to_owned() }
    }

    /// Writes a picture of 8 bits, or of 10 to 16, which become 16.
    ///
    /// # Errors
    /// When the picture has floats, or nothing can be written.
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
