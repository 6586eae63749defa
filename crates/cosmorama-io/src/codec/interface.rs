use std::any::Any;
use std::cell::Cell;
use std::io::{BufRead, Seek, SeekFrom, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use cosmorama::raster::{EncodedImage, FramePool, Samples};

use crate::header::{Header, ImageFile};
use crate::{Choice, Format, IoError, LayeredImage, Limits, MadeLayers, MadeRows, Plane, WriteOptions};

/// Bytes of a file from any source: a file on disk, a slice of memory, or standard input read into memory.
///
/// Implemented by every buffered reader that can seek.
pub trait ReadSeek: BufRead + Seek {}

impl<T: BufRead + Seek + ?Sized> ReadSeek for T {}

/// Destination of a file's bytes.
pub(crate) trait WriteSeek: Write + Seek {}

impl<T: Write + Seek + ?Sized> WriteSeek for T {}

/// Reader for a decoder, positioned at the file's first byte.
pub(crate) type Source<'a> = &'a mut (dyn ReadSeek + 'a);

/// Writer for an encoder, positioned where the file's first byte goes.
pub(crate) type Sink<'a> = &'a mut (dyn WriteSeek + 'a);

/// Decoder and encoder of a file format. `path` is the file's name in messages.
pub(crate) trait Codec: Sync {
    /// Reads the header of a file, without its pixels.
    fn probe(&self, path: &Path, source: Source<'_>) -> Result<Header, IoError>;

    /// Reads a file's pixels, unless they need more memory than `limits` allow. Decoders that do not allocate
    /// themselves take the samples' memory from `pool`.
    fn decode(&self, path: &Path, source: Source<'_>, limits: &Limits, pool: &FramePool) -> Result<ImageFile, IoError>;

    /// Writes a picture whose depth and channels the format supports.
    fn encode(
        &self,
        path: &Path,
        output: Sink<'_>,
        image: &EncodedImage,
        options: &WriteOptions,
    ) -> Result<(), IoError>;

    /// Writes a picture whose rows are made meanwhile. Codecs that are not in [`Format::takes_rows`] hold all of them.
    fn encode_rows(
        &self,
        path: &Path,
        output: Sink<'_>,
        rows: MadeRows<'_>,
        options: &WriteOptions,
    ) -> Result<(), IoError> {
        let image = rows.held().map_err(|error| IoError::write(path, error))?;
        self.encode(path, output, &image, options)
    }

    /// Writes a picture and its mip levels, the largest first. Called only for formats that hold levels.
    fn encode_levels(
        &self,
        path: &Path,
        output: Sink<'_>,
        levels: &[EncodedImage],
        options: &WriteOptions,
    ) -> Result<(), IoError> {
        match levels {
            [image] => self.encode(path, output, image, options),
            _ => Err(IoError::write(path, "the format holds one picture")),
        }
    }

    /// Writes a picture that is no world. Called only for KTX 2, whose worlds are cubes.
    fn encode_flat(
        &self,
        path: &Path,
        output: Sink<'_>,
        image: &EncodedImage,
        options: &WriteOptions,
    ) -> Result<(), IoError> {
        self.encode(path, output, image, options)
    }

    /// Writes a picture with named channels beside it, or such channels alone. Called only for OpenEXR.
    fn encode_layers(
        &self,
        path: &Path,
        _output: Sink<'_>,
        _layered: LayeredImage<'_>,
        _options: &WriteOptions,
    ) -> Result<(), IoError> {
        Err(IoError::write(path, "the format names no channels"))
    }

    /// Writes a picture with named channels beside it, or such channels alone, whose rows are made meanwhile. Called only for OpenEXR.
    fn encode_layer_rows(
        &self,
        path: &Path,
        _output: Sink<'_>,
        _layers: MadeLayers<'_>,
        _options: &WriteOptions,
    ) -> Result<(), IoError> {
        Err(IoError::write(path, "the format names no channels"))
    }

    /// Reads the header of a file for the picture that a choice selects.
    fn probe_chosen(&self, path: &Path, source: Source<'_>, _choice: &Choice) -> Result<Header, IoError> {
        self.probe(path, source)
    }

    /// Reads the pixels of the picture that a choice selects.
    fn decode_chosen(
        &self,
        path: &Path,
        source: Source<'_>,
        (limits, pool): (&Limits, &FramePool),
        _choice: &Choice,
    ) -> Result<ImageFile, IoError> {
        self.decode(path, source, limits, pool)
    }

    /// Reads a file to its end, and drops its pixels by rows, strips or blocks, of which one must fit into the limits. It fails
    /// wherever `decode_chosen` fails, but for want of memory. Codecs that cannot read parts need memory for all.
    fn check_chosen(&self, path: &Path, source: Source<'_>, limits: &Limits, choice: &Choice) -> Result<(), IoError> {
        self.decode_chosen(path, source, (limits, &FramePool::default()), choice).map(drop)
    }

    /// Reads named channels beside the picture that a choice selects; formats without names have none.
    fn decode_planes(
        &self,
        path: &Path,
        _source: Source<'_>,
        _limits: &Limits,
        (_, names): (&Choice, &[&str]),
    ) -> Result<Vec<Plane>, IoError> {
        let (asked, existing) = (names.join(", "), "none by name".to_owned());
        Err(IoError::NoSuchChannel { path: path.to_owned(), asked, existing })
    }

    /// Reads the header of a file for the two channels of an st map.
    fn probe_pairs(&self, path: &Path, source: Source<'_>) -> Result<Header, IoError> {
        self.probe(path, source)
    }

    /// Reads the two channels of an st map, and possibly others with them.
    fn decode_pairs(&self, path: &Path, source: Source<'_>, limits: &Limits) -> Result<ImageFile, IoError> {
        self.decode(path, source, limits, &FramePool::default())
    }
}

/// Codec of frames of videos, which another crate reads and writes. It recognises no file, and refuses to write one.
pub(super) struct Elsewhere;

impl Elsewhere {
    fn refusal(path: &Path) -> IoError {
        IoError::unsupported(path, Format::Video, "frames of a video", "a file of one picture")
    }
}

impl Codec for Elsewhere {
    fn probe(&self, path: &Path, _: Source<'_>) -> Result<Header, IoError> {
        Err(Self::refusal(path))
    }

    fn decode(&self, path: &Path, _: Source<'_>, _: &Limits, _: &FramePool) -> Result<ImageFile, IoError> {
        Err(Self::refusal(path))
    }

    fn encode(&self, path: &Path, _: Sink<'_>, _: &EncodedImage, _: &WriteOptions) -> Result<(), IoError> {
        Err(Self::refusal(path))
    }
}

/// Returns whether this thread belongs to a thread pool. The pool's other threads then have files of their own, so one
/// thread processes all of this file.
pub(crate) fn is_beside_others() -> bool {
    rayon::current_thread_index().is_some()
}

thread_local! {
    static IS_CONTAINED: Cell<bool> = const { Cell::new(false) };
}

/// Returns whether a panic of this thread will be caught, and become an error about the file that is decoded. A panic hook then
/// need not tell of it.
pub fn is_contained() -> bool {
    IS_CONTAINED.get()
}

/// Calls a decoder. The error is a panic, which may be the fault of another's program, in words.
pub(crate) fn contained<T>(decode: impl FnOnce() -> T) -> Result<T, String> {
    let outer = IS_CONTAINED.replace(true);
    // After a panic nothing is used that the decoder has changed.
    let result = catch_unwind(AssertUnwindSafe(decode));
    IS_CONTAINED.set(outer);
    result.map_err(|payload| format!("its decoder failed: {}", words_of(&*payload)))
}

/// Returns the words of a panic.
fn words_of(payload: &(dyn Any + Send)) -> &str {
    let owned = || payload.downcast_ref::<String>().map(String::as_str);
    payload.downcast_ref::<&str>().copied().or_else(owned).unwrap_or("a panic")
}

/// Density of pixels in the bytes of a file, at most: no compression is without limits.
#[derive(Clone, Copy)]
pub(crate) struct Density {
    pixels: u64,
    /// Bytes that hold so many pixels.
    bytes: u64,
}

impl Density {
    /// Most bytes that deflate makes of one: 258 for each two bits.
    pub(crate) const DEFLATE: u64 = 1032;

    /// JPEG: squares of 8 × 8 pixels, each of at least one bit.
    pub(crate) const JPEG: Self = Self::pixels(8 * 64);

    /// Returns the density of so many pixels in each byte.
    pub(crate) const fn pixels(in_byte: u64) -> Self {
        Self { pixels: in_byte, bytes: 1 }
    }

    /// Returns the density of pixels of so many bits, where a byte of the file becomes at most so many bytes of them.
    pub(crate) const fn of_bits(pixel_bits: u64, unpacked: u64) -> Self {
        Self { pixels: 8 * unpacked, bytes: pixel_bits }
    }

    /// Refuses a size of more pixels than so many bytes can hold.
    pub(crate) fn check(
        self,
        path: &Path,
        format: Format,
        (width, height): (usize, usize),
        bytes: u64,
    ) -> Result<(), IoError> {
        let declared = (width as u128 * height as u128).saturating_mul(self.bytes.into());
        if declared <= u128::from(bytes) * u128::from(self.pixels) {
            return Ok(());
        }
        let reason = format_args!("its {bytes} bytes cannot hold {width}x{height} pixels");
        Err(IoError::damaged(path, format, reason))
    }
}

/// Returns the length of a file, and goes back to its beginning.
pub(crate) fn length(path: &Path, source: Source<'_>) -> Result<u64, IoError> {
    let length = source.seek(SeekFrom::End(0)).and_then(|length| source.rewind().map(|()| length));
    length.map_err(|error| IoError::open(path, error))
}

impl Header {
    /// Refuses a size of more pixels than a file of so many bytes can hold.
    pub(crate) fn check_density(&self, path: &Path, density: Density, bytes: u64) -> Result<(), IoError> {
        density.check(path, self.format, (self.width, self.height), bytes)
    }
}

/// Builds the image file of a header and its samples.
pub(crate) fn whole_image(path: &Path, header: Header, samples: Samples) -> Result<ImageFile, IoError> {
    let Header { format, width, height, channels, depth, metadata, window } = header;
    let image = EncodedImage::new(width, height, channels, depth, samples)
        .map_err(|error| IoError::damaged(path, format, error))?;
    Ok(ImageFile { format, image, metadata, window })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_panic_of_a_decoder_is_an_error() {
        assert_eq!(contained(|| 7), Ok(7));
        let number = 7;
        let nested = contained(|| {
            let inner = contained(|| -> u8 { panic!("no row {number}") });
            assert!(is_contained());
            inner
        });
        assert_eq!(nested, Ok(Err("its decoder failed: no row 7".to_owned())));
        assert!(!is_contained());
    }
}
