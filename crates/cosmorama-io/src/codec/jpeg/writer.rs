use std::cell::RefCell;
use std::io::{self, Write};

use cosmorama::raster::{Channels, Depth, EncodedImage, Samples};
use image::codecs::jpeg::JpegEncoder;
use image::{ExtendedColorType, GenericImageView, ImageEncoder, ImageError, Luma, Pixel, Rgb};

use crate::codec::interface::Sink;
use crate::header::Picture;
use crate::{Exif, MadeRows, Metadata, WriteOptions};

/// Rows of a square, whose pixels are encoded together.
const SQUARE: usize = 8;

/// Writes a picture of 8 bits without alpha.
pub(super) fn write(output: Sink<'_>, picture: Picture<'_, '_>, options: &WriteOptions) -> io::Result<()> {
    let (size, channels) = (picture.size(), picture.channels());
    let (Ok(width), Ok(height)) = (u16::try_from(size.0), u16::try_from(size.1)) else {
        return Err(io::Error::other("more than 65535 pixels on a side, the most that JPEG can count"));
    };
    let failed = RefCell::new(None);
    let file = Spliced { output, start: Vec::new(), beside: Some(beside(&options.metadata, size)), failed: &failed };
    let mut encoder = JpegEncoder::new_with_quality(file, options.quality.clamp(1, 100));
    if let Some(profile) = options.metadata.profile_to_write(channels, Depth::Eight) {
        encoder.set_icc_profile(profile.into_owned()).map_err(io::Error::other)?;
    }
    let is_grey = channels == Channels::Grey;
    let encoded = match picture {
        Picture::Held(image) => {
            let colour = if is_grey { ExtendedColorType::L8 } else { ExtendedColorType::Rgb8 };
            encoder.write_image(codes(image)?, width.into(), height.into(), colour)
        }
        Picture::Made(rows) if is_grey => encoder.encode_image(&Pixels::of(rows, &failed, |code| Luma([code[0]]))),
        Picture::Made(rows) => {
            encoder.encode_image(&Pixels::of(rows, &failed, |codes| Rgb([codes[0], codes[1], codes[2]])))
        }
    };
    failed.take().map_or(Ok(()), Err)?;
    encoded.map_err(|error| match error {
        ImageError::IoError(error) => error,
        error => io::Error::other(error),
    })
}

/// Returns the codes of a picture that the format can hold.
fn codes(image: &EncodedImage) -> io::Result<&[u8]> {
    match (image.samples(), image.channels()) {
        (Samples::U8(codes), Channels::Grey | Channels::Rgb) => Ok(codes),
        (Samples::U8(_), _) => Err(io::Error::other("JPEG has no alpha")),
        _ => Err(io::Error::other("JPEG has 8 bits")),
    }
}

/// Pixels of a picture whose rows are made as the encoder comes to them. It looks at each pixel once, square by square, from above.
struct Pixels<'a, 'f, P> {
    size: (u32, u32),
    made: RefCell<Made<'a>>,
    /// Error that ended the making. All pixels after it are black, and the file takes no more.
    failed: &'f RefCell<Option<io::Error>>,
    /// Makes a pixel of its codes.
    pixel: fn(&[u8]) -> P,
}

/// Rows of a picture, and those of them that are there.
struct Made<'a> {
    rows: MadeRows<'a>,
    codes: Vec<u8>,
    /// First of those that are there, and the one behind the last.
    top: usize,
    bottom: usize,
}

impl<'a, 'f, P> Pixels<'a, 'f, P> {
    fn of(rows: MadeRows<'a>, failed: &'f RefCell<Option<io::Error>>, pixel: fn(&[u8]) -> P) -> Self {
        let size = (rows.size.0 as u32, rows.size.1 as u32);
        Self { size, made: RefCell::new(Made { rows, codes: Vec::new(), top: 0, bottom: 0 }), failed, pixel }
    }
}

impl<P: Pixel> GenericImageView for Pixels<'_, '_, P> {
    type Pixel = P;

    fn dimensions(&self) -> (u32, u32) {
        self.size
    }

