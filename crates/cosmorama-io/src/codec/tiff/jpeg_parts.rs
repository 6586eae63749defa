//! Strips and tiles in JPEG, each of which says its own size.

use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

use tiff::decoder::Decoder;
use tiff::tags::{CompressionMethod, Tag};
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;

use super::reader::{FORMAT, damaged};
use crate::IoError;
use crate::codec::interface::{Density, Source};

/// Refuses strips and tiles that declare more pixels than their own bytes can hold, whatever the file says of their size: the decoder
/// would take memory for all of them. Other damage is left for it to report.
pub(super) fn check(path: &Path, decoder: &mut Decoder<Source<'_>>) -> Result<(), IoError> {
    let method = decoder.find_tag_unsigned::<u16>(Tag::Compression).ok().flatten();
    if method != Some(CompressionMethod::ModernJPEG.to_u16()) {
        return Ok(());
    }
    let tables = decoder.get_tag_u8_vec(Tag::JPEGTables).unwrap_or_default();
    let mut list = |tags: [Tag; 2]| {
        let found = tags.into_iter().find_map(|tag| decoder.find_tag_unsigned_vec::<u64>(tag).ok().flatten());
        found.unwrap_or_default()
    };
    let offsets = list([Tag::StripOffsets, Tag::TileOffsets]);
    let lengths = list([Tag::StripByteCounts, Tag::TileByteCounts]);
    let source = decoder.inner();
    for (offset, length) in offsets.into_iter().zip(lengths) {
        let bytes = part(source, offset, length).map_err(|error| damaged(path, &error.into()))?;
        let jpeg = joined(&tables, bytes);
        let Some(size) = size(&jpeg) else { continue };
        Density::JPEG.check(path, FORMAT, size, jpeg.len() as u64)?;
    }
    Ok(())
}

/// Returns the bytes of a strip or a tile, as far as the file has them.
fn part(source: &mut Source<'_>, offset: u64, length: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    source.seek(SeekFrom::Start(offset))?;
    source.take(length).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Puts the tables that all parts share before one of them, in the place of its first mark, and without their last one, as the decoder does.
fn joined(tables: &[u8], part: Vec<u8>) -> Vec<u8> {
    match (tables.len().checked_sub(2), part.get(2..)) {
        (Some(end @ 1..), Some(rest)) => [&tables[..end], rest].concat(),
        _ => part,
    }
}

/// Returns the columns and rows that a picture's header declares; `None` where it cannot be read.
fn size(jpeg: &[u8]) -> Option<(usize, usize)> {
    let mut decoder = JpegDecoder::new(ZCursor::new(jpeg));
    decoder.decode_headers().ok()?;
    decoder.dimensions()
}
