//! YUV4MPEG2: raw YUV with a line of text before the first frame, and one before each.

use std::io::{Read, Write};

use cosmorama::raster::EncodedImage;

use crate::{Ratio, SignalRange, VideoError};

/// Format of a YUV4MPEG2 stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Y4mFormat {
    /// Columns and rows.
    pub size: (usize, usize),
    /// Frames a second.
    pub rate: Ratio,
    /// Width of a pixel by its height; `None` if nothing is said.
    pub pixel_aspect: Option<Ratio>,
    /// Places of the chroma samples.
    pub subsampling: Subsampling,
    /// Bits of a sample: 8, 10, 12 or 16.
    pub bits: u32,
    /// Range of the codes. Streams that say nothing are of narrow range.
    pub range: SignalRange,
    /// Number of the matrix (H.273, table 4): 1, 5, 6, 7, 9 or 4. The format has no word for it: readers take BT.709 for more than
    /// 1024 columns or 576 rows, and BT.601 for others.
    pub matrix: u8,
}

/// Places of the chroma samples of YUV.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Subsampling {
    /// No chroma at all: grey.
    Grey,
    /// A quarter of the chroma samples, each in the middle of four luma samples (`C420jpeg`, `C420`).
    Jpeg420,
    /// A quarter, at the left column between two rows (`C420mpeg2`).
    Mpeg420,
    /// Half, at the left column of each row (`C422`).
    C422,
    /// As many as luma samples (`C444`).
    C444,
    /// As many as luma samples, and alpha (`C444alpha`).
    C444Alpha,
}

/// Reader of YUV4MPEG2. Frames are RGB of 8 bits, or of 16 for more.
#[derive(Debug)]
pub struct Y4mReader<R> {
    source: R,
    name: String,
    format: Y4mFormat,
}

impl<R: Read> Y4mReader<R> {
    /// Reads the stream's first line. `name` is for messages; a frame may take `memory` bytes.
    ///
    /// # Errors
    /// When it is no YUV4MPEG2, is interlaced, or its frames are larger than permitted.
    pub fn new(_source: R, _name: &str, _memory: u64) -> Result<Self, VideoError> {
        todo!()
    }

    /// Returns the format.
    pub fn format(&self) -> &Y4mFormat {
        &self.format
    }

    /// Chooses another matrix than the usual one of the size.
    ///
    /// # Errors
    /// When H.273 has no such matrix of three weights.
    pub fn set_matrix(&mut self, _matrix: u8) -> Result<(), VideoError> {
        todo!()
    }

    /// Returns the next frame; `None` at the end of the stream.
    ///
    /// # Errors
    /// When the stream ends within a frame, or something else is between two.
    pub fn next_frame(&mut self) -> Result<Option<EncodedImage>, VideoError> {
        todo!()
    }
}

/// Writer of YUV4MPEG2.
#[derive(Debug)]
pub struct Y4mWriter<W> {
    sink: W,
    name: String,
    format: Y4mFormat,
}

impl<W: Write> Y4mWriter<W> {
    /// Writes the stream's first line.
    ///
    /// # Errors
    /// When nothing can be written, or the format has no name.
    pub fn new(_sink: W, _name: &str, _format: Y4mFormat) -> Result<Self, VideoError> {
        todo!()
    }

    /// Writes a frame: RGB or grey integers of 8 to 16 bits.
    ///
    /// # Errors
    /// When the frame is of another size, has floats, or an alpha that the format has no room for; or nothing can be written.
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
