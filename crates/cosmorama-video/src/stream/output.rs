//! Stream that is written, with its name and the number of the frame for messages.

use std::io::Write;

use crate::VideoError;

/// Stream that is written.
#[derive(Debug)]
pub(super) struct Output<W> {
    sink: W,
    name: String,
    frame: u64,
}

impl<W: Write> Output<W> {
    pub(super) fn new(sink: W, name: &str) -> Self {
        Self { sink, name: name.to_owned(), frame: 0 }
    }

    pub(super) fn write(&mut self, bytes: &[u8]) -> Result<(), VideoError> {
        self.sink.write_all(bytes).map_err(|source| VideoError::WriteStream { name: self.name.clone(), source })
    }

    /// Hands on a frame that is written, so that whoever reads the stream has all of it, and counts it.
    pub(super) fn end_frame(&mut self) -> Result<(), VideoError> {
        self.frame += 1;
        self.flush()
    }

    pub(super) fn wrong(&self, found: String, expected: impl Into<String>) -> VideoError {
        VideoError::WrongFrame { name: self.name.clone(), frame: self.frame, found, expected: expected.into() }
    }

    pub(super) fn finish(mut self) -> Result<W, VideoError> {
        self.flush()?;
        Ok(self.sink)
    }

    fn flush(&mut self) -> Result<(), VideoError> {
        self.sink.flush().map_err(|source| VideoError::WriteStream { name: self.name.clone(), source })
    }
}
