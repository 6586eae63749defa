//! Texts in the chunks of PNG files.

use std::io::Read;

use flate2::read::ZlibDecoder;

/// A chunk of text in a PNG: `tEXt`, `zTXt` or `iTXt`, as the file has it.
#[derive(Clone, Debug, PartialEq)]
pub struct TextChunk {
    /// Type of the chunk.
    pub(crate) kind: [u8; 4],
    /// Content of the chunk.
    pub(crate) data: Vec<u8>,
}

/// Keyword of an XMP packet.
pub(crate) const XMP: &str = "XML:com.adobe.xmp";

/// Exif as ImageMagick repeats it among texts, where it is not true of another picture.
const UNTRUE: [&str; 4] =
    ["exif:FocalLengthIn35mmFilm", "exif:DigitalZoomRatio", "exif:GPSImgDirection", "exif:GPSImgDirectionRef"];

/// Greatest length of a text in bytes, once unpacked.
const LONGEST: u64 = 1 << 20;

impl TextChunk {
    /// Returns the text's keyword, such as `Author`.
    pub fn keyword(&self) -> String {
        latin(self.data.split(|byte| *byte == 0).next().unwrap_or_default())
    }

    /// Returns the text; `None` if it is damaged or longer than a megabyte.
    pub fn text(&self) -> Option<String> {
        let (_, rest) = split(&self.data)?;
        match (&self.kind, rest) {
            (b"tEXt", text) => Some(latin(text)),
            (b"zTXt", [0, packed @ ..]) => unpacked(packed).map(|text| latin(&text)),
            (b"iTXt", [is_packed, 0, rest @ ..]) => {
                let (_language, rest) = split(rest)?;
                let (_keyword, text) = split(rest)?;
                let text = if *is_packed == 0 { text.to_vec() } else { unpacked(text)? };
                String::from_utf8(text).ok()
            }
            _ => None,
        }
    }

    /// Returns whether the text is about the input's file alone: which program wrote it.
    pub(super) fn is_rewritten(&self) -> bool {
        self.keyword() == "Software"
    }

    /// Returns the kind and the bytes of metadata in ImageMagick's old form: a name, a length, and hexadecimal digits.
    pub(crate) fn raw_profile(&self) -> Option<(String, Vec<u8>)> {
        let kind = self.keyword().strip_prefix("Raw profile type ")?.to_ascii_lowercase();
        let text = self.text()?;
        let mut words = text.split_ascii_whitespace().skip(1);
        let length: usize = words.next()?.parse().ok()?;
        let digits: Vec<u8> = words.flat_map(str::bytes).collect();
        let byte = |pair: &[u8]| u8::from_str_radix(std::str::from_utf8(pair).ok()?, 16).ok();
        let bytes: Vec<u8> = digits.chunks_exact(2).map(byte).collect::<Option<_>>()?;
        (bytes.len() == length).then_some((kind, bytes))
    }

    /// Returns whether the text is about the input's pixels: previews, and damaged metadata in ImageMagick's old form.
    pub(super) fn is_untrue(&self) -> bool {
        let keyword = self.keyword();
        ["Raw profile type ", "Thumb::", "png:"].iter().any(|start| keyword.starts_with(start))
            || UNTRUE.contains(&&*keyword)
    }
}

/// Splits bytes at the first zero, which belongs to neither part.
fn split(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let at = bytes.iter().position(|byte| *byte == 0)?;
    Some((&bytes[..at], &bytes[at + 1..]))
}

/// Reads Latin-1.
fn latin(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| char::from(*byte)).collect()
}

fn unpacked(packed: &[u8]) -> Option<Vec<u8>> {
    let mut text = Vec::new();
    ZlibDecoder::new(packed).take(LONGEST + 1).read_to_end(&mut text).ok()?;
    (text.len() as u64 <= LONGEST).then_some(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn profile(keyword: &str, text: &str) -> Option<(String, Vec<u8>)> {
        TextChunk { kind: *b"tEXt", data: format!("Raw profile type {keyword}\0{text}").into_bytes() }.raw_profile()
    }

    #[test]
    fn metadata_in_imagemagicks_old_form_are_read() {
        assert_eq!(profile("APP1", "\ngeneric profile\n"), None);
        assert_eq!(profile("xmp", "\nxmp\n       3\n3c783e\n"), Some(("xmp".to_owned(), b"<x>".to_vec())));
        // A wrong length, and what are no digits.
        assert_eq!(profile("xmp", "\nxmp\n       4\n3c783e\n"), None);
        assert_eq!(profile("xmp", "\nxmp\n       3\n3c7\u{e9}e\n"), None);
    }
}
