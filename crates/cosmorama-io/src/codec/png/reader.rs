use std::io::Read;
use std::path::Path;

use bytemuck::cast_slice_mut;
use cosmorama::raster::{Channels, Depth, FramePool, Samples};
use png::{BitDepth, ColorType, DecodeOptions, Decoder, DecodingError, Info, Reader, Transformations};

use super::carried::{self, Found};
use super::colour;
use crate::codec::behind::{next_bytes, skip_padding};
use crate::codec::interface::{Density, Source, length, whole_image};
use crate::{Format, Header, ImageFile, IoError, Limits};

const FORMAT: Format = Format::Png;

/// Most columns or rows that are read: as many as an output may have.
const LONGEST_SIDE: u32 = 1_000_000;

/// Most bytes that the decoder may take for rows and for a colour profile: two of the longest rows have 16 MB.
const DECODER_BYTES: usize = 1 << 25;

/// First bytes of every file.
pub(super) const MARK: [u8; 8] = *b"\x89PNG\r\n\x1a\n";

pub(crate) fn probe(path: &Path, source: Source<'_>) -> Result<Header, IoError> {
    let found = carried::read(&mut *source).map_err(|error| IoError::open(path, error))?;
    let bytes = length(path, &mut *source)?;
    let reader = decoder(path, source)?;
    let header = header(&reader, found);
    header.check_density(path, density(&reader), bytes)?;
    Ok(header)
}

pub(crate) fn read(path: &Path, source: Source<'_>, limits: &Limits, pool: &FramePool) -> Result<ImageFile, IoError> {
    let found = carried::read(&mut *source).map_err(|error| IoError::open(path, error))?;
    let bytes = length(path, &mut *source)?;
    let mut reader = decoder(path, &mut *source)?;
    let header = header(&reader, found);
    check_frames(path, &reader)?;
    let size = (header.width as u64, header.height as u64);
    limits.check(path, size, header.channels, header.depth)?;
    header.check_density(path, density(&reader), bytes)?;
    let count = header.width * header.height * header.channels.count();
    let samples = match header.depth {
        Depth::Eight => {
            let mut samples = pool.take(count);
            decode(path, &mut reader, &mut samples)?;
            Samples::U8(samples)
        }
        _ => {
            let mut samples = pool.take::<u16>(count);
            decode(path, &mut reader, cast_slice_mut(&mut samples))?;
            samples.iter_mut().for_each(|sample| *sample = u16::from_be(*sample));
            Samples::U16(samples)
        }
    };
    let samples = if colour::is_narrow(reader.info()) { full_range(samples, header.channels) } else { samples };
    drop(reader);
    check_behind(path, source)?;
    whole_image(path, header, samples)
}

/// Reads a file to its end, and drops its pixels row by row.
pub(crate) fn check(path: &Path, source: Source<'_>) -> Result<(), IoError> {
    let mut reader = decoder(path, &mut *source)?;
    check_frames(path, &reader)?;
    while reader.next_row().map_err(|error| damaged(path, &error))?.is_some() {}
    reader.finish().map_err(|error| damaged(path, &error))?;
    drop(reader);
    check_behind(path, source)
}

/// Returns the density of pixels as they are stored.
fn density(reader: &Reader<Source<'_>>) -> Density {
    Density::of_bits(reader.info().bits_per_pixel() as u64, Density::DEFLATE)
}

/// Refuses an animation.
fn check_frames(path: &Path, reader: &Reader<Source<'_>>) -> Result<(), IoError> {
    let frames = reader.info().animation_control().map_or(1, |animation| animation.num_frames as usize);
    if frames > 1 { Err(IoError::several(path, FORMAT, frames, "frames of an animation")) } else { Ok(()) }
}

/// Refuses pictures behind the one that has been read.
fn check_behind(path: &Path, source: Source<'_>) -> Result<(), IoError> {
    let behind = count_behind(source).map_err(|error| IoError::open(path, error))?;
    if behind > 0 {
        return Err(IoError::several(path, FORMAT, 1 + behind, "pictures one behind the other"));
    }
    Ok(())
}

/// Stretches code values of narrow range (ITU-R BT.2100-2, table 9) to full range. Alpha always has full range.
fn full_range(mut samples: Samples, channels: Channels) -> Samples {
    match &mut samples {
        Samples::U8(codes) => stretch(codes, channels, |code| narrow_to_full(f32::from(code), 1.0) as u8),
        Samples::U16(codes) => stretch(codes, channels, |code| narrow_to_full(f32::from(code), 256.0) as u16),
        Samples::Half(_) | Samples::Float(_) => {}
    }
    samples
}

