use half::f16;

use crate::raster::Depth;

/// Samples of an image as in a file: encoded by a transfer function, interleaved, row by row.
#[derive(Clone, Debug, PartialEq)]
pub enum Samples {
    /// 8-bit integers.
    U8(Vec<u8>),
    /// 16-bit integers.
    U16(Vec<u16>),
    /// Half floats.
    Half(Vec<f16>),
    /// Single-precision floats.
    Float(Vec<f32>),
}

impl Samples {
    /// Returns the number of samples.
    pub fn len(&self) -> usize {
        match self {
            Self::U8(samples) => samples.len(),
            Self::U16(samples) => samples.len(),
            Self::Half(samples) => samples.len(),
            Self::Float(samples) => samples.len(),
        }
    }

    /// Returns whether there are no samples.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the bytes of memory that the samples take.
    pub fn bytes(&self) -> u64 {
        let size = match self {
            Self::U8(_) => 1,
            Self::U16(_) | Self::Half(_) => 2,
            Self::Float(_) => 4,
        };
        size * self.len() as u64
    }

    /// Keeps the first samples, and gives the memory of all others back.
    pub(crate) fn keep(&mut self, count: usize) {
        fn keep<S>(samples: &mut Vec<S>, count: usize) {
            samples.truncate(count);
            samples.shrink_to_fit();
        }
        match self {
            Self::U8(samples) => keep(samples, count),
            Self::U16(samples) => keep(samples, count),
            Self::Half(samples) => keep(samples, count),
            Self::Float(samples) => keep(samples, count),
        }
    }

    /// Returns the address of the samples in memory.
    pub(crate) fn address(&self) -> usize {
        match self {
            Self::U8(samples) => samples.as_ptr().addr(),
            Self::U16(samples) => samples.as_ptr().addr(),
            Self::Half(samples) => samples.as_ptr().addr(),
            Self::Float(samples) => samples.as_ptr().addr(),
        }
    }

    /// Returns whether a depth has samples of this type.
    pub(crate) fn suit(&self, depth: Depth) -> bool {
        matches!(
            (self, depth),
            (Self::U8(_), Depth::Eight)
                | (Self::U16(_), Depth::Ten | Depth::Twelve | Depth::Sixteen)
                | (Self::Half(_), Depth::Half)
                | (Self::Float(_), Depth::Float)
        )
    }
}
