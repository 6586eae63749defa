use std::io::{Seek, Write};
use std::path::Path;

use cosmorama::raster::{Channels, Depth, EncodedImage};
use half::f16;

use crate::codec::codec;
use crate::header::Format;
use crate::pending::{Hidden, Pending};
use crate::{IoError, LayeredImage, MadeLayers, MadeRows, Plane, PlaneSamples, WriteOptions};

/// Writes a file in the format of its extension. It appears whole or not at all: an older file of the same name is
/// replaced only when the new one is complete.
///
/// ```
/// use cosmorama::raster::{Channels, Depth, EncodedImage, Samples, Transfer};
/// use cosmorama_io::{Metadata, WriteOptions, probe, write};
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("red.png");
/// let image = EncodedImage::new(1, 1, Channels::Rgb, Depth::Eight, Samples::U8(vec![255, 0, 0]))?;
/// let metadata = Metadata { transfer: Some(Transfer::Srgb), ..Metadata::default() };
/// write(&path, &image, &WriteOptions::with_metadata(metadata))?;
/// assert_eq!(probe(&path)?.metadata.transfer, Some(Transfer::Srgb));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When the extension is unknown, the format cannot hold the image, or the file cannot be written.
pub fn write(path: impl AsRef<Path>, image: &EncodedImage, options: &WriteOptions) -> Result<(), IoError> {
    write_levels(path, std::slice::from_ref(image), options)
}

/// Writes a picture with its mip levels, the largest first, like [`write()`]. Each level has half the size of the one
/// before, rounded down.
///
/// # Errors
/// When [`write()`] would fail, the format does not hold several levels, or the levels' sizes or sample types do not
/// match.
pub fn write_levels(path: impl AsRef<Path>, levels: &[EncodedImage], options: &WriteOptions) -> Result<(), IoError> {
    write_hidden(path, levels, options)?.appear()
}

/// Writes a picture that is no world, such as a table: like [`write()`], but a KTX 2 file is a flat texture, not a cube, in which
/// floats stay floats.
///
/// # Errors
/// When [`write()`] would fail. A KTX 2 file holds RGBA of 8 bits, halves or floats.
pub fn write_flat(path: impl AsRef<Path>, image: &EncodedImage, options: &WriteOptions) -> Result<(), IoError> {
    let path = path.as_ref();
    if Format::from_extension(path)? != Format::Ktx2 {
        return write(path, image, options);
    }
    let mut pending = Pending::create(path, &options.unfinished)?;
    codec(path, Format::Ktx2)?.encode_flat(path, pending.writer(), image, options)?;
    pending.finish()
}

/// Writes a picture with its mip levels like [`write_levels()`]; it gets its name later, for example together with others.
///
/// # Errors
/// When [`write_levels()`] would fail.
pub fn write_hidden(
    path: impl AsRef<Path>,
    levels: &[EncodedImage],
    options: &WriteOptions,
) -> Result<Hidden, IoError> {
    let path = path.as_ref();
    let format = Format::from_extension(path)?;
    let Some((image, smaller)) = levels.split_first() else { return Err(IoError::write(path, "there is no picture")) };
    check_can_hold(path, format, (image.channels(), image.depth()))?;
    if !smaller.is_empty() && !format.holds_levels() {
        return Err(IoError::CannotHold {
            path: path.to_owned(),
            format,
            found: format!("{} smaller copies of a picture", smaller.len()),
            expected: "one picture; KTX 2, KTX, DDS and OpenEXR hold several levels".to_owned(),
        });
    }
    let mut pending = Pending::create(path, &options.unfinished)?;
    codec(path, format)?.encode_levels(path, pending.writer(), levels, options)?;
    pending.close()
}

/// Writes a picture whose rows are made meanwhile, like [`write()`]; it gets its name later. Its bytes are those of the whole picture.
/// Where the format is not written row by row, all rows are held ([`Format::takes_rows`]).
///
/// # Errors
/// When [`write()`] would fail, or rows are not made.
pub fn write_rows_hidden(
    path: impl AsRef<Path>,
    rows: MadeRows<'_>,
    options: &WriteOptions,
) -> Result<Hidden, IoError> {
    let path = path.as_ref();
    let format = Format::from_extension(path)?;
    check_can_hold(path, format, (rows.channels, rows.depth))?;
    let mut pending = Pending::create(path, &options.unfinished)?;
    codec(path, format)?.encode_rows(path, pending.writer(), rows, options)?;
    pending.close()
}

/// Encodes a picture to memory, or to any other writer. `name` is the file's name in messages.
///
/// # Errors
/// When the format cannot hold the image, or writing fails.
pub fn write_to(
    mut output: impl Write + Seek,
    name: impl AsRef<Path>,
    format: Format,
    image: &EncodedImage,
    options: &WriteOptions,
) -> Result<(), IoError> {
    let name = name.as_ref();
    check_can_hold(name, format, (image.channels(), image.depth()))?;
    codec(name, format)?.encode(name, &mut output, image, options)
}

