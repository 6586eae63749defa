use std::io::{Read, SeekFrom};
use std::path::Path;

use crate::codec::interface::{Density, Source};
use crate::{Format, IoError};

/// Supercompression of a level's texels, independent of their format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Packing {
    /// Zstandard.
    Zstandard,
    /// Deflate in zlib's wrapping.
    Zlib,
}

impl Packing {
    /// Returns the most bytes that a packed byte becomes.
    pub(super) fn unpacked(self) -> u64 {
        match self {
            // Blocks of 128 KiB, each of at least a header of three bytes and a byte (RFC 8878, section 3.1.1.2).
            Self::Zstandard => (128 << 10) / 4,
            Self::Zlib => Density::DEFLATE,
        }
    }
}

/// Supercompressed texels in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Packed {
    pub(super) packing: Packing,
    /// Offset of the packed bytes.
    pub(super) offset: u64,
    /// Number of packed bytes.
    pub(super) length: u64,
}

impl Packed {
    /// Unpacks exactly the expected number of bytes; no more memory is allocated, whatever the file declares.
    pub(super) fn read(
        self,
        path: &Path,
        format: Format,
        source: Source<'_>,
        bytes: usize,
    ) -> Result<Vec<u8>, IoError> {
        let length = source.seek(SeekFrom::End(0)).map_err(|error| IoError::open(path, error))?;
        if self.offset.checked_add(self.length).is_none_or(|end| end > length) {
            return Err(IoError::damaged(path, format, "it ends too early"));
        }
        source.seek(SeekFrom::Start(self.offset)).map_err(|error| IoError::open(path, error))?;
        let packed = source.take(self.length);
        match self.packing {
            Packing::Zlib => self.exactly(flate2::read::ZlibDecoder::new(packed), bytes),
            Packing::Zstandard => ruzstd::decoding::StreamingDecoder::new(packed)
                .map_err(|error| self.wrong(&format!("do not unpack: {error}")))
                .and_then(|decoder| self.exactly(decoder, bytes)),
        }
        .map_err(|reason| IoError::damaged(path, format, reason))
    }

    fn exactly(self, mut unpacked: impl Read, bytes: usize) -> Result<Vec<u8>, String> {
        let mut all = vec![0; bytes];
        unpacked
            .read_exact(&mut all)
            .map_err(|error| self.wrong(&format!("do not unpack to {bytes} bytes: {error}")))?;
        match unpacked.read(&mut [0]) {
            Ok(0) => Ok(all),
            _ => Err(self.wrong(&format!("unpack to more than {bytes} bytes"))),
        }
    }

    fn wrong(self, what: &str) -> String {
        format!("its texels, packed by {:?}, {what}", self.packing)
    }
}
