use std::borrow::Cow;
use std::io::{Seek, Write};
use std::path::Path;

use bytemuck::{Pod, cast_slice};
use cosmorama::raster::{AlphaMode, Channels, Depth, EncodedImage, Samples};
use flate2::write::ZlibEncoder;
use rayon::prelude::*;
use tiff::TiffError;
use tiff::encoder::{DirectoryEncoder, Rational, TiffEncoder, TiffKind, TiffKindBig, TiffKindStandard};
use tiff::tags::{CompressionMethod, PhotometricInterpretation, Predictor, ResolutionUnit, SampleFormat, Tag, Type};

use super::carried;
use super::reader::ICC_PROFILE;
use crate::codec::interface::is_beside_others;
use crate::header::Picture;
use crate::{Compression, IoError, WriteOptions};

/// Bytes of a strip before it is compressed, at least, unless the picture has fewer.
const STRIP: usize = 1_000_000;

/// Bytes of samples beside which all else finds room below 4 GiB, where the places of TIFF end.
const MOST_SAMPLES: u64 = (1 << 32) - (1 << 28);

/// Writes a picture as TIFF, or as BigTIFF where TIFF's places of 32 bits might not reach its end. The library's encoder compresses
/// only pictures that are held whole, so strips are made here.
pub(crate) fn write(
    path: &Path,
    output: impl Write + Seek,
    picture: Picture<'_, '_>,
    options: &WriteOptions,
) -> Result<(), IoError> {
    let (width, height) = picture.size();
    if width == 0 || height == 0 {
        return Err(IoError::write(path, "a picture without pixels"));
    }
    let bytes = (row_bytes(width, &picture) as u64).saturating_mul(height as u64);
    let result = if is_big(bytes) {
        encode::<_, TiffKindBig>(output, picture, options)
    } else {
        encode::<_, TiffKindStandard>(output, picture, options)
    };
    result.map_err(|error| IoError::write(path, error))
}

/// Returns whether so many bytes of samples need a BigTIFF.
const fn is_big(bytes: u64) -> bool {
    bytes > MOST_SAMPLES
}

fn encode<W: Write + Seek, K: TiffKind>(
    output: W,
    mut picture: Picture<'_, '_>,
    options: &WriteOptions,
) -> Result<(), TiffError> {
    let (size, metadata) = (picture.size(), &options.metadata);
    let (channels, depth) = (picture.channels(), picture.depth());
    let packing = Packing::new(options.compression, depth);
    let rows = STRIP.div_ceil(row_bytes(size.0, &picture));
    let mut encoder = TiffEncoder::<W, K>::new_generic(output)?;
    let fields = metadata.carried.exif.as_ref().map(|exif| exif.to_write(size, metadata)).unwrap_or_default();
    let places = carried::write_directories(&mut encoder, &fields)?;
    let mut tags = encoder.image_directory()?;
    write_form(&mut tags, size, channels)?;
    packing.write_tags(&mut tags)?;
    tags.write_tag(Tag::RowsPerStrip, u32::try_from(rows)?)?;
    tags.write_tag(Tag::Software, &*metadata.software_to_write())?;
    carried::write_tags(&mut tags, metadata, (&fields, &places), size)?;
    if channels.has_alpha() {
        let kind: u16 = if picture.alpha_mode() == AlphaMode::Premultiplied { 1 } else { 2 };
        tags.write_tag(Tag::ExtraSamples, &[kind][..])?;
    }
    if let Some(profile) = metadata.profile_to_write(channels, depth) {
        carried::write_bytes(&mut tags, ICC_PROFILE, Type::UNDEFINED, &profile)?;
    }
    let strips = write_strips(&mut tags, &mut picture, (packing, rows))?;
    carried::align(&mut tags)?;
    write_samples(&mut tags, channels, depth)?;
    tags.write_tag(Tag::StripOffsets, K::convert_slice(&strips.places))?;
    tags.write_tag(Tag::StripByteCounts, K::convert_slice(&strips.lengths))?;
    tags.finish()
}

