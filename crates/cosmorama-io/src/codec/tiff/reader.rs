use std::io::SeekFrom;
use std::path::Path;
use std::sync::Arc;

use cosmorama::raster::{AlphaMode, Channels, Depth, FramePool, Samples};
use tiff::decoder::{Decoder, DecodingResult, DecodingSampleType};
use tiff::tags::{CompressionMethod, SampleFormat, Tag};
use tiff::{ColorType, TiffError};

use super::{carried, extent, jpeg_parts};
use crate::codec::interface::{Density, Source, whole_image};
use crate::{Format, Header, ImageFile, IoError, Limits, Metadata};

pub(super) const FORMAT: Format = Format::Tiff;
const EXPECTED: &str = "grey or RGB, with or without alpha, of 8 or 16 bits or floats, pixel by pixel";
const COMPRESSIONS: &str = "none, PackBits, LZW, deflate or JPEG; `tiffcp -c lzw` writes the file again";

pub(super) const ICC_PROFILE: Tag = Tag::Unknown(34675);

pub(crate) fn probe(path: &Path, source: Source<'_>) -> Result<Header, IoError> {
    let mut decoder = opened(path, source)?;
    let mut header = header(path, &mut decoder)?;
    check_capacity(path, &mut decoder, &header)?;
    header.metadata.notes.extend(beside(path, &mut decoder)?);
    Ok(header)
}

/// Opens a file, unless one of its texts cannot be in it: of each of those the decoder would print a line.
fn opened<'a>(path: &Path, source: Source<'a>) -> Result<Decoder<Source<'a>>, IoError> {
    let unread = |error| IoError::open(path, error);
    if let Some((tag, count)) = extent::endless_text(source).map_err(unread)? {
        let reason = format_args!("its tag {tag} has a text of {count} bytes, more than texts and the file have");
        return Err(IoError::damaged(path, FORMAT, reason));
    }
    source.rewind().map_err(unread)?;
    Decoder::new(source).map_err(|error| damaged(path, &error))
}

/// Refuses a header that declares more pixels than the file can hold, and compressions that are not read. Strips that lie in the same
/// place count once.
fn check_capacity(path: &Path, decoder: &mut Decoder<Source<'_>>, header: &Header) -> Result<(), IoError> {
    let density = density(path, decoder)?;
    let bytes = decoder.inner().seek(SeekFrom::End(0)).map_err(|error| IoError::open(path, error))?;
    header.check_density(path, density, bytes)
}

/// Returns the density of pixels in strips. Refuses compressions that are not read.
fn density(path: &Path, decoder: &mut Decoder<Source<'_>>) -> Result<Density, IoError> {
    let fail = |error: TiffError| damaged(path, &error);
    let method = decoder.find_tag_unsigned::<u16>(Tag::Compression).map_err(fail)?;
    let unpacked = match method.map_or(CompressionMethod::None, CompressionMethod::from_u16_exhaustive) {
        CompressionMethod::None => 1,
        // Runs of 128 in two bytes.
        CompressionMethod::PackBits => 64,
        CompressionMethod::Deflate | CompressionMethod::OldDeflate => Density::DEFLATE,
        // Strings of 4096 in twelve bits.
        CompressionMethod::LZW => 2731,
        CompressionMethod::ModernJPEG => return Ok(Density::JPEG),
        other => return Err(IoError::unsupported(path, FORMAT, compression(other), COMPRESSIONS)),
    };
    let colour = decoder.colortype().map_err(fail)?;
    Ok(Density::of_bits(u64::from(colour.bit_depth()) * u64::from(colour.num_samples()), unpacked))
}

/// Returns the name of a compression that is not read.
fn compression(method: CompressionMethod) -> String {
    let number = method.to_u16();
    let name = match method {
        CompressionMethod::Huffman | CompressionMethod::Fax3 | CompressionMethod::Fax4 => "of fax machines",
        CompressionMethod::JPEG => "by JPEG in the old way of TIFF 6",
        CompressionMethod::ZSTD => "by Zstandard",
        CompressionMethod::WebP => "by WebP",
        _ => "unknown here",
    };
    format!("compression {number}, {name}")
}

