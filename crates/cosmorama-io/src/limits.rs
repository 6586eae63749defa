use std::path::Path;

use cosmorama::raster::{Channels, Depth};

use crate::IoError;

/// Limit of the memory for reading a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Largest size of an image's samples in bytes. A file's declared size is checked before memory is allocated.
    pub memory: u64,
}

impl Limits {
    /// No limit.
    pub const NONE: Self = Self { memory: u64::MAX };

    /// Permits this many bytes for an image.
    pub const fn memory(bytes: u64) -> Self {
        Self { memory: bytes }
    }

    /// Checks that an image of this size may be read.
    pub(crate) fn check(
        &self,
        path: &Path,
        (width, height): (u64, u64),
        channels: Channels,
        depth: Depth,
    ) -> Result<(), IoError> {
        let pixels = u128::from(width) * u128::from(height);
        let needed = pixels.saturating_mul((channels.count() * depth.bytes()) as u128);
        self.check_bytes(path, (width, height), channels, depth, needed)
    }

    /// Checks that this many bytes may be allocated for an image.
    pub(crate) fn check_bytes(
        &self,
        path: &Path,
        (width, height): (u64, u64),
        channels: Channels,
        depth: Depth,
        needed: u128,
    ) -> Result<(), IoError> {
        // No more bytes than an address can reach, whatever the limit.
        let limit = self.memory.min(isize::MAX as u64);
        if needed <= u128::from(limit) {
            return Ok(());
        }
        Err(IoError::TooLarge { path: path.to_owned(), width, height, channels, depth, needed, limit: self.memory })
    }
}

/// Returns a limit of four gigabytes; programs that know the machine set their own.
impl Default for Limits {
    fn default() -> Self {
        Self::memory(4 << 30)
    }
}
