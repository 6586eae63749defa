use std::cell::RefCell;
use std::io::{self, Write};
use std::ops::Range;
use std::path::Path;

use bytemuck::cast_slice;
use cosmorama::raster::{Channels, Depth, EncodedImage, Samples};
use png::chunk::sBIT;
use png::{BitDepth, ColorType, DeflateCompression, Encoder, EncodingError, Filter, Info, Writer};

use super::carried;
use super::colour::{CICP, Tag, tag};
use crate::header::Picture;
use crate::metadata::XMP;
use crate::{Compression, IoError, Metadata, WriteOptions};

pub(crate) fn write(
    path: &Path,
    output: impl Write,
    picture: Picture<'_, '_>,
    options: &WriteOptions,
) -> Result<(), IoError> {
    encode(output, picture, options).map_err(|error| IoError::write(path, error))
}

/// Bytes of a chunk of compressed samples.
const CHUNK: usize = 1 << 18;

/// Rows of a sample that tells whether compression pays, out of as many as `SAMPLED_OF`.
const SAMPLED: usize = 8;

/// Rows out of which `SAMPLED` are compressed for a trial.
const SAMPLED_OF: usize = 256;

fn encode(output: impl Write, picture: Picture<'_, '_>, options: &WriteOptions) -> Result<(), EncodingError> {
    let failed = RefCell::new(None);
    let encoded = encode_to(Faithful { output, failed: &failed }, picture, options);
    failed.take().map_or(encoded, |error| Err(EncodingError::IoError(error)))
}

/// A writer that keeps its first error, and takes no bytes thereafter: the encoder panics where its last bytes cannot be written.
struct Faithful<'a, W> {
    output: W,
    failed: &'a RefCell<Option<io::Error>>,
}

impl<W: Write> Write for Faithful<'_, W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut failed = self.failed.borrow_mut();
        if failed.is_none() {
            *failed = self.output.write_all(bytes).err();
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.output.flush()
    }
}

fn encode_to<W: Write>(
    output: Faithful<'_, W>,
    mut picture: Picture<'_, '_>,
    options: &WriteOptions,
) -> Result<(), EncodingError> {
    let failed = output.failed;
    let metadata = &options.metadata;
    // A profile describes the colours completely.
    let tag = match &metadata.icc {
        Some(_) => None,
        None => metadata.transfer.as_ref().and_then(|transfer| tag(transfer, metadata.primaries.as_ref())),
    };
    let size = picture.size();
    let form = (picture.channels(), picture.depth());
    let mut encoder = Encoder::with_info(output, info((size, form), metadata, tag.as_ref())?)?;
    if let Some(packet) = metadata.packet_to_write(size) {
        encoder.add_itxt_chunk(XMP.to_owned(), packet)?;
    }
    // zlib's level 6 takes ten to twenty times as long as fdeflate, for a tenth fewer bytes of a smooth picture. Rows
    // filtered by Up are read in a third of the time that others take.
    let (deflate, filter) = match options.compression {
        Compression::None => (DeflateCompression::NoCompression, Filter::NoFilter),
        Compression::Fast if pays(&mut picture, Filter::Up)? => (DeflateCompression::FdeflateUltraFast, Filter::Up),
        Compression::Balanced if pays(&mut picture, Filter::Adaptive)? => {
            (DeflateCompression::FdeflateUltraFast, Filter::Adaptive)
        }
        Compression::Fast | Compression::Balanced => (DeflateCompression::NoCompression, Filter::NoFilter),
        Compression::High => (DeflateCompression::Level(6), Filter::Adaptive),
    };
    encoder.set_deflate_compression(deflate);
    encoder.set_filter(filter);
    let mut writer = encoder.write_header()?;
    write_chunks(&mut writer, form, tag)?;
    carried::write(&mut writer, metadata, size)?;
    // Row by row, so that no compressed copy of the picture is held beside it.
    let mut samples = writer.stream_writer_with_size(CHUNK)?;
    each_row(&mut picture, 0..size.1, |row| {
        samples.write_all(row)?;
        if failed.borrow().is_none() { Ok(()) } else { Err(limit("the file takes no more")) }
    })?;
    samples.finish()?;
    writer.finish()
}

