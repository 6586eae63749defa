//! Codecs: a file or a folder for each format, and the table that finds the codec of a format.
//!
//! To add a format: a variant of [`Format`] with its properties, a type that implements [`Codec`], its line in [`built`], and its
//! mark in [`Format::is_start`].
//!
//! A format whose decoder is heavy has a feature of the manifest. Here, and nowhere else, features take codecs out.

pub(crate) mod behind;
#[cfg(feature = "exr")]
mod exr;
mod interface;
#[cfg(feature = "jpeg")]
mod jpeg;
mod png;
mod radiance;
#[cfg(feature = "diagrams")]
pub mod svg;
#[cfg(feature = "textures")]
mod texture;
mod tga;
#[cfg(feature = "tiff")]
mod tiff;
mod write_options;

use std::io::Read;
use std::path::Path;

pub use interface::ReadSeek;
pub use interface::is_contained;
pub(crate) use interface::{Codec, Source, contained, is_beside_others};
pub use write_options::{Compression, WriteOptions};

use crate::header::Format;
use crate::{IoError, is_video};

/// Returns the codec of a format; `None` if this build has none.
fn built(format: Format) -> Option<&'static dyn Codec> {
    match format {
        Format::Png => Some(&png::Png),
        Format::Tga => Some(&tga::Tga),
        Format::Hdr => Some(&radiance::Hdr),
        #[cfg(feature = "jpeg")]
        Format::Jpeg => Some(&jpeg::Jpeg),
        #[cfg(feature = "tiff")]
        Format::Tiff => Some(&tiff::Tiff),
        #[cfg(feature = "exr")]
        Format::Exr => Some(&exr::Exr),
        #[cfg(feature = "textures")]
        Format::Ktx2 => Some(&texture::Ktx2),
        #[cfg(feature = "textures")]
        Format::Ktx => Some(&texture::Ktx),
        #[cfg(feature = "textures")]
        Format::Dds => Some(&texture::Dds),
        Format::Video | Format::Pfm => Some(&interface::Elsewhere),
        #[allow(unreachable_patterns, reason = "with all features, no format is left")]
        _ => None,
    }
}

/// Returns the codec of a file's format.
pub(crate) fn codec(path: &Path, format: Format) -> Result<&'static dyn Codec, IoError> {
    built(format).ok_or_else(|| IoError::NotBuilt { path: path.to_owned(), format })
}

/// Number of bytes at the start of a file that identify its format.
const START: u64 = 16;

/// Finds the format of a file by its first bytes, which are not consumed.
pub(crate) fn recognise(path: &Path, source: Source<'_>) -> Result<Format, IoError> {
    let mut start = Vec::with_capacity(START as usize);
    let mut begin = || {
        source.rewind()?;
        (&mut *source).take(START).read_to_end(&mut start)?;
        source.rewind()
    };
    begin().map_err(|error| IoError::open(path, error))?;
    if start.is_empty() {
        return Err(IoError::Empty { path: path.to_owned() });
    }
    let by_mark = Format::ALL.into_iter().find(|format| format.is_start(&start));
    // TGA files begin with no mark, so that only the name tells.
    let by_name = || Format::of_name(path).filter(|format| *format == Format::Tga);
    by_mark.or_else(by_name).ok_or_else(|| {
        let path = path.to_owned();
        match video_extension(&start).filter(|_| !is_video(&path)) {
            Some(extension) => IoError::VideoContent { path, extension },
            None => IoError::UnknownContent { path },
        }
    })
}

/// Returns the extension of a video by its first bytes: MP4 and MOV by the brands of films (ISO/IEC 14496-12, MP4RA), Matroska by the
/// mark of EBML (RFC 8794), and AVI.
fn video_extension(start: &[u8]) -> Option<&'static str> {
    match start {
        [_, _, _, _, b'f', b't', b'y', b'p', brand @ ..] => match brand.first_chunk()? {
            b"qt  " => Some("mov"),
            b"mp41" | b"mp42" | b"avc1" | b"M4V " | b"dash" | [b'i', b's', b'o', _] | [b'3', b'g', b'p', _] => {
                Some("mp4")
            }
            _ => None,
        },
        [0x1a, 0x45, 0xdf, 0xa3, ..] => Some("mkv"),
        [b'R', b'I', b'F', b'F', _, _, _, _, b'A', b'V', b'I', b' ', ..] => Some("avi"),
        _ => None,
    }
}

