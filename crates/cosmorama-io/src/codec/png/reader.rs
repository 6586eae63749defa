use std::path::Path;

use bytemuck::cast_slice_mut;
use cosmorama::raster::{Channels, Depth, Samples};
use png::{BitDepth, ColorType, Decoder, DecodingError, Info, Reader, Transformations};

use super::colour;
use crate::codec::interface::{Source, whole_image};
use crate::{Format, Header, ImageFile, IoError, Limits};

const FORMAT: Format = Format::Png;

pub(crate) fn probe(path: &Path, source: Source<'_>) -> Result<Header, IoError> {
    Ok(header(&decoder(path, source)?))
}

pub(crate) fn read(path: &Path, source: Source<'_>, limits: &Limits) -> Result<ImageFile, IoError> {
    let mut reader = decoder(path, source)?;
    let header = header(&reader);
    let size = (header.width as u64, header.height as u64);
    limits.check(path, size, header.channels, header.depth)?;
    let count = header.width * header.height * header.channels.count();
    let samples = match header.depth {
        Depth::Eight => {
            let mut samples = vec![0; count];
            decode(path, &mut reader, &mut samples)?;
            Samples::U8(samples)
        }
        _ => {
            let mut samples = vec![0_u16; count];
            decode(path, &mut reader, cast_slice_mut(&mut samples))?;
            samples.iter_mut().for_each(|sample| *sample = u16::from_be(*sample));
            Samples::U16(samples)
        }
    };
    whole_image(path, header, samples)
}

fn decoder<'a>(path: &Path, source: Source<'a>) -> Result<Reader<Source<'a>>, IoError> {
    // Its own limit is for rows, profiles and texts; the image itself is checked against ours.
    let mut decoder = Decoder::new(source);
    // Palettes, transparent colours and samples of less than eight bits become plain samples.
    decoder.set_transformations(Transformations::EXPAND);
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
        error => IoError::damaged(path, FORMAT, error),
    }
}

fn header<R: std::io::BufRead + std::io::Seek>(reader: &Reader<R>) -> Header {
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
        metadata: colour::metadata(info),
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
