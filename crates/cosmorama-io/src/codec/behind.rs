//! Bytes behind a picture in its file: padding, or further pictures that would be lost.

use std::io::{self, Read};

use super::interface::Source;

/// Skips zeros, which are padding, and returns where something else begins.
pub(crate) fn skip_padding(source: Source<'_>) -> io::Result<u64> {
    loop {
        let bytes = source.fill_buf()?;
        let zeros = bytes.iter().take_while(|byte| **byte == 0).count();
        let is_end = zeros < bytes.len() || bytes.is_empty();
        source.consume(zeros);
        if is_end {
            return source.stream_position();
        }
    }
}

/// Reads the next bytes, at most so many.
pub(crate) fn next_bytes(source: Source<'_>, count: usize) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::with_capacity(count);
    source.take(count as u64).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Counts how often a mark of several bytes occurs in the rest of a file.
pub(crate) fn count_marks(source: Source<'_>, mark: &[u8]) -> io::Result<usize> {
    let (mut count, mut window) = (0, Vec::new());
    loop {
        let more = next_bytes(source, 1 << 16)?;
        if more.is_empty() {
            return Ok(count);
        }
        window.extend(more);
        count += window.windows(mark.len()).filter(|bytes| *bytes == mark).count();
        // A mark may lie across two pieces.
        window.drain(..window.len() - window.len().min(mark.len() - 1));
    }
}