impl Format {
    /// Returns the format in which a file is written, which its name's extension chooses.
    ///
    /// # Errors
    /// When the extension is unknown or missing, or this build lacks the format.
    pub fn from_extension(path: &Path) -> Result<Self, IoError> {
        let format = Self::of_name(path).ok_or_else(|| IoError::UnknownExtension { path: path.to_owned() })?;
        codec(path, format).map(|_| format)
    }

    /// Returns the format that a file name's extension says, whether this build has it or not.
    pub fn of_name(path: &Path) -> Option<Self> {
        Self::of_extension(path.extension()?.to_str()?)
    }

    /// Returns whether this build reads and writes the format. Those with a [`feature`](Self::feature) can be left out.
    pub fn is_built(self) -> bool {
        built(self).is_some()
    }

    /// Returns whether the first bytes of a file identify this format.
    fn is_start(self, start: &[u8]) -> bool {
        match self {
            Self::Png => start.starts_with(b"\x89PNG"),
            Self::Jpeg => start.starts_with(&[0xff, 0xd8, 0xff]),
            Self::Tiff => matches!(start, [b'I', b'I', 42 | 43, 0, ..] | [b'M', b'M', 0, 42 | 43, ..]),
            Self::Hdr => start.starts_with(b"#?"),
            Self::Exr => start.starts_with(&[0x76, 0x2f, 0x31, 0x01]),
            Self::Ktx2 => start.starts_with(b"\xabKTX 20\xbb"),
            Self::Ktx => start.starts_with(b"\xabKTX 11\xbb"),
            Self::Dds => start.starts_with(b"DDS "),
            // TGA files begin with no mark, and frames of videos are no files.
            Self::Tga | Self::Video | Self::Pfm => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_video_that_has_the_name_of_a_picture_is_told() {
        let told = |start: &[u8], name: &str| {
            let recognised = recognise(Path::new(name), &mut std::io::Cursor::new(start));
            recognised.map_err(|error| error.to_string()).unwrap_err()
        };
        for (start, extension) in [
            (&b"\0\0\0\x20ftypisom\0\0\x02\0"[..], ".mp4"),
            (b"\0\0\0\x14ftypqt  \0\0\x02\0", ".mov"),
            (b"\x1a\x45\xdf\xa3\xa3\x42\x86", ".mkv"),
            (b"RIFF\x10\0\0\0AVI LIST", ".avi"),
        ] {
            assert!(told(start, "a.png").ends_with(&format!("whose name ends with {extension}")), "{extension}");
            assert!(told(start, "a.mp4").contains("take it apart"));
        }
        for start in [&b"\0\0\0\x20ftypavif\0\0\0\0"[..], b"\0\0\0\x20ftyp", b"RIFF\x10\0\0\0WEBPVP8 "] {
            assert!(told(start, "a.png").contains("not an image of a known format"));
        }
    }

    /// Checks both kinds of build: one without a feature names it, for files to read and to write, and one with it does neither.
    #[test]
    fn a_format_that_is_left_out_names_its_feature() {
        let starts: [(Format, &[u8]); 6] = [
            (Format::Jpeg, &[0xff, 0xd8, 0xff, 0xe0]),
            (Format::Tiff, b"II\x2a\0\x08\0\0\0"),
            (Format::Exr, b"\x76\x2f\x31\x01\x02\0\0\0"),
            (Format::Ktx2, b"\xabKTX 20\xbb\r\n\x1a\n"),
            (Format::Ktx, b"\xabKTX 11\xbb\r\n\x1a\n"),
            (Format::Dds, b"DDS \x7c\0\0\0"),
        ];
        for (format, start) in starts {
            let feature = format.feature().expect("its decoder is heavy");
            let told = format!("this build has no {format}; it was made without the feature `{feature}`");
            let read = crate::probe_from(std::io::Cursor::new(start), "a.bin").expect_err("a start alone").to_string();
            let name = format!("a.{}", format.own_extensions().first().unwrap_or(&"ktx"));
            let named = Format::from_extension(Path::new(&name));
            if format.is_built() {
                assert!(!read.contains("feature") && named.is_ok(), "{read}");
            } else {
                let written = named.expect_err("left out").to_string();
                assert!(read.contains(&told) && written.contains(&told), "{read}; {written}");
                assert!(!Format::extensions().split(", ").any(|extension| name.ends_with(&format!(".{extension}"))));
            }
        }
        assert!([Format::Png, Format::Tga, Format::Hdr].into_iter().all(Format::is_built));
    }
}
