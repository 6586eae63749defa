mod st_pairs;

pub use st_pairs::{StPairs, probe_pairs, read_pairs};

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use cosmorama::raster::{Channels, Depth, EncodedImage};

use crate::codec::radiance::hdr;
use crate::codec::texture::{dds, ktx, ktx2};
use crate::codec::{exr, jpeg, png, tga, tiff};
use crate::pending::{Hidden, Pending};
use crate::{Format, IoError, Limits, Metadata, Window, WriteOptions};

/// What a file says of itself before its pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    /// Its format, found from its content.
    pub format: Format,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Channels that [`read`] gives.
    pub channels: Channels,
    /// Depth that [`read`] gives.
    pub depth: Depth,
    /// What it says about its pixels.
    pub metadata: Metadata,
    /// Where they lie in a larger canvas; `None` where they are all of it.
    pub window: Option<Window>,
}

/// A file in memory.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageFile {
    /// Its format, found from its content.
    pub format: Format,
    /// Its pixels.
    pub image: EncodedImage,
    /// What it says about them.
    pub metadata: Metadata,
    /// Where they lie in a larger canvas; `None` where they are all of it.
    pub window: Option<Window>,
}

/// What decoders read from.
pub(crate) type Source = BufReader<File>;

/// Reads what a file says of itself, without decoding pixels.
///
/// # Errors
/// When the file cannot be opened, is of no known format, or is damaged before its pixels.
pub fn probe(path: &Path) -> Result<Header, IoError> {
    let (format, mut source) = open(path)?;
    match format {
        Format::Png => png::probe(path, &mut source),
        Format::Jpeg => jpeg::probe(path, &mut source),
        Format::Tiff => tiff::probe(path, &mut source),
        Format::Tga => tga::probe(path, &mut source),
        Format::Hdr => hdr::probe(path, &mut source),
        Format::Exr => exr::probe(path, &mut source),
        Format::Ktx2 => ktx2::probe(path, &mut source),
        Format::Ktx => ktx::probe(path, &mut source),
        Format::Dds => dds::probe(path, &mut source),
    }
}

/// Reads a file.
///
/// # Errors
/// When the file cannot be opened, is of no known format, declares more pixels than `limits` allow (before
/// memory is taken), or is damaged.
pub fn read(path: &Path, limits: &Limits) -> Result<ImageFile, IoError> {
    let (format, mut source) = open(path)?;
    match format {
        Format::Png => png::read(path, &mut source, limits),
        Format::Jpeg => jpeg::read(path, &mut source, limits),
        Format::Tiff => tiff::read(path, &mut source, limits),
        Format::Tga => tga::read(path, &mut source, limits),
        Format::Hdr => hdr::read(path, &mut source, limits),
        Format::Exr => exr::read(path, &mut source, limits),
        Format::Ktx2 => ktx2::read(path, &mut source, limits),
        Format::Ktx => ktx::read(path, &mut source, limits),
        Format::Dds => dds::read(path, &mut source, limits),
    }
}

/// Writes a file in the format that its extension names. It appears whole or not at all; an older file of the
/// same name is replaced only when the new one is whole.
///
/// # Errors
/// When the extension is unknown, the format cannot hold the image, or the file cannot be written.
pub fn write(path: &Path, image: &EncodedImage, metadata: &Metadata, options: &WriteOptions) -> Result<(), IoError> {
    write_levels(path, std::slice::from_ref(image), metadata, options)
}

/// [`write()`] of a picture with its smaller copies, the largest first: each half as large, rounded down, as the one before.
/// Formats that hold no such copies are an error where there are any.
///
/// # Errors
/// Those of [`write()`], and when the sizes or sample types of the levels do not go together.
pub fn write_levels(
    path: &Path,
    levels: &[EncodedImage],
    metadata: &Metadata,
    options: &WriteOptions,
) -> Result<(), IoError> {
    hidden(path, levels, metadata, options)?.appear()
}

/// [`write()`] of a picture that appears when it is told to, as together with others.
///
/// # Errors
/// Those of [`write()`].
pub fn write_hidden(
    path: &Path,
    image: &EncodedImage,
    metadata: &Metadata,
    options: &WriteOptions,
) -> Result<Hidden, IoError> {
    hidden(path, std::slice::from_ref(image), metadata, options)
}

