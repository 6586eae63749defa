//! Bytes of a stream, with the name and the number of the frame for messages.

use std::io::{self, BufRead, Read};

use crate::VideoError;

/// Stream that is read.
#[derive(Debug)]
pub(super) struct Input<R> {
    source: R,
    name: String,
    /// Bytes that a frame may take.
    memory: u64,
    /// Number of the next frame.
    pub(super) frame: u64,
}

/// Longest side of a picture.
const LONGEST: usize = 1 << 24;

impl<R> Input<R> {
    pub(super) fn new(source: R, name: &str, memory: u64) -> Self {
        Self { source, name: name.to_owned(), memory, frame: 0 }
    }

    pub(super) fn fault(&self, reason: impl Into<String>) -> VideoError {
        VideoError::Stream { name: self.name.clone(), frame: self.frame, reason: reason.into() }
    }

    /// Checks that a frame of these samples may be held in memory.
    pub(super) fn check(&self, (width, height): (usize, usize), bytes_a_pixel: usize) -> Result<(), VideoError> {
        if !(1..=LONGEST).contains(&width) || !(1..=LONGEST).contains(&height) {
            return Err(
                self.fault(format!("its frames are of {width}x{height} pixels; expected 1 to {LONGEST} a side"))
            );
        }
        let needed = width as u128 * height as u128 * bytes_a_pixel as u128;
        let limit = self.memory.min(isize::MAX as u64);
        if needed > u128::from(limit) {
            let size = (width as u64, height as u64);
            return Err(VideoError::TooLarge { name: self.name.clone(), size, needed, limit });
        }
        Ok(())
    }

    fn ends(&self, error: &io::Error) -> VideoError {
        if error.kind() == io::ErrorKind::UnexpectedEof {
            return self.fault("the stream ends within it; see why the program that writes it has ended");
        }
        self.fault(format!("the stream cannot be read: {error}"))
    }
}

impl<R: Read> Input<R> {
    pub(super) fn fill(&mut self, bytes: &mut [u8]) -> Result<(), VideoError> {
        self.source.read_exact(bytes).map_err(|error| self.ends(&error))
    }
}

impl<R: BufRead> Input<R> {
    /// Returns whether the stream has ended.
    pub(super) fn is_over(&mut self) -> Result<bool, VideoError> {
        loop {
            match self.source.fill_buf() {
                Ok(bytes) => return Ok(bytes.is_empty()),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(self.ends(&error)),
            }
        }
    }

    fn byte(&mut self) -> Result<u8, VideoError> {
        let mut byte = [0];
        self.fill(&mut byte)?;
        Ok(byte[0])
    }

    /// Reads a line of at most `longest` bytes, without its end.
    pub(super) fn line(&mut self, longest: usize) -> Result<String, VideoError> {
        let mut line = Vec::new();
        loop {
            match self.byte()? {
                b'\n' => break,
                _ if line.len() == longest => {
                    return Err(
                        self.fault(format!("a line of its header has more than {longest} bytes; expected fewer"))
                    );
                }
                byte => line.push(byte),
            }
        }
        String::from_utf8(line).map_err(|_| self.fault("its header is no text; expected letters and numbers"))
    }

    /// Reads a word and the one white space behind it. Comments go from `#` to the end of a line.
    pub(super) fn word(&mut self) -> Result<String, VideoError> {
        const LONGEST_WORD: usize = 32;
        const MOST_SPACE: usize = 4096;
        let (mut word, mut is_comment) = (String::new(), false);
        for _ in 0..MOST_SPACE {
            match self.byte()? {
                byte if is_comment => is_comment = byte != b'\n',
                b'#' if word.is_empty() => is_comment = true,
                b' ' | b'\t' | b'\r' | b'\n' if word.is_empty() => {}
                b' ' | b'\t' | b'\r' | b'\n' => return Ok(word),
                byte if byte.is_ascii_graphic() && word.len() < LONGEST_WORD => word.push(char::from(byte)),
                _ => break,
            }
        }
        Err(self.fault("its header is damaged; expected words and numbers between white space"))
    }

    /// Reads a word that is a number.
    pub(super) fn number(&mut self, name: &str) -> Result<usize, VideoError> {
        let word = self.word()?;
        word.parse().map_err(|_| self.fault(format!("its {name} is {word}; expected a number")))
    }
}