/// Writes named planes of numbers, as halves or floats, for data that is not a picture. The file appears whole or not
/// at all.
///
/// # Errors
/// When the extension is not OpenEXR's, the only format with named channels; when a plane does not hold width × height
/// numbers; or when the file cannot be written.
pub fn write_planes(
    path: impl AsRef<Path>,
    size: (usize, usize),
    planes: Vec<(&str, Vec<f32>)>,
    depth: Depth,
    options: &WriteOptions,
) -> Result<(), IoError> {
    let path = path.as_ref();
    let format = Format::from_extension(path)?;
    if format != Format::Exr || !depth.is_float() {
        let found = format!("{} named channels of depth {depth}", planes.len());
        let expected = "OpenEXR; depth half, float".to_owned();
        return Err(IoError::CannotHold { path: path.to_owned(), format, found, expected });
    }
    let samples = |numbers: Vec<f32>| match depth {
        Depth::Half => PlaneSamples::Half(numbers.into_iter().map(f16::from_f32).collect()),
        _ => PlaneSamples::Float(numbers),
    };
    let plane = |(name, numbers): (&str, Vec<f32>)| Plane { name: name.to_owned(), samples: samples(numbers) };
    let planes = planes.into_iter().map(plane).collect();
    write_layers(path, LayeredImage { size, picture: None, names: Vec::new(), planes }, options)
}

/// Writes a picture with named channels beside it, or such channels alone, like [`write()`].
///
/// ```
/// use cosmorama::raster::{Channels, Depth, EncodedImage, Samples};
/// use cosmorama_io::{
///     Choice, LayeredImage, Limits, Plane, PlaneSamples, WriteOptions, open, probe, read_layers, write_layers,
/// };
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("layers.exr");
/// let image = EncodedImage::new(2, 1, Channels::Rgb, Depth::Float, Samples::Float(vec![0.5; 6]))?;
/// let id = Plane { name: "id".to_owned(), samples: PlaneSamples::Uint(vec![7, 9]) };
/// let layered = LayeredImage { size: (2, 1), picture: Some(&image), names: Vec::new(), planes: vec![id.clone()] };
/// write_layers(&path, layered, &WriteOptions::default())?;
///
/// assert_eq!(probe(&path)?.metadata.layers.further[0].name, "id");
/// let read = read_layers(open(&path)?, &path, &Limits::default(), (&Choice::default(), &["id"]))?;
/// assert_eq!(read, [id]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When the extension is not OpenEXR's, the only format with named channels; when the format cannot hold the picture; when a
/// channel has another number of samples than the picture; or when the file cannot be written.
pub fn write_layers(path: impl AsRef<Path>, layered: LayeredImage<'_>, options: &WriteOptions) -> Result<(), IoError> {
    write_layers_hidden(path, layered, options)?.appear()
}

/// Writes a picture with named channels like [`write_layers()`]; it gets its name later.
///
/// # Errors
/// When [`write_layers()`] would fail.
pub fn write_layers_hidden(
    path: impl AsRef<Path>,
    layered: LayeredImage<'_>,
    options: &WriteOptions,
) -> Result<Hidden, IoError> {
    let path = path.as_ref();
    let format = Format::from_extension(path)?;
    check_names_channels(path, format, layered.planes.len())?;
    if let Some(image) = layered.picture {
        check_can_hold(path, format, (image.channels(), image.depth()))?;
    }
    let (width, height) = layered.size;
    let count = width.checked_mul(height);
    if let Some(plane) = layered.planes.iter().find(|plane| count != Some(plane.samples.len())) {
        let (found, expected) =
            (format!("{} samples in {}", plane.samples.len(), plane.name), format!("{width}x{height}"));
        return Err(IoError::CannotHold { path: path.to_owned(), format, found, expected });
    }
    let mut pending = Pending::create(path, &options.unfinished)?;
    codec(path, format)?.encode_layers(path, pending.writer(), layered, options)?;
    pending.close()
}

/// Writes a picture with named channels, or such channels alone, whose rows are made meanwhile; it gets its name later. Its bytes are those
/// that [`write_layers()`] writes.
///
/// # Errors
/// When [`write_layers()`] would fail, or rows are not made.
pub fn write_layer_rows_hidden(
    path: impl AsRef<Path>,
    layers: MadeLayers<'_>,
    options: &WriteOptions,
) -> Result<Hidden, IoError> {
    let path = path.as_ref();
    let format = Format::from_extension(path)?;
    check_names_channels(path, format, layers.planes.len())?;
    if let Some(form) = layers.picture {
        check_can_hold(path, format, form)?;
    }
    let mut pending = Pending::create(path, &options.unfinished)?;
    codec(path, format)?.encode_layer_rows(path, pending.writer(), layers, options)?;
    pending.close()
}

/// Refuses named channels in a format without them.
fn check_names_channels(path: &Path, format: Format, channels: usize) -> Result<(), IoError> {
    if format == Format::Exr {
        return Ok(());
    }
    let (found, expected) = (format!("{channels} named channels"), "a picture; OpenEXR holds more".to_owned());
    Err(IoError::CannotHold { path: path.to_owned(), format, found, expected })
}

fn check_can_hold(path: &Path, format: Format, (channels, depth): (Channels, Depth)) -> Result<(), IoError> {
    if format.supports(depth, channels) {
        return Ok(());
    }
    let names = |names: Vec<String>| names.join(", ");
    Err(IoError::CannotHold {
        path: path.to_owned(),
        format,
        found: format!("{channels} of depth {depth}"),
        expected: format!(
            "{}; depth {}",
            names(format.channels().iter().map(ToString::to_string).collect()),
            names(format.depths().iter().map(ToString::to_string).collect()),
        ),
    })
}
