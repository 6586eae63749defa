use std::fs::File;
use std::io::{self, BufRead, BufReader, Seek};
use std::path::Path;

use cosmorama::raster::FramePool;

use crate::codec::{codec, contained, recognise};
use crate::header::{Header, ImageFile};
use crate::{Choice, Format, IoError, Limits, Plane};

/// Number of bytes that are read from a file at once.
const BUFFER: usize = 1 << 16;

/// Reads the header of a file, without decoding pixels.
///
/// ```
/// use cosmorama::raster::{Channels, Depth, EncodedImage, Samples};
/// use cosmorama_io::{Format, WriteOptions, probe, write};
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("grey.png");
/// let image = EncodedImage::new(2, 1, Channels::Grey, Depth::Eight, Samples::U8(vec![0, 255]))?;
/// write(&path, &image, &WriteOptions::default())?;
///
/// let header = probe(&path)?;
/// assert_eq!((header.format, header.width, header.height), (Format::Png, 2, 1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When the file cannot be opened, is of no known format, or is damaged before its pixels.
pub fn probe(path: impl AsRef<Path>) -> Result<Header, IoError> {
    let path = path.as_ref();
    probe_from(open(path)?, path)
}

/// Reads the header of a file in memory, or from any other reader, which stands at the file's first byte.
///
/// `name` is the file's name in messages. Its extension counts only for TGA, which has no identifying first bytes.
///
/// # Errors
/// When reading fails, the format is unknown, or the file is damaged before its pixels.
pub fn probe_from(mut source: impl BufRead + Seek, name: impl AsRef<Path>) -> Result<Header, IoError> {
    let name = name.as_ref();
    let format = recognise(name, &mut source)?;
    Ok(decoded(name, format, || codec(name, format)?.probe(name, &mut source))?.upright())
}

/// Reads a file. [`ImageFile::to_light`] decodes it to linear light.
///
/// ```
/// use cosmorama::raster::{Channels, Depth, EncodedImage, Samples};
/// use cosmorama_io::{Limits, WriteOptions, read, write};
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("grey.png");
/// let image = EncodedImage::new(2, 1, Channels::Grey, Depth::Eight, Samples::U8(vec![0, 255]))?;
/// write(&path, &image, &WriteOptions::default())?;
///
/// let file = read(&path, &Limits::default())?;
/// assert_eq!(file.image, image);
/// assert_eq!(file.to_light().get(1, 0).0, [1.0; 4]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When the file cannot be opened, is of no known format, or is damaged. A file that declares more pixels than `limits`
/// allow is refused before memory is allocated.
pub fn read(path: impl AsRef<Path>, limits: &Limits) -> Result<ImageFile, IoError> {
    let path = path.as_ref();
    read_from(open(path)?, path, limits)
}

/// Reads a file in memory, or from any other reader, which stands at the file's first byte.
///
/// ```
/// use std::io::Cursor;
/// use cosmorama_io::{Limits, read_from};
///
/// let bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x80\x80\x81";
/// let file = read_from(Cursor::new(bytes), "a picture in memory", &Limits::default())?;
/// assert_eq!(file.to_light().get(0, 0).0, [1.0; 4]);
/// # Ok::<(), cosmorama_io::IoError>(())
/// ```
///
/// `name` is the file's name in messages. Its extension counts only for TGA, which has no identifying first bytes.
///
/// # Errors
/// When reading fails, the format is unknown, or the file is damaged. A file that declares more pixels than `limits`
/// allow is refused before memory is allocated.
pub fn read_from(source: impl BufRead + Seek, name: impl AsRef<Path>, limits: &Limits) -> Result<ImageFile, IoError> {
    read_in(source, name, limits, &FramePool::default())
}

/// Reads a file as [`read_from`] does, into memory of a pool: memory of an image of the same size, if one was given back.
///
/// # Errors
/// As [`read_from`].
pub fn read_in(
    mut source: impl BufRead + Seek,
    name: impl AsRef<Path>,
    limits: &Limits,
    pool: &FramePool,
) -> Result<ImageFile, IoError> {
    let name = name.as_ref();
    let format = recognise(name, &mut source)?;
    Ok(decoded(name, format, || codec(name, format)?.decode(name, &mut source, limits, pool))?.upright(pool))
}

