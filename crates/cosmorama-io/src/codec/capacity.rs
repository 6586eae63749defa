//! Pictures that a file is too short to hold: no compression is without limits, so a header that declares more lies. It is refused
//! before anything is done for each of so many pixels.

use std::path::Path;

use crate::{Header, IoError};

/// Most bytes that deflate makes of one: 258 for each two bits.
pub(crate) const DEFLATE: u64 = 1032;

impl Header {
    /// Refuses a header that declares more pixels than so many bytes can hold.
    pub(crate) fn check_capacity(&self, path: &Path, bytes: u64, pixels_per_byte: u64) -> Result<(), IoError> {
        let Self { format, width, height, .. } = *self;
        let most = u128::from(bytes) * u128::from(pixels_per_byte);
        if width as u128 * height as u128 <= most {
            return Ok(());
        }
        let reason = format_args!("its {bytes} bytes cannot hold {width}x{height} pixels");
        Err(IoError::damaged(path, format, reason))
    }
}