/// Writes the tags of a picture's size and channels.
fn write_form<W: Write + Seek, K: TiffKind>(
    tags: &mut DirectoryEncoder<'_, W, K>,
    (width, height): (usize, usize),
    channels: Channels,
) -> Result<(), TiffError> {
    tags.write_tag(Tag::ImageWidth, u32::try_from(width)?)?;
    tags.write_tag(Tag::ImageLength, u32::try_from(height)?)?;
    let is_grey = matches!(channels, Channels::Grey | Channels::GreyAlpha);
    let meaning = if is_grey { PhotometricInterpretation::BlackIsZero } else { PhotometricInterpretation::RGB };
    tags.write_tag(Tag::PhotometricInterpretation, meaning.to_u16())?;
    tags.write_tag(Tag::SamplesPerPixel, u16::try_from(channels.count())?)?;
    tags.write_tag(Tag::XResolution, Rational { n: 1, d: 1 })?;
    tags.write_tag(Tag::YResolution, Rational { n: 1, d: 1 })?;
    tags.write_tag(Tag::ResolutionUnit, ResolutionUnit::None)
}

/// Writes the tags of the form of each sample.
fn write_samples<W: Write + Seek, K: TiffKind>(
    tags: &mut DirectoryEncoder<'_, W, K>,
    channels: Channels,
    depth: Depth,
) -> Result<(), TiffError> {
    let format = if depth.is_float() { SampleFormat::IEEEFP } else { SampleFormat::Uint };
    tags.write_tag(Tag::BitsPerSample, &vec![depth.bytes() as u16 * 8; channels.count()][..])?;
    tags.write_tag(Tag::SampleFormat, &vec![format.to_u16(); channels.count()][..])
}

/// Places of strips in the file, and their bytes there.
struct Strips<K: TiffKind> {
    places: Vec<K::OffsetType>,
    lengths: Vec<K::OffsetType>,
}

/// Writes the samples of a picture, in strips of so many rows.
fn write_strips<W: Write + Seek, K: TiffKind>(
    tags: &mut DirectoryEncoder<'_, W, K>,
    picture: &mut Picture<'_, '_>,
    (packing, rows): (Packing, usize),
) -> Result<Strips<K>, TiffError> {
    let mut strips = Strips { places: Vec::new(), lengths: Vec::new() };
    // Rows that are made come one after the other, while no thread has other work. Whole pictures may be made beside others.
    let is_alone = matches!(picture, Picture::Made(_)) || !is_beside_others();
    let mut write = |samples: &[u8], strip: usize| -> Result<(), TiffError> {
        for packed in packing.packed((samples, strip), is_alone)? {
            strips.places.push(K::convert_offset(tags.write_data(&packed[..])?)?);
            strips.lengths.push(K::convert_offset(packed.len() as u64)?);
        }
        Ok(())
    };
    let (width, height) = picture.size();
    let strip = rows * row_bytes(width, picture);
    // As many strips as threads, which compress them side by side.
    let together = if is_alone { rayon::current_num_threads() } else { 1 } * strip;
    let mut samples = Vec::new();
    picture.visit::<TiffError>(0..height, |image, rows| {
        for row in rows {
            append_row(&mut samples, image, row, packing);
            if samples.len() >= together {
                write(&samples, strip)?;
                samples.clear();
            }
        }
        Ok(())
    })?;
    write(&samples, strip)?;
    Ok(strips)
}

/// Compression of samples, and what of them is compressed.
#[derive(Clone, Copy)]
struct Packing {
    /// Level of deflate, if samples are compressed.
    deflate: Option<flate2::Compression>,
    /// Whether differences of neighbours are written, which are compressed better.
    differences: bool,
}

impl Packing {
    fn new(compression: Compression, depth: Depth) -> Self {
        let deflate = match compression {
            Compression::None => None,
            Compression::Fast | Compression::Balanced => Some(flate2::Compression::fast()),
            Compression::High => Some(flate2::Compression::default()),
        };
        Self { deflate, differences: deflate.is_some() && !depth.is_float() }
    }