/// Reads the header of a file like [`probe_from`], for the picture that a choice selects.
///
/// # Errors
/// When [`probe_from`] fails, or the file has no such part or channels.
pub fn probe_chosen(
    mut source: impl BufRead + Seek,
    name: impl AsRef<Path>,
    choice: &Choice,
) -> Result<Header, IoError> {
    let name = name.as_ref();
    let format = recognise(name, &mut source)?;
    Ok(decoded(name, format, || codec(name, format)?.probe_chosen(name, &mut source, choice))?.upright())
}

/// Reads the picture of a file that a choice selects, like [`read_in`].
///
/// # Errors
/// When [`read_in`] fails, or the file has no such part or channels.
pub fn read_chosen(
    mut source: impl BufRead + Seek,
    name: impl AsRef<Path>,
    memory: (&Limits, &FramePool),
    choice: &Choice,
) -> Result<ImageFile, IoError> {
    let name = name.as_ref();
    let format = recognise(name, &mut source)?;
    Ok(decoded(name, format, || codec(name, format)?.decode_chosen(name, &mut source, memory, choice))?
        .upright(memory.1))
}

/// Reads a file to its end like [`read_chosen`], and drops its pixels. Of PNG, TIFF, OpenEXR, Radiance HDR and TGA a part is held at a
/// time: a row, or a strip, tile or block as the file has them. Of other formats all pixels are.
///
/// # Errors
/// When [`read_chosen`] fails; but of those formats not because the picture is large, if `limits` allow its parts.
pub fn check_chosen(
    mut source: impl BufRead + Seek,
    name: impl AsRef<Path>,
    limits: &Limits,
    choice: &Choice,
) -> Result<(), IoError> {
    let name = name.as_ref();
    let format = recognise(name, &mut source)?;
    decoded(name, format, || codec(name, format)?.check_chosen(name, &mut source, limits, choice))
}

/// Reads channels by their full names, each in its own sample type, from the part whose picture a choice selects. Their
/// size is that of the picture.
///
/// # Errors
/// When the file cannot be read, has no such part or channels, or needs more memory than `limits` allow.
pub fn read_layers(
    mut source: impl BufRead + Seek,
    name: impl AsRef<Path>,
    limits: &Limits,
    (choice, channels): (&Choice, &[&str]),
) -> Result<Vec<Plane>, IoError> {
    let name = name.as_ref();
    let format = recognise(name, &mut source)?;
    decoded(name, format, || codec(name, format)?.decode_planes(name, &mut source, limits, (choice, channels)))
}

/// Calls the decoder of a file. If it panics, the file is damaged in a way that the decoder does not expect.
pub(super) fn decoded<T>(
    path: &Path,
    format: Format,
    decode: impl FnOnce() -> Result<T, IoError>,
) -> Result<T, IoError> {
    contained(decode).unwrap_or_else(|reason| Err(IoError::damaged(path, format, reason)))
}

/// Opens a file for reading.
///
/// # Errors
/// When the file cannot be opened, or is a folder.
pub fn open(path: &Path) -> Result<BufReader<File>, IoError> {
    let fail = |error| IoError::open(path, error);
    let file = File::open(path).map_err(fail)?;
    if file.metadata().map_err(fail)?.is_dir() {
        return Err(fail(io::Error::from(io::ErrorKind::IsADirectory)));
    }
    Ok(BufReader::with_capacity(BUFFER, file))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_decoder_that_panics_names_the_file() {
        let error = decoded(Path::new("odd.png"), Format::Png, || -> Result<(), IoError> { panic!("index 9") });
        let message = error.unwrap_err().to_string();
        assert!(message.contains("odd.png: damaged") && message.contains("its decoder failed: index 9"), "{message}");
    }
}
