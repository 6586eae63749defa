use std::fs::File;
use std::io::{self, BufRead, BufReader, Seek};
use std::path::Path;

use crate::codec::{codec, recognise};
use crate::header::{Header, ImageFile};
use crate::{IoError, Limits};

/// Bytes that are read from a file at once.
const BUFFER: usize = 1 << 16;

/// Reads what a file says of itself, without decoding pixels.
///
/// # Errors
/// When the file cannot be opened, is of no known format, or is damaged before its pixels.
pub fn probe(path: impl AsRef<Path>) -> Result<Header, IoError> {
    let path = path.as_ref();
    probe_from(open(path)?, path)
}

/// Reads what a file in memory, or from any other reader, says of itself. The file begins where the reader does.
///
/// `name` is what messages call the file. Its extension counts only for TGA, which has no mark of its own.
///
/// # Errors
/// When reading fails, the format is unknown, or the file is damaged before its pixels.
pub fn probe_from(mut source: impl BufRead + Seek, name: impl AsRef<Path>) -> Result<Header, IoError> {
    let name = name.as_ref();
    let format = recognise(name, &mut source)?;
    codec(format).probe(name, &mut source)
}

/// Reads a file.
///
/// # Errors
/// When the file cannot be opened, is of no known format, declares more pixels than `limits` allow (before
/// memory is taken), or is damaged.
pub fn read(path: impl AsRef<Path>, limits: &Limits) -> Result<ImageFile, IoError> {
    let path = path.as_ref();
    read_from(open(path)?, path, limits)
}

/// Reads a file in memory, or from any other reader. The file begins where the reader does.
///
/// `name` is what messages call the file. Its extension counts only for TGA, which has no mark of its own.
///
/// # Errors
/// When reading fails, the format is unknown, the file declares more pixels than `limits` allow (before memory is taken), or
/// it is damaged.
pub fn read_from(
    mut source: impl BufRead + Seek,
    name: impl AsRef<Path>,
    limits: &Limits,
) -> Result<ImageFile, IoError> {
    let name = name.as_ref();
    let format = recognise(name, &mut source)?;
    codec(format).decode(name, &mut source, limits)
}

/// Opens a file for reading.
pub(super) fn open(path: &Path) -> Result<BufReader<File>, IoError> {
    let fail = |error| IoError::open(path, error);
    let file = File::open(path).map_err(fail)?;
    if file.metadata().map_err(fail)?.is_dir() {
        return Err(fail(io::Error::from(io::ErrorKind::IsADirectory)));
    }
    Ok(BufReader::with_capacity(BUFFER, file))
}
