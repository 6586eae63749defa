//! Strips and tiles in JPEG, which say their own size.

use std::io::{self, Cursor, Read, Seek, SeekFrom};
use std::path::Path;

use tiff::decoder::Decoder;
use tiff::tags::Tag;

use super::reader::{FORMAT, damaged};
use crate::IoError;
use crate::codec::interface::Source;

/// Side of the largest square in which colours are coded: some writers fill them up.
const SQUARE: u32 = 16;

/// Segments that are looked at before a frame.
const SEGMENTS: usize = 64;

/// Refuses strips and tiles that say they are larger than the file says they are: the decoder would take memory for them. Damage of
/// other kinds is left for the decoder to report.
pub(super) fn check(path: &Path, decoder: &mut Decoder<Source<'_>>, height: u32) -> Result<(), IoError> {
    let (columns, rows) = decoder.chunk_dimensions();
    let [across, down] = [columns, rows.min(height)].map(|side| side.checked_next_multiple_of(SQUARE).unwrap_or(side));
    let refuse = |(width, height): (u32, u32)| {
        let reason = format_args!("a part of {columns}x{rows} pixels in JPEG says that it has {width}x{height}");
        Err(IoError::damaged(path, FORMAT, reason))
    };
    let is_larger = |(width, height): &(u32, u32)| *width > across || *height > down;
    let tables = decoder.get_tag_u8_vec(Tag::JPEGTables).ok();
    if let Some(size) = tables.and_then(|tables| size(&mut Cursor::new(tables)).ok().flatten()).filter(is_larger) {
        return refuse(size);
    }
    let tags = [Tag::StripOffsets, Tag::TileOffsets];
    let offsets = tags.into_iter().find_map(|tag| decoder.find_tag_unsigned_vec::<u64>(tag).ok().flatten());
    let source = decoder.inner();
    let place = source.stream_position().map_err(|error| damaged(path, &error.into()))?;
    for offset in offsets.into_iter().flatten() {
        let found = source.seek(SeekFrom::Start(offset)).and_then(|_| size(source));
        if let Some(size) = found.ok().flatten().filter(is_larger) {
            return refuse(size);
        }
    }
    source.seek(SeekFrom::Start(place)).map_err(|error| damaged(path, &error.into()))?;
    Ok(())
}

/// Returns width and height as a frame's segment has them; `None` where there is none.
fn size(source: &mut (impl Read + Seek + ?Sized)) -> io::Result<Option<(u32, u32)>> {
    let mut start = [0; 2];
    source.read_exact(&mut start)?;
    for _ in 0..SEGMENTS {
        let mut segment = [0; 4];
        source.read_exact(&mut segment)?;
        let [0xff, mark, high, low] = segment else { return Ok(None) };
        let is_frame = (0xc0..=0xcf).contains(&mark) && ![0xc4, 0xc8, 0xcc].contains(&mark);
        if is_frame {
            let mut frame = [0; 5];
            source.read_exact(&mut frame)?;
            let [_, height @ .., a, b] = frame;
            return Ok(Some((u16::from_be_bytes([a, b]).into(), u16::from_be_bytes(height).into())));
        }
        source.seek_relative(i64::from(u16::from_be_bytes([high, low]).saturating_sub(2)))?;
    }
    Ok(None)
}
