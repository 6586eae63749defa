use std::io::{self, SeekFrom};
use std::ops::Range;
use std::path::Path;

use cosmorama::raster::{Channels, Depth, EncodedImage, FramePool, Samples};
use image::codecs::tga::{TgaDecoder, TgaEncoder};
use image::{ColorType, ExtendedColorType, ImageDecoder};

use crate::codec::interface::{Codec, Sink, Source, held, whole_image};
use crate::header::Picture;
use crate::{Format, Header, ImageFile, IoError, Limits, MadeRows, Metadata, WriteOptions};

const FORMAT: Format = Format::Tga;

/// Most pixels that a byte of a file can hold: runs of 128, each of at least two bytes.
const PIXELS_PER_BYTE: u64 = 64;

/// Codec of Truevision Targa.
pub(crate) struct Tga;

impl Codec for Tga {
    fn probe(&self, path: &Path, source: Source<'_>) -> Result<Header, IoError> {
        let header = header(path, &decoder(path, &mut *source)?)?;
        held(path, source, header, PIXELS_PER_BYTE)
    }

    fn decode(&self, path: &Path, source: Source<'_>, limits: &Limits, pool: &FramePool) -> Result<ImageFile, IoError> {
        let alpha_declared = alpha_bits(path, source)? > 0;
        let decoder = decoder(path, source)?;
        let mut header = header(path, &decoder)?;
        limits.check(path, (header.width as u64, header.height as u64), header.channels, header.depth)?;
        let mut samples = pool.take(header.width * header.height * header.channels.count());
        decoder.read_image(&mut samples).map_err(|error| IoError::damaged(path, FORMAT, error))?;
        // In pixels of 32 bits of which the header declares none as alpha, some writers store alpha, and others
        // padding.
        if !alpha_declared && header.channels == Channels::Rgba && samples.iter().skip(3).step_by(4).all(|a| *a == 0) {
            samples = samples.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
            header.channels = Channels::Rgb;
        }
        whole_image(path, header, Samples::U8(samples))
    }

    fn encode(&self, path: &Path, output: Sink<'_>, image: &EncodedImage, _: &WriteOptions) -> Result<(), IoError> {
        write(output, Picture::Held(image)).map_err(|error| IoError::write(path, error))
    }

    fn encode_rows(&self, path: &Path, output: Sink<'_>, rows: MadeRows<'_>, _: &WriteOptions) -> Result<(), IoError> {
        write(output, Picture::Made(rows)).map_err(|error| IoError::write(path, error))
    }
}

/// Bytes of the header.
const HEADER: usize = 18;

/// Place of the number of rows in it.
const HEIGHT: Range<usize> = 14..16;

/// Writes a picture row by row: no run of equal pixels may go on in the next row (Truevision TGA file format specification 2.0, "Run-length
/// encoded images").
fn write(output: Sink<'_>, mut picture: Picture<'_, '_>) -> io::Result<()> {
    let colour = match picture.channels() {
        Channels::Grey => ExtendedColorType::L8,
        Channels::GreyAlpha => ExtendedColorType::La8,
        Channels::Rgb => ExtendedColorType::Rgb8,
        Channels::Rgba => ExtendedColorType::Rgba8,
    };
    let (columns, lines) = picture.size();
    let (Ok(width @ 1..), Ok(height @ 1..)) = (u16::try_from(columns), u16::try_from(lines)) else {
        return Err(io::Error::other(format!("it has {columns}x{lines} pixels; TGA counts 1 to 65535 on a side")));
    };
    let count = columns * picture.channels().count();
    let (mut bytes, mut is_first) = (Vec::new(), true);
    picture.visit(0..lines, |image, rows| {
        let Samples::U8(samples) = image.samples() else { return Err(io::Error::other("TGA has 8 bits")) };
        samples[rows.start * count..rows.end * count].chunks_exact(count).try_for_each(|row| {
            bytes.clear();
            // As a picture of its own.
            TgaEncoder::new(&mut bytes).encode(row, width.into(), 1, colour).map_err(io::Error::other)?;
            bytes[HEIGHT].copy_from_slice(&height.to_le_bytes());
            output.write_all(&bytes[if std::mem::take(&mut is_first) { 0 } else { HEADER }..])
        })
    })
}

fn decoder<'a>(path: &Path, source: Source<'a>) -> Result<TgaDecoder<Source<'a>>, IoError> {
    TgaDecoder::new(source).map_err(|error| IoError::damaged(path, FORMAT, error))
}

/// Returns the number of alpha bits that the header declares.
fn alpha_bits(path: &Path, source: Source<'_>) -> Result<u8, IoError> {
    let mut start = [0; 18];
    source.read_exact(&mut start).map_err(|_| IoError::damaged(path, FORMAT, "it ends too early"))?;
    source.seek(SeekFrom::Start(0)).map_err(|error| IoError::open(path, error))?;
    Ok(start[17] & 0x0f)
}

fn header(path: &Path, decoder: &impl ImageDecoder) -> Result<Header, IoError> {
    let (width, height) = decoder.dimensions();
    let channels = match decoder.color_type() {
        ColorType::L8 => Channels::Grey,
        ColorType::La8 => Channels::GreyAlpha,
        ColorType::Rgb8 => Channels::Rgb,
        ColorType::Rgba8 => Channels::Rgba,
        other => return Err(IoError::unsupported(path, FORMAT, format_args!("{other:?}"), "8-bit grey or RGB")),
    };
    Ok(Header {
        format: FORMAT,
        width: width as usize,
        height: height as usize,
        channels,
        depth: Depth::Eight,
        metadata: Metadata::default(),
        window: None,
    })
}
