//! Chunks of a PNG that describe neither its pixels nor their colours: texts, Exif and XMP. They lie before the pixels
//! or behind them.

use std::io::{self, SeekFrom};

use png::chunk::{ChunkType, eXIf, tEXt};
use png::{EncodingError, Writer};

use super::reader::MARK;
use crate::codec::behind::next_bytes;
use crate::codec::interface::Source;
use crate::metadata::{LARGEST_EXIF, XMP, iptc};
use crate::{Carried, Metadata, TextChunk};

/// Content of the chunks, and complaints about content that is left out.
#[derive(Default)]
pub(super) struct Found {
    pub(super) carried: Carried,
    /// XMP packet as it is stored.
    pub(super) packet: Option<String>,
    pub(super) complaints: Vec<String>,
    /// Whether there is an ICC profile before the pixels, which the decoder drops in silence where it is damaged.
    pub(super) has_profile: bool,
    /// Kinds and bytes of metadata in ImageMagick's old form.
    old: Vec<(String, Vec<u8>)>,
}

/// Chunks that are never carried, with what to call them. Both speak of a whole film on the display of its makers.
const UNREAD: [(&[u8; 4], &str); 2] =
    [(b"cLLI", "the content's light level (cLLI)"), (b"mDCV", "the mastering display's colours (mDCV)")];

/// Reads the chunks, and goes back to the beginning. Damage is left for the decoder to report. Headers alone are read by it, too, so
/// that they say what the whole file says.
pub(super) fn read(source: Source<'_>) -> io::Result<Found> {
    let (mut found, mut is_behind) = (Found::default(), false);
    source.seek(SeekFrom::Start(MARK.len() as u64))?;
    while let Ok([a, b, c, d, kind @ ..]) = <[u8; 8]>::try_from(next_bytes(source, 8)?) {
        let length = u32::from_be_bytes([a, b, c, d]);
        let is_read = matches!(&kind, b"tEXt" | b"zTXt" | b"iTXt" | b"eXIf");
        found.carried.unread.extend(UNREAD.iter().filter(|(unread, _)| **unread == kind).map(|(_, name)| *name));
        let is_large = length as usize > LARGEST_EXIF;
        if is_read && is_large {
            let name = String::from_utf8_lossy(&kind);
            found
                .complaints
                .push(format!("its {name} chunk of {length} bytes is left out: more than {LARGEST_EXIF}; remove it"));
        }
        if is_read && !is_large {
            let data = next_bytes(source, length as usize)?;
            if data.len() != length as usize {
                break;
            }
            found.add(kind, data);
            source.seek_relative(4)?;
        } else {
            source.seek_relative(i64::from(length) + 4)?;
        }
        match &kind {
            b"iCCP" => found.has_profile |= !is_behind,
            b"IDAT" => is_behind = true,
            b"IEND" => break,
            _ => {}
        }
    }
    // Behind all others, since PNG's own form goes first wherever it lies.
    for (kind, bytes) in std::mem::take(&mut found.old) {
        found.add_profile(&kind, &bytes);
    }
    source.rewind()?;
    Ok(found)
}

impl Found {
    fn add(&mut self, kind: [u8; 4], data: Vec<u8>) {
        if &kind == b"eXIf" {
            self.add_exif(&data);
            return;
        }
        let chunk = TextChunk { kind, data };
        if chunk.keyword() == XMP {
            self.add_xmp(chunk.text().unwrap_or_default());
            return;
        }
        match chunk.raw_profile() {
            Some(old) => self.old.push(old),
            None => self.carried.texts.push(chunk),
        }
    }

    /// Takes metadata in ImageMagick's old form over, unless the file has them in PNG's own.
    fn add_profile(&mut self, kind: &str, bytes: &[u8]) {
        match kind {
            "exif" if self.carried.exif.is_none() => self.add_exif(bytes.strip_prefix(b"Exif\0\0").unwrap_or(bytes)),
            "xmp" if self.packet.is_none() => self.add_xmp(String::from_utf8_lossy(bytes).into_owned()),
            "exif" | "xmp" => {}
            "iptc" => self.carried.unread.push(iptc::kind(bytes)),
            _ => self.carried.unread.push("a profile in ImageMagick's old form"),
        }
    }

    fn add_exif(&mut self, block: &[u8]) {
        let added = self.carried.add_exif(block);
        self.complain("Exif", added);
    }

    fn add_xmp(&mut self, packet: String) {
        let added = self.carried.add_xmp(packet.as_bytes());
        self.complain("XMP", added);
        self.packet = Some(packet);
    }

    fn complain(&mut self, kind: &str, added: Result<(), String>) {
        self.complaints.extend(added.err().map(|reason| format!("its {kind} metadata are left out: {reason}")));
    }
}

/// Writes the chunks for a picture of this size.
pub(super) fn write(
    writer: &mut Writer<impl io::Write>,
    metadata: &Metadata,
    size: (usize, usize),
) -> Result<(), EncodingError> {
    let is_remark = |text: &TextChunk| metadata.remarks.iter().any(|remark| remark.name == text.keyword());
    for TextChunk { kind, data } in metadata.carried.texts.iter().filter(|text| !is_remark(text)) {
        writer.write_chunk(ChunkType(*kind), data)?;
    }
    if metadata.origin.is_some() {
        writer.write_chunk(tEXt, format!("Software\0{}", metadata.software_to_write()).as_bytes())?;
    }
    for remark in &metadata.remarks {
        writer.write_chunk(tEXt, format!("{}\0{}", remark.name, remark.text).as_bytes())?;
    }
    let exif = metadata.carried.exif.as_ref().and_then(|exif| exif.block_to_write(size, metadata));
    exif.map_or(Ok(()), |block| writer.write_chunk(eXIf, &block))
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    /// Returns the packet of XMP in a file with these texts.
    fn packet(texts: &[(&str, &str)]) -> Option<String> {
        let chunk = |(keyword, text): &(&str, &str)| {
            let data = [keyword.as_bytes(), b"\0", text.as_bytes()].concat();
            [&(data.len() as u32).to_be_bytes(), &b"tEXt"[..], &data, &[0; 4]].concat()
        };
        let chunks: Vec<u8> = texts.iter().flat_map(chunk).collect();
        read(&mut Cursor::new([&MARK[..], &chunks].concat())).unwrap().packet
    }

    #[test]
    fn the_old_form_stands_in_for_the_own_one_in_any_order() {
        let (own, old) = ((XMP, "own"), ("Raw profile type xmp", "\nxmp\n 3\n6f6c64\n"));
        assert_eq!(packet(&[old]).as_deref(), Some("old"));
        assert_eq!(packet(&[old, own]).as_deref(), Some("own"));
        assert_eq!(packet(&[own, old]).as_deref(), Some("own"));
    }
}