/// Returns the metadata that the encoder can write itself.
fn info<'a>(
    ((width, height), (channels, depth)): ((usize, usize), (Channels, Depth)),
    metadata: &'a Metadata,
    tag: Option<&Tag>,
) -> Result<Info<'a>, EncodingError> {
    let mut info = Info::with_size(dimension(width)?, dimension(height)?);
    info.color_type = match channels {
        Channels::Grey => ColorType::Grayscale,
        Channels::GreyAlpha => ColorType::GrayscaleAlpha,
        Channels::Rgb => ColorType::Rgb,
        Channels::Rgba => ColorType::Rgba,
    };
    info.bit_depth = if depth == Depth::Eight { BitDepth::Eight } else { BitDepth::Sixteen };
    info.icc_profile = metadata.icc.as_deref().map(Into::into);
    match tag {
        Some(Tag::Srgb(intent)) => info.srgb = Some(*intent),
        Some(Tag::Gamma(gamma, primaries)) => {
            (info.source_gamma, info.source_chromaticities) = (Some(*gamma), *primaries);
        }
        Some(Tag::Profile(profile)) => info.icc_profile = Some(profile.clone().into()),
        Some(Tag::CodePoints(_)) | None => {}
    }
    Ok(info)
}

/// Writes the chunks that the encoder cannot write itself.
fn write_chunks(
    writer: &mut Writer<impl Write>,
    (channels, depth): (Channels, Depth),
    tag: Option<Tag>,
) -> Result<(), EncodingError> {
    if let Some(Tag::CodePoints(cicp)) = tag {
        let full_range = u8::from(cicp.is_video_full_range_image);
        let data = [cicp.color_primaries, cicp.transfer_function, cicp.matrix_coefficients, full_range];
        writer.write_chunk(CICP, &data)?;
    }
    if let Some(bits @ (10 | 12)) = depth.significant_bits() {
        writer.write_chunk(sBIT, &vec![bits as u8; channels.count()])?;
    }
    Ok(())
}

/// Returns whether some evenly spaced rows become smaller by fast compression. Noise does not.
fn pays(picture: &mut Picture<'_, '_>, filter: Filter) -> Result<bool, EncodingError> {
    let (size, form) = (picture.size(), (picture.channels(), picture.depth()));
    let rows = sampled(size.1).map(|rows| rows.len()).sum();
    let (metadata, mut compressed) = (Metadata::default(), Counter(0));
    let info = info(((size.0, rows), form), &metadata, None)?;
    let bytes = (info.raw_row_length() - 1) as u64 * rows as u64;
    let mut encoder = Encoder::with_info(&mut compressed, info)?;
    encoder.set_deflate_compression(DeflateCompression::FdeflateUltraFast);
    encoder.set_filter(filter);
    let mut writer = encoder.write_header()?;
    let mut samples = writer.stream_writer_with_size(CHUNK)?;
    for rows in sampled(size.1) {
        each_row(picture, rows, |row| Ok(samples.write_all(row)?))?;
    }
    samples.finish()?;
    writer.finish()?;
    Ok(compressed.0 < bytes)
}

/// Counts bytes, and drops them.
struct Counter(u64);