/// Refuses a file with further pages as large as the first, and reports other pages. Copies at a lower resolution, and
/// masks, do not count as pages.
fn beside(path: &Path, decoder: &mut Decoder<Source<'_>>) -> Result<Option<String>, IoError> {
    const NO_PAGE: u32 = 0b101;
    let first = decoder.dimensions().ok();
    let (mut pages, mut others) = (1, 0);
    // Further pages are not read. A damaged one counts as none.
    while decoder.more_images() && decoder.next_image().is_ok() {
        let kind = decoder.find_tag_unsigned::<u32>(Tag::NewSubfileType).ok().flatten().unwrap_or(0);
        match kind & NO_PAGE {
            0 if decoder.dimensions().ok() == first => pages += 1,
            0 => others += 1,
            _ => {}
        }
    }
    if pages > 1 {
        return Err(IoError::several(path, FORMAT, pages, "pages of one size"));
    }
    Ok((others > 0).then(|| format!("pages of other sizes behind the first are not read: {others}")))
}

pub(crate) fn read(path: &Path, source: Source<'_>, limits: &Limits, pool: &FramePool) -> Result<ImageFile, IoError> {
    let file: Source<'_> = &mut *source;
    let mut decoder = opened(path, file)?;
    let mut header = header(path, &mut decoder)?;
    limits.check(path, (header.width as u64, header.height as u64), header.channels, header.depth)?;
    check_capacity(path, &mut decoder, &header)?;
    jpeg_parts::check(path, &mut decoder)?;
    let mode = alpha_mode(&mut decoder);
    let mut decoder = decoder.with_limits(within(limits));
    let result = decode(&mut decoder, &header, pool).map_err(|error| damaged(path, &error))?;
    beside(path, &mut decoder)?;
    drop(decoder);
    check_behind(path, source)?;
    let pixels = header.width * header.height;
    let (samples, excess) = samples(path, result, (pixels, header.channels), mode)?;
    header.metadata.cut_colours = excess.checked(path)?;
    let mut file = whole_image(path, header, samples)?;
    file.image = file.image.with_alpha_mode(mode);
    Ok(file)
}

/// Reads a file to its end, and drops its samples strip by strip, or tile by tile.
pub(crate) fn check(path: &Path, source: Source<'_>, limits: &Limits) -> Result<(), IoError> {
    let mut decoder = opened(path, &mut *source)?;
    let header = header(path, &mut decoder)?;
    check_capacity(path, &mut decoder, &header)?;
    jpeg_parts::check(path, &mut decoder)?;
    let mode = alpha_mode(&mut decoder);
    let mut decoder = decoder.with_limits(within(limits));
    // What is too large to be computed is refused as in a reading.
    decoder.image_buffer_layout().map_err(|error| damaged(path, &error))?;
    let mut excess = Excess::default();
    for index in 0..count_chunks(&decoder, &header) {
        let of_chunk = check_chunk(path, &mut decoder, index, (&header, limits, mode))?;
        excess.partial += of_chunk.partial;
        excess.above += of_chunk.above;
    }
    excess.checked(path)?;
    beside(path, &mut decoder)?;
    drop(decoder);
    check_behind(path, source)
}

/// Returns the number of strips or tiles, which all have the samples of all channels: planes are refused.
fn count_chunks(decoder: &Decoder<Source<'_>>, header: &Header) -> u32 {
    let (width, height) = decoder.chunk_dimensions();
    let [across, down] = [(header.width, width), (header.height, height)].map(|(all, one)| (all as u32).div_ceil(one));
    across * down
}

/// Reads a strip or a tile, unless it needs more memory than `limits` allow.
fn check_chunk(
    path: &Path,
    decoder: &mut Decoder<Source<'_>>,
    index: u32,
    (header, limits, mode): (&Header, &Limits, AlphaMode),
) -> Result<Excess, IoError> {
    let fail = |error: TiffError| damaged(path, &error);
    let needed = decoder.image_chunk_buffer_layout(index).map_err(fail)?.complete_len;
    let size = (header.width as u64, header.height as u64);
    limits.check_bytes(path, size, header.channels, header.depth, needed as u128)?;
    let result = decoder.read_chunk(index).map_err(fail)?;
    let (width, height) = decoder.chunk_data_dimensions(index);
    let pixels = width as usize * height as usize;
    samples(path, result, (pixels, header.channels), mode).map(|(_, excess)| excess)
}

/// Refuses files that follow the one that has been read.
fn check_behind(path: &Path, source: Source<'_>) -> Result<(), IoError> {
    let behind = extent::count_behind(source).map_err(|error| IoError::open(path, error))?;
    if behind > 0 {
        return Err(IoError::several(path, FORMAT, 1 + behind, "pictures one behind the other"));
    }
    Ok(())
}

