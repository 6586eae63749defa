mod marks;
mod writer;

use std::io::Cursor;
use std::path::Path;
use std::sync::Arc;

use cosmorama::raster::{Channels, Depth, EncodedImage, FramePool, Primaries, Samples, Transfer};
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::{ZByteReaderTrait, ZCursor};
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use self::marks::Beside;
use crate::codec::interface::{Codec, Density, Sink, Source, length, whole_image};
use crate::header::Picture;
use crate::metadata::{ADOBE_GAMMA, gpano, iptc, orientation};
use crate::{Carried, Exif, Format, Header, ImageFile, IoError, Limits, MadeRows, Metadata, WriteOptions};

const FORMAT: Format = Format::Jpeg;

/// Codec of JPEG, baseline or progressive.
pub(crate) struct Jpeg;

impl Codec for Jpeg {
    fn probe(&self, path: &Path, source: Source<'_>) -> Result<Header, IoError> {
        let beside = marks::beside(source);
        source.rewind().map_err(|error| IoError::open(path, error))?;
        let mut decoder = decoder(path, &mut *source)?;
        let mut header = header(path, &mut decoder, beside)?;
        header.metadata.notes.extend(unread(beside.pictures));
        if beside.has_comment {
            Arc::make_mut(&mut header.metadata.carried).unread.push("a comment (COM)");
        }
        header.check_density(path, Density::JPEG, length(path, source)?)?;
        Ok(header)
    }

    fn decode(&self, path: &Path, source: Source<'_>, limits: &Limits, pool: &FramePool) -> Result<ImageFile, IoError> {
        let bytes = whole(path, source)?;
        let mut decoder = decoder(path, ZCursor::new(&bytes))?;
        let beside = marks::beside(&mut Cursor::new(&bytes));
        let header = header(path, &mut decoder, beside)?;
        if marks::end(&bytes).is_none() {
            return Err(IoError::damaged(path, FORMAT, "it ends too early"));
        }
        // Pictures that a file lists are previews and the like. Only unlisted ones are further pictures.
        let count = if beside.pictures == 0 { marks::count_alike(&bytes) } else { 1 };
        if count > 1 {
            return Err(IoError::several(path, FORMAT, count, "pictures one behind the other"));
        }
        limits.check(path, (header.width as u64, header.height as u64), header.channels, header.depth)?;
        header.check_density(path, Density::JPEG, bytes.len() as u64)?;
        let output = if header.channels == Channels::Grey { ColorSpace::Luma } else { ColorSpace::RGB };
        decoder.set_options(options().jpeg_set_out_colorspace(output));
        let mut samples = pool.take(header.width * header.height * header.channels.count());
        decoder.decode_into(&mut samples).map_err(|error| IoError::damaged(path, FORMAT, reason(&error)))?;
        whole_image(path, header, Samples::U8(samples))
    }

    fn encode(
        &self,
        path: &Path,
        output: Sink<'_>,
        image: &EncodedImage,
        options: &WriteOptions,
    ) -> Result<(), IoError> {
        writer::write(output, Picture::Held(image), options).map_err(|error| IoError::write(path, error))
    }

    fn encode_rows(
        &self,
        path: &Path,
        output: Sink<'_>,
        rows: MadeRows<'_>,
        options: &WriteOptions,
    ) -> Result<(), IoError> {
        writer::write(output, Picture::Made(rows), options).map_err(|error| IoError::write(path, error))
    }
}

/// Returns the metadata of the file, except its colours.
fn metadata<T: ZByteReaderTrait>(decoder: &JpegDecoder<T>, size: (usize, usize)) -> Metadata {
    let mut carried = Carried::default();
    let exif = decoder.exif().and_then(|block| carried.add_exif(block).err()).map(|reason| ("Exif", reason));
    let xmp = decoder.xmp().and_then(|packet| carried.add_xmp(packet).err()).map(|reason| ("XMP", reason));
    let left_out = |(kind, reason)| format!("its {kind} metadata are left out: {reason}");
    carried.unread.extend(decoder.iptc().map(|block| iptc::kind(block)));
    let orientation = carried.exif.as_ref().and_then(Exif::orientation);
    let software = carried.exif.as_ref().and_then(Exif::software);
    let size = orientation::turned(size, orientation);
    let said = decoder.xmp().map(|packet| gpano::parse(packet, size)).unwrap_or_default();
    Metadata {
        panorama: said.window,
        pose: said.pose,
        complaints: exif.into_iter().chain(xmp).map(left_out).chain(said.complaints).collect(),
        orientation,
        carried: Arc::new(carried),
        ..Metadata::by(software)
    }
}

fn whole(path: &Path, source: Source<'_>) -> Result<Vec<u8>, IoError> {
    let mut bytes = Vec::new();
    source.read_to_end(&mut bytes).map_err(|error| IoError::open(path, error))?;
    Ok(bytes)
}

/// Describes the pictures that a file lists beside its own.
fn unread(listed: u32) -> Option<String> {
    let what = match listed {
        0 => return None,
        1 => "another picture".to_owned(),
        count => format!("{count} other pictures"),
    };
    Some(format!("it lists {what}, such as a preview or a gain map, behind its own; they are not read"))
}

fn options() -> DecoderOptions {
    // Strict, since otherwise the rest of a truncated file would be grey. Sizes are checked against our own limits.
    DecoderOptions::default().set_strict_mode(true).set_max_width(usize::MAX).set_max_height(usize::MAX)
}

fn decoder<T: ZByteReaderTrait>(path: &Path, source: T) -> Result<JpegDecoder<T>, IoError> {
    let mut decoder = JpegDecoder::new_with_options(source, options());
    decoder.decode_headers().map_err(|error| IoError::damaged(path, FORMAT, reason(&error)))?;
    Ok(decoder)
}

/// Returns the first line of the decoder's message, which may have many.
fn reason(error: &zune_jpeg::errors::DecodeErrors) -> String {
    let text = format!("{error:?}");
    text.lines().next().unwrap_or_default().trim().to_owned()
}

fn header<T: ZByteReaderTrait>(path: &Path, decoder: &mut JpegDecoder<T>, beside: Beside) -> Result<Header, IoError> {
    let (Some((width, height)), Some(colour)) = (decoder.dimensions(), decoder.input_colorspace()) else {
        return Err(IoError::damaged(path, FORMAT, "it has no size"));
    };
    let channels = match colour {
        ColorSpace::Luma => Channels::Grey,
        ColorSpace::RGB | ColorSpace::YCbCr => Channels::Rgb,
        other => return Err(IoError::unsupported(path, FORMAT, format_args!("{other:?} colours"), "grey or RGB")),
    };
    let own = metadata(decoder, (width, height));
    let metadata = match decoder.icc_profile() {
        None if beside.has_profile => own.with_damaged_profile("a part of it is missing or there twice"),
        None if own.carried.exif.as_ref().is_some_and(Exif::is_adobe_rgb) => {
            Metadata { primaries: Some(Primaries::ADOBE_RGB), transfer: Some(Transfer::Gamma(ADOBE_GAMMA)), ..own }
        }
        profile => own.with_profile(profile),
    };
    Ok(Header { format: FORMAT, width, height, channels, depth: Depth::Eight, metadata, window: None })
}