impl Write for Counter {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0 += bytes.len() as u64;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// Visits the rows of a sample.
fn sampled(height: usize) -> impl Iterator<Item = Range<usize>> {
    (0..height).step_by(SAMPLED_OF).map(move |first| {
        let middle = first + (SAMPLED_OF.min(height - first)).saturating_sub(SAMPLED) / 2;
        middle..(middle + SAMPLED).min(height)
    })
}

/// Hands rows to a function as PNG has their samples.
fn each_row(
    picture: &mut Picture<'_, '_>,
    rows: Range<usize>,
    mut write: impl FnMut(&[u8]) -> Result<(), EncodingError>,
) -> Result<(), EncodingError> {
    picture.visit(rows, |image, rows| each_row_of(image, rows, &mut write))
}

fn each_row_of(
    image: &EncodedImage,
    rows: Range<usize>,
    mut write: impl FnMut(&[u8]) -> Result<(), EncodingError>,
) -> Result<(), EncodingError> {
    let count = image.width() * image.channels().count();
    let place = rows.start * count..rows.end * count;
    match image.samples() {
        Samples::U8(samples) => samples[place].chunks_exact(count).try_for_each(write),
        Samples::U16(samples) => {
            let mut big_endian = vec![0u16; count];
            samples[place].chunks_exact(count).try_for_each(|row| {
                big_endian.iter_mut().zip(row).for_each(|(into, sample)| *into = sample.to_be());
                write(cast_slice(&big_endian))
            })
        }
        // Callers have checked with `Format::supports`.
        Samples::Half(_) | Samples::Float(_) => Err(limit("PNG has no float samples")),
    }
}

fn dimension(pixels: usize) -> Result<u32, EncodingError> {
    u32::try_from(pixels).map_err(|_| limit("more pixels than PNG can count"))
}

fn limit(reason: &str) -> EncodingError {
    EncodingError::IoError(std::io::Error::other(reason))
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;
    use crate::{Limits, read_from};

    /// Columns and rows, more than a sample has.
    const SIZE: (usize, usize) = (64, 600);

    fn options(compression: Compression) -> WriteOptions {
        WriteOptions { compression, ..WriteOptions::default() }
    }

    fn picture(sample: impl FnMut(usize) -> u16) -> EncodedImage {
        let samples = Samples::U16((0..SIZE.0 * SIZE.1 * 3).map(sample).collect());
        EncodedImage::new(SIZE.0, SIZE.1, Channels::Rgb, Depth::Sixteen, samples).unwrap()
    }

    /// Makes a picture whose samples say nothing of each other.
    fn noise() -> EncodedImage {
        let mut state = 1u64;
        picture(|_| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 48) as u16
        })
    }

    #[test]
    fn noise_is_stored_and_smooth_pictures_are_compressed() {
        let smooth = picture(|at| (at % (SIZE.0 * 3) * 100) as u16);
        for (image, compression, is_small) in [
            (&smooth, Compression::None, false),
            (&smooth, Compression::Fast, true),
            (&smooth, Compression::Balanced, true),
            (&smooth, Compression::High, true),
            (&noise(), Compression::Fast, false),
            (&noise(), Compression::Balanced, false),
            (&noise(), Compression::High, false),
        ] {
            let mut file = Vec::new();
            encode(&mut file, Picture::Held(image), &options(compression)).unwrap();
            let raw = SIZE.0 * SIZE.1 * 6;
            assert!(file.len() < raw + raw / 100, "{compression:?}: {} of {raw} bytes", file.len());
            assert_eq!(file.len() < raw / 2, is_small, "{compression:?}: {} of {raw} bytes", file.len());
            let read = read_from(Cursor::new(&file), Path::new("a.png"), &Limits::memory(1 << 24)).unwrap();
            assert_eq!(read.image.samples(), image.samples(), "{compression:?}");
        }
    }

    /// A disk with so much room.
    struct Small(usize);

    impl Write for Small {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            if self.0 == 0 {
                return Err(io::Error::from(io::ErrorKind::StorageFull));
            }
            let taken = bytes.len().min(self.0);
            self.0 -= taken;
            Ok(taken)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_full_disk_is_an_error_wherever_it_comes() {
        let image = picture(|at| (at % 1000) as u16);
        for compression in [Compression::None, Compression::Balanced, Compression::High] {
            let mut file = Vec::new();
            encode(&mut file, Picture::Held(&image), &options(compression)).unwrap();
            let places = (0..200).chain((200..file.len() - 200).step_by(997)).chain(file.len() - 200..file.len());
            for place in places {
                let error = encode(Small(place), Picture::Held(&image), &options(compression)).unwrap_err();
                assert!(matches!(&error, EncodingError::IoError(error) if error.kind() == io::ErrorKind::StorageFull));
            }
            encode(Small(file.len()), Picture::Held(&image), &options(compression)).unwrap();
        }
    }
}