/// Returns the decoder's own limits. Ours have been checked, and its buffers are no larger than the image, or than a strip of it.
fn within(limits: &Limits) -> tiff::decoder::Limits {
    let mut own = tiff::decoder::Limits::default();
    own.decoding_buffer_size = usize::try_from(limits.memory).unwrap_or(usize::MAX);
    own.intermediate_buffer_size = own.decoding_buffer_size;
    own
}

/// Decodes all samples. Memory comes from a pool if the file holds only the channels of the header, in their own type.
fn decode(decoder: &mut Decoder<Source<'_>>, header: &Header, pool: &FramePool) -> Result<DecodingResult, TiffError> {
    let count = header.width * header.height * header.channels.count();
    let layout = decoder.image_buffer_layout()?;
    if layout.planes != 1 || layout.complete_len != count * header.depth.bytes() {
        return decoder.read_image();
    }
    let mut result = match layout.sample_type {
        Some(DecodingSampleType::U8) => DecodingResult::U8(pool.take(count)),
        Some(DecodingSampleType::U16) => DecodingResult::U16(pool.take(count)),
        Some(DecodingSampleType::F16) => DecodingResult::F16(pool.take(count)),
        Some(DecodingSampleType::F32) => DecodingResult::F32(pool.take(count)),
        _ => return decoder.read_image(),
    };
    decoder.read_image_bytes(result.as_buffer(0).as_bytes_mut())?;
    Ok(result)
}

