//! Where a TIFF file ends, and how many others lie behind it.

use std::io::{self, Read, SeekFrom};

use crate::codec::behind::skip_padding;
use crate::codec::interface::Source;

/// Tags of the places of strips and tiles, each with that of their sizes.
const PLACES: [(u16, u16); 2] = [(273, 279), (324, 325)];

/// Greatest number of pages that are followed; their links may form a circle.
const MOST_PAGES: usize = 1 << 16;

/// Counts the files that lie behind the first one. Bytes that begin no file are harmless padding.
pub(super) fn count_behind(source: Source<'_>) -> io::Result<usize> {
    let (mut count, mut first) = (0, 0);
    while let Some(end) = end(source, first)? {
        source.seek(SeekFrom::Start(end))?;
        first = skip_padding(source)?;
        count += 1;
    }
    Ok(usize::saturating_sub(count, 1))
}

/// Finds the end of a file of 32-bit offsets that begins at `first`: the end of everything that its pages refer to.
/// `None` if no such file begins there.
fn end(source: Source<'_>, first: u64) -> io::Result<Option<u64>> {
    let mut file = Extent { source, first, is_little: true, end: 8 };
    let Some(mut page) = file.start()? else { return Ok(None) };
    for number in 0..MOST_PAGES {
        match file.page(page)? {
            None if number == 0 => return Ok(None),
            None | Some(0) => break,
            Some(next) => page = next,
        }
    }
    Ok(Some(first + file.end))
}

/// A file whose pages are followed. Places are relative to its first byte.
struct Extent<'a> {
    source: Source<'a>,
    first: u64,
    is_little: bool,
    end: u64,
}

/// An entry of a page: a tag, the bytes of each of its values, and where these lie.
struct Entry {
    tag: u16,
    width: u64,
    count: u64,
    at: u64,
}

impl Extent<'_> {
    /// Reads the beginning, and returns the place of the first page; `None` if this is not a TIFF file.
    fn start(&mut self) -> io::Result<Option<u64>> {
        let start = self.bytes(0, 8)?;
        self.is_little = start.starts_with(b"II");
        let is_tiff = start.len() == 8 && [&b"II*\0"[..], b"MM\0*"].contains(&&start[..4]);
        Ok(is_tiff.then(|| self.number(&start[4..])))
    }

    /// Reads a page, and returns the place of the next; `None` if there is no page here.
    fn page(&mut self, at: u64) -> io::Result<Option<u64>> {
        let count = self.bytes(at, 2)?;
        let length = 12 * self.number(&count);
        let bytes = self.bytes(at + 2, length + 4)?;
        if length == 0 || bytes.len() as u64 != length + 4 {
            return Ok(None);
        }
        self.reach(at + 2 + length + 4);
        let (entries, next) = bytes.split_at(length as usize);
        let entries: Vec<Entry> =
            entries.chunks_exact(12).zip(0..).map(|(entry, k)| self.entry(entry, at + 2 + 12 * k)).collect();
        for entry in &entries {
            self.reach(entry.at + entry.width * entry.count);
        }
        for (places, sizes) in PLACES {
            for (place, size) in self.values(&entries, places)?.into_iter().zip(self.values(&entries, sizes)?) {
                self.reach(place + size);
            }
        }
        Ok(Some(self.number(next)))
    }

    fn entry(&self, bytes: &[u8], at: u64) -> Entry {
        let number = |from: usize, to: usize| self.number(&bytes[from..to]);
        let width = match number(2, 4) {
            3 | 8 => 2,
            4 | 9 | 11 | 13 => 4,
            5 | 10 | 12 => 8,
            _ => 1,
        };
        let count = number(4, 8);
        // Values of up to four bytes lie in the entry itself.
        let at = if width * count <= 4 { at + 8 } else { number(8, 12) };
        Entry { tag: number(0, 2) as u16, width, count, at }
    }

    /// Reads the values of an entry; none where it is missing.
    fn values(&mut self, entries: &[Entry], tag: u16) -> io::Result<Vec<u64>> {
        let Some(&Entry { width, count, at, .. }) = entries.iter().find(|entry| entry.tag == tag) else {
            return Ok(Vec::new());
        };
        let bytes = self.bytes(at, width * count)?;
        Ok(bytes.chunks_exact(width as usize).map(|value| self.number(value)).collect())
    }

    /// Notes that the file reaches to a place.
    fn reach(&mut self, place: u64) {
        self.end = self.end.max(place);
    }

    fn bytes(&mut self, at: u64, count: u64) -> io::Result<Vec<u8>> {
        self.source.seek(SeekFrom::Start(self.first + at))?;
        // Only as many bytes as exist are read: a damaged file may declare any size.
        let mut bytes = Vec::new();
        (&mut *self.source).take(count).read_to_end(&mut bytes)?;
        Ok(bytes)
    }

    fn number(&self, bytes: &[u8]) -> u64 {
        let join = |number: u64, byte: &u8| number << 8 | u64::from(*byte);
        if self.is_little { bytes.iter().rev().fold(0, join) } else { bytes.iter().fold(0, join) }
    }
}
