//! Index of an AVI: it tells which places for frames are empty, where the frame before is shown on.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::Path;

/// Name of AVI, as ffprobe says it.
pub(crate) const AVI: &str = "avi";

/// Chunks before the index that are passed over at most.
const MOST_CHUNKS: usize = 1 << 10;

/// Entries of the index that are read at most: ten days of frames and sound.
const MOST_ENTRIES: u32 = 1 << 26;

/// Places for a stream's frames, in order, as the index tells them.
#[derive(Debug, Default)]
pub(crate) struct Places {
    is_empty: Vec<bool>,
}

impl Places {
    /// Reads the index of a file. Without one, and behind its end (the first gigabyte, where there is more than one `RIFF`), no place is
    /// known to be empty.
    pub(crate) fn read(path: &Path, stream: u32) -> Self {
        let is_empty = File::open(path).ok().and_then(|file| entries(BufReader::new(file), stream));
        Self { is_empty: is_empty.unwrap_or_default() }
    }

    /// Counts the places that are not empty.
    pub(crate) fn filled(&self) -> u64 {
        self.is_empty.iter().filter(|is_empty| !**is_empty).count() as u64
    }

    /// Counts the empty places before a time, in ticks.
    pub(crate) fn empty_before(&self, time: i64) -> u64 {
        let count = usize::try_from(time).unwrap_or(0);
        self.is_empty.iter().take(count).filter(|is_empty| **is_empty).count() as u64
    }

    /// Returns whether a frame of this time is a place that is left empty. A tick is a place; decoders that keep frames back give times that
    /// are later by so many.
    pub(crate) fn is_empty(&self, time: i64, delay: u64) -> bool {
        let Ok(place) = usize::try_from(time) else { return false };
        let delay = usize::try_from(delay).unwrap_or(usize::MAX);
        let around = self.is_empty.get(place.saturating_sub(delay)..=place);
        around.is_some_and(|around| around.contains(&true))
    }
}

/// Reads the entries of a stream's frames in the index `idx1` (Microsoft, AVI RIFF File Reference); `None` where there is none.
fn entries(mut file: impl Read + Seek, stream: u32) -> Option<Vec<bool>> {
    let mut head = [0; 12];
    file.read_exact(&mut head).ok()?;
    if !(head.starts_with(b"RIFF") && head.ends_with(b"AVI ")) {
        return None;
    }
    for _ in 0..MOST_CHUNKS {
        let mut head = [0; 8];
        file.read_exact(&mut head).ok()?;
        let [name @ .., a, b, c, d] = head;
        let size = u32::from_le_bytes([a, b, c, d]);
        if name != *b"idx1" {
            file.seek(SeekFrom::Current(i64::from(size) + i64::from(size % 2))).ok()?;
            continue;
        }
        let mut found = Vec::new();
        for _ in 0..(size / 16).min(MOST_ENTRIES) {
            let mut entry = [0; 16];
            file.read_exact(&mut entry).ok()?;
            let name = str::from_utf8(&entry[..4]).unwrap_or_default();
            let is_frame =
                matches!(name.split_at_checked(2), Some((number, "dc" | "db")) if number.parse() == Ok(stream));
            found.extend(is_frame.then_some(entry.ends_with(&[0; 4])));
        }
        return Some(found);
    }
    None
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    fn file(entries: &[(&[u8; 4], u32)]) -> Vec<u8> {
        let mut bytes =
            [&b"RIFF\0\0\0\0AVI LIST\x05\0\0\0movi.\0idx1"[..], &(entries.len() as u32 * 16).to_le_bytes()].concat();
        for (name, size) in entries {
            bytes.extend([&name[..], &[0; 8], &size.to_le_bytes()].concat());
        }
        bytes
    }

    #[test]
    fn places_are_empty_as_the_index_tells() {
        let entries = |stream, list: &[(&[u8; 4], u32)]| super::entries(Cursor::new(file(list)), stream);
        let list: [(&[u8; 4], u32); 5] = [(b"00dc", 9), (b"01wb", 0), (b"00dc", 0), (b"01dc", 7), (b"00db", 300)];
        assert_eq!(entries(0, &list), Some(vec![false, true, false]));
        assert_eq!(entries(1, &list), Some(vec![false]));
        assert_eq!(entries(2, &list), Some(Vec::new()));
        let bytes = file(&list);
        for length in 0..bytes.len() {
            assert_eq!(super::entries(Cursor::new(&bytes[..length]), 0), None, "{length} bytes");
        }
    }

    #[test]
    fn what_the_index_does_not_tell_is_not_empty() {
        let places = Places { is_empty: vec![false, true, false, false] };
        assert_eq!((places.filled(), [-1, 1, 2, 9].map(|time| places.empty_before(time))), (3, [0, 0, 1, 1]));
        assert_eq!([-1, 0, 1, 2, 3, 4].map(|time| places.is_empty(time, 0)), [false, false, true, false, false, false]);
        assert_eq!([0, 1, 2, 3].map(|time| places.is_empty(time, 1)), [false, true, true, false]);
    }
}