fn hidden(
    path: &Path,
    levels: &[EncodedImage],
    metadata: &Metadata,
    options: &WriteOptions,
) -> Result<Hidden, IoError> {
    let format = Format::from_extension(path)?;
    let Some((image, smaller)) = levels.split_first() else { return Err(IoError::write(path, "there is no picture")) };
    check_can_hold(path, format, image)?;
    if !smaller.is_empty() && !format.holds_levels() {
        return Err(IoError::CannotHold {
            path: path.to_owned(),
            format,
            found: format!("{} smaller copies of a picture", smaller.len()),
            expected: "one picture; KTX2 and DDS hold several levels".to_owned(),
        });
    }
    let mut pending = Pending::create(path)?;
    let writer = pending.writer();
    match format {
        Format::Png => png::write(path, writer, image, metadata, options.compression),
        Format::Jpeg => jpeg::write(path, writer, image, metadata, options.quality),
        Format::Tiff => tiff::write(path, writer, image, metadata, options.compression),
        Format::Tga => tga::write(path, writer, image),
        Format::Hdr => hdr::write(path, writer, image),
        Format::Exr => exr::write(path, writer, image, metadata, options.compression),
        Format::Ktx2 => ktx2::write(path, writer, levels, metadata),
        Format::Ktx => Err(IoError::write(path, "KTX files of the first version are only read; write .ktx2")),
        Format::Dds => dds::write(path, writer, levels, metadata),
    }?;
    pending.close()
}

/// Writes planes of numbers that are no picture, each under its name, as halves or floats. The file appears whole or not
/// at all.
///
/// # Errors
/// When the file is not named as OpenEXR, the only format with named channels; when a plane does not hold
/// width × height numbers; when the file cannot be written.
pub fn write_planes(
    path: &Path,
    size: (usize, usize),
    planes: Vec<(&str, Vec<f32>)>,
    depth: Depth,
    metadata: &Metadata,
) -> Result<(), IoError> {
    let format = Format::from_extension(path)?;
    let cannot_hold =
        |found: String, expected: String| Err(IoError::CannotHold { path: path.to_owned(), format, found, expected });
    if format != Format::Exr || !depth.is_float() {
        let found = format!("{} named channels of depth {depth}", planes.len());
        return cannot_hold(found, "OpenEXR; depth half, float".to_owned());
    }
    if let Some((name, plane)) = planes.iter().find(|(_, plane)| size.0.checked_mul(size.1) != Some(plane.len())) {
        return cannot_hold(format!("{} numbers in {name}", plane.len()), format!("{}x{}", size.0, size.1));
    }
    let mut pending = Pending::create(path)?;
    exr::write_planes(path, pending.writer(), size, planes, depth, metadata)?;
    pending.finish()
}

fn check_can_hold(path: &Path, format: Format, image: &EncodedImage) -> Result<(), IoError> {
    if format.supports(image.depth(), image.channels()) {
        return Ok(());
    }
    let names = |names: Vec<String>| names.join(", ");
    Err(IoError::CannotHold {
        path: path.to_owned(),
        format,
        found: format!("{} of depth {}", image.channels(), image.depth()),
        expected: format!(
            "{}; depth {}",
            names(format.channels().iter().map(ToString::to_string).collect()),
            names(format.depths().iter().map(ToString::to_string).collect()),
        ),
    })
}

pub(crate) fn open(path: &Path) -> Result<(Format, Source), IoError> {
    let fail = |error| IoError::open(path, error);
    let file = File::open(path).map_err(fail)?;
    if file.metadata().map_err(fail)?.is_dir() {
        return Err(fail(io::Error::from(io::ErrorKind::IsADirectory)));
    }
    let mut source = BufReader::with_capacity(1 << 16, file);
    let mut start = Vec::with_capacity(16);
    source.by_ref().take(16).read_to_end(&mut start).map_err(fail)?;
    source.seek(SeekFrom::Start(0)).map_err(fail)?;
    Ok((Format::from_content(path, &start)?, source))
}
