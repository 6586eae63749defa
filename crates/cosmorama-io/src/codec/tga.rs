use std::io::{self, BufReader, Read};
use std::ops::Range;
use std::path::Path;

use cosmorama::raster::{Channels, Depth, EncodedImage, FramePool, Samples};
use image::codecs::tga::{TgaDecoder, TgaEncoder};
use image::{ColorType, ExtendedColorType, ImageDecoder};

use crate::codec::interface::{Codec, Density, Sink, Source, length, whole_image};
use crate::header::Picture;
use crate::{Choice, Format, Header, ImageFile, IoError, Limits, MadeRows, Metadata, WriteOptions};

const FORMAT: Format = Format::Tga;

/// Most pixels that a byte of a file can hold: runs of 128, each of at least two bytes.
const DENSITY: Density = Density::pixels(64);

/// Codec of Truevision Targa.
pub(crate) struct Tga;

impl Codec for Tga {
    fn probe(&self, path: &Path, source: Source<'_>) -> Result<Header, IoError> {
        let bytes = length(path, &mut *source)?;
        let header = header(path, &decoder(path, source)?)?;
        header.check_density(path, DENSITY, bytes)?;
        Ok(header)
    }

    fn decode(&self, path: &Path, source: Source<'_>, limits: &Limits, pool: &FramePool) -> Result<ImageFile, IoError> {
        let bytes = length(path, &mut *source)?;
        let alpha_declared = start(path, source)?[17] & 0x0f > 0;
        let decoder = decoder(path, source)?;
        let mut header = header(path, &decoder)?;
        limits.check(path, (header.width as u64, header.height as u64), header.channels, header.depth)?;
        header.check_density(path, DENSITY, bytes)?;
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

    fn check_chosen(&self, path: &Path, source: Source<'_>, _: &Limits, _: &Choice) -> Result<(), IoError> {
        let start = start(path, source)?;
        // The decoder reads what lies before the pixels, and no byte more.
        let header = header(path, &decoder(path, &mut *source)?)?;
        let pixels = Pixels::of(&start, (header.width as u64) * (header.height as u64));
        pixels
            .check(&mut BufReader::with_capacity(BUFFER, source))
            .map_err(|error| IoError::damaged(path, FORMAT, error))
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

/// Number of bytes of pixels that are read at once.
const BUFFER: usize = 1 << 16;

/// Greatest number of pixels in a packet.
const PACKET: usize = 128;

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

/// Reads the header's bytes, and goes back to the first.
fn start(path: &Path, source: Source<'_>) -> Result<[u8; HEADER], IoError> {
    let mut start = [0; HEADER];
    source.read_exact(&mut start).map_err(|_| IoError::damaged(path, FORMAT, "it ends too early"))?;
    source.rewind().map_err(|error| IoError::open(path, error))?;
    Ok(start)
}

/// Pixels as they lie in a file that the decoder has accepted. It can only read all of them at once.
struct Pixels {
    /// Number of pixels. Packets may go on from row to row.
    count: u64,
    /// Bytes of each.
    bytes: usize,
    are_packed: bool,
    /// Colours that a map has, if pixels are places in it.
    colours: Option<Range<usize>>,
}

impl Pixels {
    /// Describes the pixels of a header.
    fn of(start: &[u8; HEADER], count: u64) -> Self {
        let number = |at: usize| usize::from(u16::from_le_bytes([start[at], start[at + 1]]));
        let (first, length) = (number(3), number(5));
        let colours = matches!(start[2], 1 | 9).then_some(first..first + length);
        Self { count, bytes: usize::from(start[16].div_ceil(8)), are_packed: matches!(start[2], 9..=11), colours }
    }

    /// Reads all pixels, packet by packet, and drops them.
    fn check(&self, source: &mut impl Read) -> io::Result<()> {
        let (mut left, mut packet, mut pixels) = (self.count, [127], [0; 4 * PACKET]);
        while left > 0 {
            if self.are_packed {
                source.read_exact(&mut packet)?;
            }
            let (count, is_run) = (u64::from(packet[0] & 127) + 1, packet[0] > 127);
            let stored = if is_run { 1 } else { count.min(left) as usize };
            let pixels = &mut pixels[..stored * self.bytes];
            source.read_exact(pixels)?;
            self.check_colours(pixels)?;
            left = left.saturating_sub(count);
        }
        Ok(())
    }

    /// Refuses places outside the map of colours.
    fn check_colours(&self, pixels: &[u8]) -> io::Result<()> {
        let Some(colours) = &self.colours else { return Ok(()) };
        let place = |pixel: &[u8]| pixel.iter().rev().fold(0, |place, byte| place << 8 | usize::from(*byte));
        let are_inside = pixels.chunks_exact(self.bytes).all(|pixel| colours.contains(&place(pixel)));
        if are_inside { Ok(()) } else { Err(io::Error::other("a colour outside its map of colours")) }
    }
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