    fn write_tags<W: Write + Seek, K: TiffKind>(self, tags: &mut DirectoryEncoder<'_, W, K>) -> Result<(), TiffError> {
        let method = if self.deflate.is_some() { CompressionMethod::Deflate } else { CompressionMethod::None };
        tags.write_tag(Tag::Compression, method.to_u16())?;
        let predictor = if self.differences { Predictor::Horizontal } else { Predictor::None };
        tags.write_tag(Tag::Predictor, predictor.to_u16())
    }

    /// Returns strips of so many bytes as they are written; the last may have fewer. All threads pack them where they are `alone`.
    fn packed(self, (samples, strip): (&[u8], usize), alone: bool) -> Result<Vec<Cow<'_, [u8]>>, TiffError> {
        let pack = |strip| -> Result<Cow<'_, [u8]>, TiffError> {
            let Some(level) = self.deflate else { return Ok(Cow::Borrowed(strip)) };
            let mut encoder = ZlibEncoder::new(Vec::new(), level);
            encoder.write_all(strip)?;
            Ok(Cow::Owned(encoder.finish()?))
        };
        if alone { samples.par_chunks(strip).map(pack).collect() } else { samples.chunks(strip).map(pack).collect() }
    }
}

/// Appends the samples of a row, or their differences, as the file has them.
fn append_row(into: &mut Vec<u8>, image: &EncodedImage, row: usize, packing: Packing) {
    let channels = image.channels().count();
    let count = image.width() * channels;
    let place = row * count..(row + 1) * count;
    match image.samples() {
        Samples::U8(samples) if packing.differences => {
            append_differences(into, &samples[place], channels, u8::wrapping_sub)
        }
        Samples::U16(samples) if packing.differences => {
            append_differences(into, &samples[place], channels, u16::wrapping_sub);
        }
        Samples::U8(samples) => into.extend_from_slice(&samples[place]),
        Samples::U16(samples) => into.extend_from_slice(cast_slice(&samples[place])),
        Samples::Half(samples) => into.extend_from_slice(cast_slice(&samples[place])),
        Samples::Float(samples) => into.extend_from_slice(cast_slice(&samples[place])),
    }
}

/// Appends the first pixel, and of the others what is more than in the pixel before.
fn append_differences<S: Pod>(into: &mut Vec<u8>, row: &[S], channels: usize, minus: fn(S, S) -> S) {
    into.extend_from_slice(cast_slice(&row[..channels]));
    let differences: Vec<S> = row.iter().zip(&row[channels..]).map(|(before, now)| minus(*now, *before)).collect();
    into.extend_from_slice(cast_slice(&differences));
}