    fn get_pixel(&self, x: u32, y: u32) -> P {
        let made = &mut *self.made.borrow_mut();
        let (column, row) = (x as usize, y as usize);
        if row >= made.bottom
            && let Err(error) = made.go_on()
        {
            self.failed.borrow_mut().get_or_insert(error);
        }
        let place = ((row - made.top) * made.rows.size.0 + column) * made.rows.channels.count();
        (self.pixel)(&made.codes[place..])
    }
}

impl Made<'_> {
    /// Makes the next rows: whole squares. If that fails, they are black.
    fn go_on(&mut self) -> io::Result<()> {
        let (width, height) = self.rows.size;
        let count = (self.rows.at_once / SQUARE).max(1) * SQUARE;
        (self.top, self.bottom) = (self.bottom, height.min(self.bottom + count));
        self.codes = Vec::new();
        let made = self.rows.part(self.top..self.bottom).and_then(|part| codes(&part).map(<[u8]>::to_vec));
        let black = || vec![0; (self.bottom - self.top) * width * self.rows.channels.count()];
        let (codes, failed) = made.map_or_else(|error| (black(), Err(error)), |codes| (codes, Ok(())));
        self.codes = codes;
        failed
    }
}

/// A file into which metadata go that the encoder does not know, behind the JFIF segment, which must come first.
struct Spliced<'o, 'f> {
    output: Sink<'o>,
    /// Bytes so far, until those of the JFIF segment are there.
    start: Vec<u8>,
    /// Metadata; `None` when they are written.
    beside: Option<Vec<u8>>,
    /// Error that ended the picture: the file takes no more.
    failed: &'f RefCell<Option<io::Error>>,
}

impl Write for Spliced<'_, '_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.failed.borrow().is_some() {
            return Err(io::Error::other("its rows were not made"));
        }
        let Some(beside) = &self.beside else {
            self.output.write_all(bytes)?;
            return Ok(bytes.len());
        };
        self.start.extend_from_slice(bytes);
        if let Some((jfif, rest)) = end_of_jfif(&self.start).and_then(|end| self.start.split_at_checked(end)) {
            [jfif, beside, rest].iter().try_for_each(|part| self.output.write_all(part))?;
            self.beside = None;
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.output.flush()
    }
}

/// Returns the end of the start mark and of the JFIF segment, as far as their bytes tell.
fn end_of_jfif(bytes: &[u8]) -> Option<usize> {
    match bytes {
        [_, _, 0xff, 0xe0, high, low, ..] => Some(4 + usize::from(u16::from_be_bytes([*high, *low]))),
        [_, _, _, _, ..] if bytes[2..4] != [0xff, 0xe0] => Some(2),
        _ => None,
    }
}

/// Returns the segments of metadata beside the picture's colours.
fn beside(metadata: &Metadata, size: (usize, usize)) -> Vec<u8> {
    let exif = metadata.carried.exif.clone().or_else(|| metadata.origin.as_ref().map(|_| Exif::empty()));
    let exif = exif.and_then(|exif| exif.block_to_write(size, metadata));
    let exif = exif.map_or_else(Vec::new, |block| segment(b"Exif\0\0", &block));
    let packet = metadata.packet_to_write(size);
    let packet = packet.map_or_else(Vec::new, |packet| segment(b"http://ns.adobe.com/xap/1.0/\0", packet.as_bytes()));
    [exif, packet, comment(metadata)].concat()
}

/// Returns a segment of an application, which the encoder cannot write itself. One that is too long, which
/// [`crate::Carried::kept`] leaves out, is empty.
fn segment(name: &[u8], content: &[u8]) -> Vec<u8> {
    let Ok(length) = u16::try_from(2 + name.len() + content.len()) else { return Vec::new() };
    [&[0xff, 0xe1], &length.to_be_bytes()[..], name, content].concat()
}

/// Returns the comment that says what the program states about the pixels; empty if that is nothing.
fn comment(metadata: &Metadata) -> Vec<u8> {
    let remarks = metadata.remarks.iter().map(|remark| format!("{}: {}", remark.name, remark.text));
    let text = remarks.collect::<Vec<_>>().join("; ");
    match u16::try_from(2 + text.len()) {
        Ok(length) if length > 2 => [&[0xff, 0xfe], &length.to_be_bytes()[..], text.as_bytes()].concat(),
        _ => Vec::new(),
    }
}
