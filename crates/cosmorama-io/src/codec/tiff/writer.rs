use std::io::{Seek, Write};
use std::marker::PhantomData;
use std::path::Path;

use bytemuck::cast_slice;
use cosmorama::raster::{AlphaMode, Channels, EncodedImage, Samples};
use tiff::TiffError;
use tiff::encoder::colortype::ColorType;
use tiff::encoder::{Compression as Packing, DeflateLevel, Predictor, TiffEncoder, TiffValue};
use tiff::tags::{PhotometricInterpretation, SampleFormat, Tag};

use super::carried;
use super::reader::ICC_PROFILE;
use crate::{Compression, IoError, Metadata};

pub(crate) fn write(
    path: &Path,
    output: impl Write + Seek,
    image: &EncodedImage,
    metadata: &Metadata,
    compression: Compression,
) -> Result<(), IoError> {
    let how = &How { metadata, compression };
    let result = match image.samples() {
        Samples::U8(samples) => by_channels::<Byte, _>(output, image, samples, how),
        Samples::U16(samples) => by_channels::<Word, _>(output, image, samples, how),
        Samples::Half(samples) => by_channels::<HalfBits, _>(output, image, cast_slice(samples), how),
        Samples::Float(samples) => by_channels::<Single, _>(output, image, samples, how),
    };
    result.map_err(|error| IoError::write(path, error))
}

/// Metadata and compression of a file to write.
struct How<'a> {
    metadata: &'a Metadata,
    compression: Compression,
}

fn by_channels<S: Sample, W: Write + Seek>(
    output: W,
    image: &EncodedImage,
    samples: &[S::Stored],
    how: &How<'_>,
) -> Result<(), TiffError>
where
    [S::Stored]: TiffValue,
{
    match image.channels() {
        Channels::Grey => encode::<S, 1, W>(output, image, samples, how),
        Channels::GreyAlpha => encode::<S, 2, W>(output, image, samples, how),
        Channels::Rgb => encode::<S, 3, W>(output, image, samples, how),
        Channels::Rgba => encode::<S, 4, W>(output, image, samples, how),
    }
}

fn encode<S: Sample, const CHANNELS: usize, W: Write + Seek>(
    output: W,
    image: &EncodedImage,
    samples: &[S::Stored],
    how: &How<'_>,
) -> Result<(), TiffError>
where
    [S::Stored]: TiffValue,
{
    let packing = match how.compression {
        Compression::None => Packing::Uncompressed,
        Compression::Fast | Compression::Balanced => Packing::Deflate(DeflateLevel::Fast),
        Compression::High => Packing::Deflate(DeflateLevel::Balanced),
    };
    // Differences of neighbours only help a compression that follows.
    let is_plain = S::FORMAT_IS_FLOAT || packing == Packing::Uncompressed;
    let predictor = if is_plain { Predictor::None } else { Predictor::Horizontal };
    let mut encoder = TiffEncoder::new(output)?.with_compression(packing).with_predictor(predictor);
    let (width, height) = (u32::try_from(image.width())?, u32::try_from(image.height())?);
    let size = (image.width(), image.height());
    let exif = how.metadata.carried.exif.as_ref();
    let fields = exif.map(|exif| exif.to_write(size, how.metadata)).unwrap_or_default();
    let places = carried::write_directories(&mut encoder, &fields)?;
    let mut file = encoder.new_image::<Pixel<S, CHANNELS>>(width, height)?;
    let tags = file.encoder();
    tags.write_tag(Tag::Software, &*how.metadata.software_to_write())?;
    carried::write_tags(tags, how.metadata, (&fields, &places), size)?;
    if image.channels().has_alpha() {
        let kind: u16 = if image.alpha_mode() == AlphaMode::Premultiplied { 1 } else { 2 };
        tags.write_tag(Tag::ExtraSamples, &[kind][..])?;
    }
    if let Some(profile) = how.metadata.profile_to_write(image.channels(), image.depth()) {
        tags.write_tag(ICC_PROFILE, &profile[..])?;
    }
    file.write_data(samples)
}

/// A sample type. The encoder's own colour types lack halves and grey with alpha.
trait Sample {
    /// Type that the encoder writes.
    type Stored: TiffValue + Copy;
    const BITS: u16;
    const FORMAT_IS_FLOAT: bool;
    /// Returns the difference of neighbours, which compresses better.
    fn difference(a: Self::Stored, b: Self::Stored) -> Self::Stored;
}

struct Byte;
struct Word;
struct HalfBits;
struct Single;

impl Sample for Byte {
    type Stored = u8;
    const BITS: u16 = 8;
    const FORMAT_IS_FLOAT: bool = false;
    fn difference(a: u8, b: u8) -> u8 {
        a.wrapping_sub(b)
    }
}

impl Sample for Word {
    type Stored = u16;
    const BITS: u16 = 16;
    const FORMAT_IS_FLOAT: bool = false;
    fn difference(a: u16, b: u16) -> u16 {
        a.wrapping_sub(b)
    }
}

impl Sample for HalfBits {
    type Stored = u16;
    const BITS: u16 = 16;
    const FORMAT_IS_FLOAT: bool = true;
    fn difference(a: u16, b: u16) -> u16 {
        a.wrapping_sub(b)
    }
}

impl Sample for Single {
    type Stored = f32;
    const BITS: u16 = 32;
    const FORMAT_IS_FLOAT: bool = true;
    fn difference(a: f32, b: f32) -> f32 {
        a - b
    }
}

/// A pixel of so many samples.
struct Pixel<S, const CHANNELS: usize>(PhantomData<S>);

impl<S: Sample, const CHANNELS: usize> ColorType for Pixel<S, CHANNELS> {
    type Inner = S::Stored;
    const TIFF_VALUE: PhotometricInterpretation =
        if CHANNELS >= 3 { PhotometricInterpretation::RGB } else { PhotometricInterpretation::BlackIsZero };
    const BITS_PER_SAMPLE: &'static [u16] = &[S::BITS; CHANNELS];
    const SAMPLE_FORMAT: &'static [SampleFormat] =
        if S::FORMAT_IS_FLOAT { &[SampleFormat::IEEEFP; CHANNELS] } else { &[SampleFormat::Uint; CHANNELS] };

    fn horizontal_predict(row: &[Self::Inner], result: &mut Vec<Self::Inner>) {
        let first = CHANNELS.min(row.len());
        result.extend_from_slice(&row[..first]);
        result.extend(row.iter().zip(&row[first..]).map(|(before, now)| S::difference(*now, *before)));
    }
}