pub(super) fn damaged(path: &Path, error: &TiffError) -> IoError {
    match error {
        TiffError::UnsupportedError(found) => IoError::unsupported(path, FORMAT, found, EXPECTED),
        TiffError::IoError(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => {
            IoError::damaged(path, FORMAT, "it ends too early")
        }
        error => IoError::damaged(path, FORMAT, error),
    }
}

fn header(path: &Path, decoder: &mut Decoder<Source<'_>>) -> Result<Header, IoError> {
    let fail = |error: TiffError| damaged(path, &error);
    let (width, height) = decoder.dimensions().map_err(fail)?;
    let colour = decoder.colortype().map_err(fail)?;
    let unsupported = |found: &dyn std::fmt::Display| IoError::unsupported(path, FORMAT, found, EXPECTED);
    let channels = match colour {
        ColorType::Gray(_) => Channels::Grey,
        ColorType::GrayA(_) | ColorType::Multiband { num_samples: 2, .. } => Channels::GreyAlpha,
        ColorType::RGB(_) => Channels::Rgb,
        ColorType::RGBA(_) => Channels::Rgba,
        // The decoder returns these colours as they are stored, as luma and two differences of colour.
        ColorType::YCbCr(_) => return Err(unsupported(&"YCbCr colours")),
        other => return Err(unsupported(&format_args!("{other:?}"))),
    };
    let planes = decoder.find_tag_unsigned::<u16>(Tag::PlanarConfiguration).map_err(fail)?;
    if planes == Some(2) && channels != Channels::Grey {
        return Err(unsupported(&"one plane for each channel"));
    }
    let formats = decoder.find_tag_unsigned_vec::<u16>(Tag::SampleFormat).map_err(fail)?;
    let format = formats
        .and_then(|formats| formats.first().copied())
        .map_or(SampleFormat::Uint, SampleFormat::from_u16_exhaustive);
    let depth = match (colour.bit_depth(), format) {
        (1..=8, SampleFormat::Uint) => Depth::Eight,
        (16, SampleFormat::Uint) => Depth::Sixteen,
        (16, SampleFormat::IEEEFP) => Depth::Half,
        (32 | 64, SampleFormat::IEEEFP) => Depth::Float,
        (bits, format) => return Err(unsupported(&format_args!("{bits}-bit {format:?} samples"))),
    };
    let metadata = metadata(decoder);
    let (width, height) = (width as usize, height as usize);
    Ok(Header { format: FORMAT, width, height, channels, depth, metadata, window: None })
}

/// Reads the metadata; tags that are missing or unreadable are left out.
fn metadata(decoder: &mut Decoder<Source<'_>>) -> Metadata {
    let profile = decoder.get_tag_u8_vec(ICC_PROFILE).ok();
    let orientation = decoder.find_tag_unsigned::<u16>(Tag::Orientation).ok().flatten();
    let carried::Found { carried, complaints, software, .. } = carried::read(decoder);
    let metadata = Metadata {
        orientation: orientation.filter(|orientation| (2..=8).contains(orientation)),
        complaints,
        carried: Arc::new(carried),
        ..Metadata::by(software)
    };
    metadata.with_profile(profile)
}

/// Reads the tag for premultiplied alpha.
fn alpha_mode(decoder: &mut Decoder<Source<'_>>) -> AlphaMode {
    match decoder.find_tag_unsigned_vec::<u16>(Tag::ExtraSamples) {
        Ok(Some(kinds)) if kinds.first() == Some(&1) => AlphaMode::Premultiplied,
        _ => AlphaMode::Straight,
    }
}

/// Returns the samples of so many pixels, and how many of these have colours above their alpha.
fn samples(
    path: &Path,
    result: DecodingResult,
    (pixels, channels): (usize, Channels),
    mode: AlphaMode,
) -> Result<(Samples, Excess), IoError> {
    let multiplied = mode == AlphaMode::Premultiplied && channels.has_alpha();
    let mut excess = Excess::default();
    let samples = match result {
        DecodingResult::U8(samples) => {
            let mut samples = chosen(path, samples, pixels, channels)?;
            if multiplied {
                excess = divide_by_alpha(&mut samples, channels);
            }
            Samples::U8(samples)
        }
        DecodingResult::U16(samples) => {
            let mut samples = chosen(path, samples, pixels, channels)?;
            if multiplied {
                excess = divide_by_alpha(&mut samples, channels);
            }
            Samples::U16(samples)
        }
        DecodingResult::F16(samples) => Samples::Half(chosen(path, samples, pixels, channels)?),
        DecodingResult::F32(samples) => Samples::Float(chosen(path, samples, pixels, channels)?),
        DecodingResult::F64(samples) => {
            Samples::Float(chosen(path, samples, pixels, channels)?.into_iter().map(|sample| sample as f32).collect())
        }
        _ => return Err(IoError::unsupported(path, FORMAT, "another sample type than it said", EXPECTED)),
    };
    Ok((samples, excess))
}

/// Returns the samples of the selected channels; a pixel may have more.
fn chosen<S: Copy>(path: &Path, samples: Vec<S>, pixels: usize, channels: Channels) -> Result<Vec<S>, IoError> {
    let count = channels.count();
    let stride = samples.len().checked_div(pixels).unwrap_or(0);
    if stride < count || stride * pixels != samples.len() {
        return Err(IoError::unsupported(path, FORMAT, "samples of less than 8 bits", EXPECTED));
    }
    if stride == count {
        return Ok(samples);
    }
    Ok(samples.chunks_exact(stride).flat_map(|pixel| pixel[..count].iter().copied()).collect())
}

/// Numbers of pixels by which a picture that says it is premultiplied is judged.
#[derive(Clone, Copy, Default)]
struct Excess {
    /// Pixels that are partly transparent.
    partial: usize,
    /// Pixels of these whose colours exceed their alpha.
    above: usize,
}

impl Excess {
    /// Returns the number of pixels whose colours were cut. Refuses pictures in which they are most of what is partly transparent.
    fn checked(self, path: &Path) -> Result<usize, IoError> {
        let Self { partial, above } = self;
        if 2 * above > partial {
            let found = format!(
                "it says that colours are premultiplied, but colour exceeds alpha in {above} of {partial} pixels that are partly \
                 transparent; say that alpha is straight (ExtraSamples 2), or write the file again with premultiplied colours"
            );
            return Err(IoError::damaged(path, FORMAT, found));
        }
        Ok(above)
    }
}

/// Divides integer colours by alpha, because integers are straight in memory. Colours that exceed alpha are cut to white.
fn divide_by_alpha<S: Copy + Into<u32> + TryFrom<u32>>(samples: &mut [S], channels: Channels) -> Excess {
    let full = (1_u32 << (8 * size_of::<S>())) - 1;
    let (mut partial, mut above) = (0, 0);
    for pixel in samples.chunks_exact_mut(channels.count()) {
        let Some((alpha, colour)) = pixel.split_last_mut() else { continue };
        let alpha: u32 = (*alpha).into();
        if alpha > 0 && alpha < full {
            partial += 1;
            // Programs round.
            above += usize::from(colour.iter().any(|sample| (*sample).into() > alpha + 1));
        }
        for sample in colour {
            let multiplied: u64 = u64::from((*sample).into());
            let straight = (multiplied * u64::from(full) + u64::from(alpha) / 2).checked_div(u64::from(alpha));
            let straight = straight.unwrap_or(0).min(u64::from(full)) as u32;
            *sample = S::try_from(straight).unwrap_or(*sample);
        }
    }
    Excess { partial, above }
}
