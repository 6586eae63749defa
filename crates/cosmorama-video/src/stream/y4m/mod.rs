//! YUV4MPEG2: raw YUV with a line of text before the first frame, and one before each.

mod header;
mod planes;
mod reader;
mod writer;

pub use reader::Y4mReader;
pub use writer::Y4mWriter;

use crate::{Ratio, SignalRange};

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
    /// Number of the matrix (H.273, table 4): 1, 4, 5, 6, 7 or 9. The format has no word for it: readers take BT.709 for more than
    /// 1024 columns or 576 rows, and BT.601 for others.
    pub matrix: u8,
}

impl Y4mFormat {
    /// Creates the format of frames of 8 bits with all chroma samples, and the matrix that readers take for the size.
    pub fn new(size: (usize, usize), rate: Ratio) -> Self {
        Self {
            size,
            rate,
            pixel_aspect: None,
            subsampling: Subsampling::C444,
            bits: 8,
            range: SignalRange::Narrow,
            matrix: usual_matrix(size),
        }
    }

    /// Returns the columns and rows of each of the chroma planes.
    fn chroma_size(&self) -> (usize, usize) {
        let (width, height) = self.size;
        match self.subsampling {
            Subsampling::Grey => (0, 0),
            Subsampling::Jpeg420 | Subsampling::Mpeg420 => (width.div_ceil(2), height.div_ceil(2)),
            Subsampling::C422 => (width.div_ceil(2), height),
            Subsampling::C444 | Subsampling::C444Alpha => (width, height),
        }
    }

    /// Returns the bytes of a sample.
    fn sample_bytes(&self) -> usize {
        if self.bits > 8 { 2 } else { 1 }
    }
}

/// Returns the number of the matrix that is taken for a size, where nothing is said.
fn usual_matrix((width, height): (usize, usize)) -> u8 {
    if width > 1024 || height > 576 { 1 } else { 6 }
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
