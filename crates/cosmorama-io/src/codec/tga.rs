use std::io::SeekFrom;
use std::path::Path;

use cosmorama::raster::{Channels, Depth, EncodedImage, FramePool, Samples};
use image::codecs::tga::{TgaDecoder, TgaEncoder};
use image::{ColorType, ExtendedColorType, ImageDecoder};

use crate::codec::interface::{Codec, Sink, Source, held, whole_image};
use crate::{Format, Header, ImageFile, IoError, Limits, Metadata, WriteOptions};

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
        let fail = |reason: &dyn std::fmt::Display| IoError::write(path, reason);
        let colour = match image.channels() {
            Channels::Grey => ExtendedColorType::L8,
            Channels::GreyAlpha => ExtendedColorType::La8,
            Channels::Rgb => ExtendedColorType::Rgb8,
            Channels::Rgba => ExtendedColorType::Rgba8,
        };
        let Samples::U8(samples) = image.samples() else { return Err(fail(&"TGA has 8 bits")) };
        let (Ok(width), Ok(height)) = (u16::try_from(image.width()), u16::try_from(image.height())) else {
            return Err(fail(&"more than 65535 pixels on a side, the most that TGA can count"));
        };
        TgaEncoder::new(output).encode(samples, width.into(), height.into(), colour).map_err(|error| fail(&error))
    }
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
