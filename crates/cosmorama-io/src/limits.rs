use std::path::Path;

use cosmorama::raster::{Channels, Depth};

use crate::IoError;

/// Memory that reading a file may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Bytes that the samples of one image may take. What a file declares is checked before memory is taken.
    pub memory: u64,
}

impl Limits {
    /// No limit.
    pub const NONE: Self = Self { memory: u64::MAX };

    /// Allows so many bytes for an image.
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

    /// Checks that so many bytes may be taken for an image of this size.
    pub(crate) fn check_bytes(
        &self,
        path: &Path,
        (width, height): (u64, u64),
        channels: Channels,
        depth: Depth,
        needed: u128,
    ) -> Result<(), IoError> {
        // What no address can reach is too much whatever the limit says.
        let limit = self.memory.min(isize::MAX as u64);
        if needed <= u128::from(limit) {
            return Ok(());
        }
        Err(IoError::TooLarge { path: path.to_owned(), width, height, channels, depth, needed, limit: self.memory })
    }
}

/// Four gigabytes: callers that know the machine set their own.
impl Default for Limits {
    fn default() -> Self {
        Self::memory(4 << 30)
    }
}