/// Returns the code of full range; `step` is an 8-bit step. What is darker than black or brighter than white is clipped.
fn narrow_to_full(code: f32, step: f32) -> f32 {
    let last = 256.0 * step - 1.0;
    ((code - 16.0 * step) / (219.0 * step) * last).round().clamp(0.0, last)
}

fn stretch<S: Copy>(codes: &mut [S], channels: Channels, full: impl Fn(S) -> S) {
    let count = channels.count();
    let colours = if channels.has_alpha() { count - 1 } else { count };
    for pixel in codes.chunks_exact_mut(count) {
        pixel[..colours].iter_mut().for_each(|code| *code = full(*code));
    }
}

/// Counts the pictures that follow one that has been read. Bytes that begin no picture are harmless padding.
fn count_behind(source: Source<'_>) -> std::io::Result<usize> {
    let mut count = 0;
    while next_picture(source)? {
        count += 1;
        while skip_chunk(source)? {}
    }
    Ok(count)
}

/// Returns whether another picture begins behind padding of zeros. Moves to its first chunk.
fn next_picture(source: Source<'_>) -> std::io::Result<bool> {
    skip_padding(source)?;
    Ok(next_bytes(source, MARK.len())? == MARK)
}

/// Skips a chunk; false where it was the last.
fn skip_chunk(source: Source<'_>) -> std::io::Result<bool> {
    let Ok([a, b, c, d, kind @ ..]) = <[u8; 8]>::try_from(next_bytes(source, 8)?) else { return Ok(false) };
    let rest = u64::from(u32::from_be_bytes([a, b, c, d])) + 4;
    let skipped = std::io::copy(&mut source.take(rest), &mut std::io::sink())?;
    Ok(skipped == rest && &kind != b"IEND")
}

fn decoder<'a>(path: &Path, source: Source<'a>) -> Result<Reader<Source<'a>>, IoError> {
    let mut options = DecodeOptions::default();
    // Files that are damaged in what they say of colours, or of how they were made, are not whole.
    options.set_skip_ancillary_crc_failures(false);
    // Texts are read by `carried`, each up to its own limit.
    options.set_ignore_text_chunk(true);
    let mut decoder = Decoder::new_with_options(source, options);
    // The image itself is checked against our own limit.
    decoder.set_limits(png::Limits { bytes: DECODER_BYTES });
    // Palettes, transparent colours and samples of less than eight bits become plain samples.
    decoder.set_transformations(Transformations::EXPAND);
    // A row beyond the decoder's limit would be reported as damaged.
    let (width, height) = decoder.read_header_info().map(Info::size).map_err(|error| damaged(path, &error))?;
    if width.max(height) > LONGEST_SIDE {
        return Err(IoError::too_long(path, FORMAT, (width.into(), height.into()), LONGEST_SIDE.into()));
    }
    decoder.read_info().map_err(|error| damaged(path, &error))
}

fn decode(path: &Path, reader: &mut Reader<Source<'_>>, bytes: &mut [u8]) -> Result<(), IoError> {
    reader.next_frame(bytes).map_err(|error| damaged(path, &error))?;
    // A file that ends right after its pixels is cut, too.
    reader.finish().map_err(|error| damaged(path, &error))
}

fn damaged(path: &Path, error: &DecodingError) -> IoError {
    match error {
        DecodingError::IoError(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => {
            IoError::damaged(path, FORMAT, "it ends too early")
        }
        DecodingError::LimitsExceeded => IoError::damaged(
            path,
            FORMAT,
            format_args!("a chunk beside its pixels takes more than {DECODER_BYTES} bytes"),
        ),
        error => IoError::damaged(path, FORMAT, error),
    }
}

fn header<R: std::io::BufRead + std::io::Seek>(reader: &Reader<R>, found: Found) -> Header {
    let info = reader.info();
    let (colour, bits) = reader.output_color_type();
    let channels = match colour {
        ColorType::Grayscale => Channels::Grey,
        ColorType::GrayscaleAlpha => Channels::GreyAlpha,
        // Palettes are expanded.
        ColorType::Rgb | ColorType::Indexed => Channels::Rgb,
        ColorType::Rgba => Channels::Rgba,
    };
    Header {
        format: FORMAT,
        width: info.width as usize,
        height: info.height as usize,
        channels,
        depth: if bits == BitDepth::Sixteen { significant(info) } else { Depth::Eight },
        metadata: colour::metadata(info, found),
        window: None,
    }
}

/// Returns the depth of 16-bit samples, of which the sBIT chunk may declare fewer bits significant.
fn significant(info: &Info<'_>) -> Depth {
    let bits = info.sbit.as_ref().and_then(|bits| bits.iter().copied().max());
    match bits {
        Some(9..=10) => Depth::Ten,
        Some(11..=12) => Depth::Twelve,
        _ => Depth::Sixteen,
    }
}
