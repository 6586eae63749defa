//! Pictures that a file is too short to hold: no compression is without limits, so a header that declares more lies. It is refused
//! before anything is done for each of so many pixels.

use std::io::SeekFrom;
use std::path::Path;

use super::interface::Source;
use crate::{Header, IoError};

/// Most bytes that deflate makes of one: 258 for each two bits.
pub(super) const DEFLATE: u64 = 1032;

/// Returns the header of a file, unless it declares more pixels than the file can hold.
pub(super) fn held(path: &Path, source: Source<'_>, header: Header, pixels_per_byte: u64) -> Result<Header, IoError> {
    let length = source.seek(SeekFrom::End(0)).map_err(|error| IoError::open(path, error))?;
    check(path, length, &header, pixels_per_byte)?;
    Ok(header)
}

/// Refuses a header that declares more pixels than so many bytes can hold.
pub(super) fn check(path: &Path, length: u64, header: &Header, pixels_per_byte: u64) -> Result<(), IoError> {
    let Header { format, width, height, .. } = *header;
    let most = u128::from(length) * u128::from(pixels_per_byte);
    if width as u128 * height as u128 <= most {
        return Ok(());
    }
    let reason = format_args!("its {length} bytes cannot hold {width}x{height} pixels");
    Err(IoError::damaged(path, format, reason))
}