fn row_bytes(width: usize, picture: &Picture<'_, '_>) -> usize {
    width * picture.channels().count() * picture.depth().bytes()
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;
    use std::ops::Range;

    use exif::{Field, In, Value};
    use half::f16;

    use super::*;
    use crate::{Carried, Exif, Limits, MadeRows, Metadata, read_from};

    /// Columns and rows of a picture of more than one strip in all depths.
    const SIZE: (usize, usize) = (501, 1100);

    fn picture(channels: Channels, depth: Depth) -> EncodedImage {
        let codes = (0..SIZE.0 * SIZE.1 * channels.count()).map(|at| (at * at % 65521) as u16);
        let samples = match depth {
            Depth::Eight => Samples::U8(codes.map(|code| (code >> 8) as u8).collect()),
            Depth::Half => Samples::Half(codes.map(|code| f16::from_f32(f32::from(code))).collect()),
            Depth::Float => Samples::Float(codes.map(f32::from).collect()),
            _ => Samples::U16(codes.collect()),
        };
        EncodedImage::new(SIZE.0, SIZE.1, channels, depth, samples).unwrap()
    }

    /// Returns words and fields that lie elsewhere than in the entries of a directory, and in directories of their own.
    fn metadata() -> Metadata {
        let ascii = |words: &str| Value::Ascii(vec![words.as_bytes().to_vec()]);
        let field = |tag, value| Field { tag, ifd_num: In::PRIMARY, value };
        let fields = [field(exif::Tag::LensModel, ascii("a lens")), field(exif::Tag::GPSLatitudeRef, ascii("N"))];
        let carried = Carried { exif: Exif::of_fields(&fields), ..Carried::default() };
        Metadata { origin: Some("long enough to lie elsewhere".into()), carried: carried.into(), ..Metadata::default() }
    }

    #[test]
    fn files_of_either_kind_of_places_are_read_as_they_were_written() {
        let metadata = metadata();
        for (channels, depth) in [
            (Channels::Rgb, Depth::Eight),
            (Channels::GreyAlpha, Depth::Eight),
            (Channels::Rgba, Depth::Sixteen),
            (Channels::Grey, Depth::Float),
            (Channels::Rgb, Depth::Half),
        ] {
            for compression in [Compression::None, Compression::Balanced, Compression::High] {
                let image = picture(channels, depth);
                let metadata = metadata.clone();
                let options = WriteOptions { compression, metadata, ..WriteOptions::default() };
                let (mut small, mut big) = (Cursor::new(Vec::new()), Cursor::new(Vec::new()));
                encode::<_, TiffKindStandard>(&mut small, Picture::Held(&image), &options).unwrap();
                encode::<_, TiffKindBig>(&mut big, Picture::Held(&image), &options).unwrap();
                for (file, version) in [(small.into_inner(), 42), (big.into_inner(), 43)] {
                    let directory = if version == 42 { file[4] } else { file[8] };
                    assert_eq!(directory % 2, 0, "a directory at an odd place");
                    let what = format!("{channels}, {depth}, {compression:?}, version {version}");
                    assert_eq!(u16::from_ne_bytes([file[2], file[3]]), version);
                    let read = read_from(Cursor::new(&file), Path::new("a.tif"), &Limits::memory(1 << 28)).unwrap();
                    assert!(read.image.samples() == image.samples(), "{what}");
                    assert_eq!((read.image.channels(), read.image.depth()), (channels, depth), "{what}");
                    assert_eq!(read.metadata.origin, options.metadata.origin, "{what}");
                    let told = read.metadata.carried.exif.as_ref().unwrap().told();
                    for field in ["LensModel", "GPSLatitudeRef"] {
                        assert!(told.iter().any(|(name, _)| name == field), "{what}: {told:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn rows_that_are_made_become_the_file_of_the_whole_picture() {
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        for (channels, depth) in [(Channels::Rgb, Depth::Eight), (Channels::Rgba, Depth::Float)] {
            let (image, options) = (picture(channels, depth), WriteOptions::default());
            let made = || {
                let mut file = Cursor::new(Vec::new());
                let make = &mut |rows: Range<usize>| Some(image.cropped((0, rows.start), (SIZE.0, rows.len())));
                let rows = MadeRows { size: SIZE, channels, depth, alpha_mode: AlphaMode::Straight, at_once: 77, make };
                write(Path::new("a.tif"), &mut file, Picture::Made(rows), &options).unwrap();
                file.into_inner()
            };
            let whole = || {
                let mut file = Cursor::new(Vec::new());
                write(Path::new("a.tif"), &mut file, Picture::Held(&image), &options).unwrap();
                file.into_inner()
            };
            let file = whole();
            for other in [made(), one.install(made), one.install(whole)] {
                assert!(other == file, "{channels}, {depth}");
            }
        }
    }

    #[test]
    fn samples_that_reach_beyond_places_of_32_bits_need_others() {
        assert!(!is_big(3_700_000_000) && is_big((1 << 32) - 1) && is_big(u64::MAX));
    }

    #[test]
    fn a_picture_without_pixels_is_refused() {
        for size in [(0, 3), (3, 0)] {
            let image =
                EncodedImage::new(size.0, size.1, Channels::Rgb, Depth::Eight, Samples::U8(Vec::new())).unwrap();
            let written =
                write(Path::new("a.tif"), Cursor::new(Vec::new()), Picture::Held(&image), &WriteOptions::default());
            assert!(written.unwrap_err().to_string().contains("without pixels"));
        }
    }
}
