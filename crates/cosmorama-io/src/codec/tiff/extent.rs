//! What the pages of a TIFF file refer to: where the file ends, how many others lie behind it, and whether its texts can be in it.

use std::io::{self, Read, SeekFrom};

use crate::codec::behind::skip_padding;
use crate::codec::interface::Source;

/// Tags of the places of strips and tiles, each with that of their sizes.
const PLACES: [(u16, u16); 2] = [(273, 279), (324, 325)];

/// Type of texts.
const ASCII: u64 = 2;

/// Longest text of a tag in bytes.
const LONGEST_TEXT: u64 = 1 << 24;

/// Greatest number of pages that are followed, in all files together; their links may form a circle.
const MOST_PAGES: usize = 1 << 16;

/// Times that all bytes may be read. Pages lie apart, but may share lists.
const MOST_TIMES: u64 = 4;

/// Counts the files that lie behind the first one. Bytes that begin no file are harmless padding.
pub(super) fn count_behind(source: Source<'_>) -> io::Result<usize> {
    let mut pages = Pages::new(source)?;
    let (mut count, mut first) = (0, 0);
    while let Some(end) = pages.end_of_file(first)? {
        pages.source.seek(SeekFrom::Start(end))?;
        first = skip_padding(pages.source)?;
        count += 1;
    }
    Ok(usize::saturating_sub(count, 1))
}

/// Finds a text that is longer than its file, or than any text is: its tag and its bytes.
pub(super) fn endless_text(source: Source<'_>) -> io::Result<Option<(u16, u64)>> {
    let mut pages = Pages::new(source)?;
    let mut next = pages.start(0)?;
    while let Some(page) = pages.page(next)? {
        let most = pages.length.min(LONGEST_TEXT);
        if let Some(text) = page.entries.iter().find(|entry| entry.kind == ASCII && entry.count > most) {
            return Ok(Some((text.tag, text.count)));
        }
        next = page.next;
    }
    Ok(None)
}

/// Files whose pages are followed. Places are relative to the first byte of the file that is followed.
struct Pages<'a> {
    source: Source<'a>,
    /// Number of all bytes.
    length: u64,
    /// Number of bytes that may still be read.
    left: u64,
    /// Number of pages that may still be read.
    pages_left: usize,
    first: u64,
    is_little: bool,
    /// Whether places have 64 bits.
    is_big: bool,
    end: u64,
}

/// A page: its entries, and the place of the next; 0 behind the last.
struct Page {
    entries: Vec<Entry>,
    next: u64,
}

/// An entry of a page: a tag, the type and the bytes of each of its values, and where these lie.
struct Entry {
    tag: u16,
    kind: u64,
    width: u64,
    count: u64,
    at: u64,
}

impl<'a> Pages<'a> {
    fn new(source: Source<'a>) -> io::Result<Self> {
        let length = source.seek(SeekFrom::End(0))?;
        let left = length.saturating_mul(MOST_TIMES);
        Ok(Self { source, length, left, pages_left: MOST_PAGES, first: 0, is_little: true, is_big: false, end: 0 })
    }

    /// Finds the end of the file that begins at `first`: the end of everything that its pages refer to. `None` if no file begins
    /// there.
    fn end_of_file(&mut self, first: u64) -> io::Result<Option<u64>> {
        let mut next = self.start(first)?;
        let mut is_file = false;
        while let Some(page) = self.page(next)? {
            is_file = true;
            next = page.next;
            self.reach_all(&page.entries)?;
        }
        Ok(is_file.then(|| first.saturating_add(self.end).min(self.length)))
    }

    /// Reads the beginning of a file, and returns the place of its first page; 0 if this is not a TIFF file.
    fn start(&mut self, first: u64) -> io::Result<u64> {
        self.first = first;
        let start = self.bytes(0, 16)?;
        self.is_little = start.starts_with(b"II");
        self.is_big = [&b"II+\0\x08\0\0\0"[..], b"MM\0+\0\x08\0\0"].iter().any(|begin| start.starts_with(begin));
        self.end = if self.is_big { 16 } else { 8 };
        let is_tiff = [&b"II*\0"[..], b"MM\0*"].iter().any(|begin| start.starts_with(begin));
        let place = if self.is_big { start.get(8..16) } else { start.get(4..8).filter(|_| is_tiff) };
        Ok(place.map_or(0, |place| self.number(place)))
    }

    /// Reads a page; `None` if there is no page here.
    fn page(&mut self, at: u64) -> io::Result<Option<Page>> {
        if at == 0 || self.pages_left == 0 {
            return Ok(None);
        }
        self.pages_left -= 1;
        let [counted, size, word] = if self.is_big { [8, 20, 8] } else { [2, 12, 4] };
        let count = self.bytes(at, counted)?;
        let length = self.number(&count).saturating_mul(size);
        let from = at.saturating_add(counted);
        let bytes = self.bytes(from, length.saturating_add(word))?;
        if length == 0 || bytes.len() as u64 != length.saturating_add(word) {
            return Ok(None);
        }
        self.reach(from, length + word);
        let (entries, next) = bytes.split_at(length as usize);
        let entry = |(entry, k)| self.entry(entry, from.saturating_add(size * k));
        let entries = entries.chunks_exact(size as usize).zip(0..).map(entry).collect();
        Ok(Some(Page { entries, next: self.number(next) }))
    }

    fn entry(&self, bytes: &[u8], at: u64) -> Entry {
        let number = |from: usize, to: usize| self.number(&bytes[from..to]);
        let kind = number(2, 4);
        let width: u64 = match kind {
            3 | 8 => 2,
            4 | 9 | 11 | 13 => 4,
            5 | 10 | 12 | 16..=18 => 8,
            _ => 1,
        };
        let word = if self.is_big { 8 } else { 4 };
        let count = number(4, 4 + word);
        // Values that fit into the place of their place lie there.
        let is_inside = width.saturating_mul(count) <= word as u64;
        let at = if is_inside { at.saturating_add(4 + word as u64) } else { number(4 + word, 4 + 2 * word) };
        Entry { tag: number(0, 2) as u16, kind, width, count, at }
    }

    /// Notes the places of the values of a page's entries, and of its strips and tiles.
    fn reach_all(&mut self, entries: &[Entry]) -> io::Result<()> {
        for entry in entries {
            self.reach(entry.at, entry.width.saturating_mul(entry.count));
        }
        for (places, sizes) in PLACES {
            for (place, size) in self.values(entries, places)?.into_iter().zip(self.values(entries, sizes)?) {
                self.reach(place, size);
            }
        }
        Ok(())
    }

    /// Reads the values of an entry; none where it is missing.
    fn values(&mut self, entries: &[Entry], tag: u16) -> io::Result<Vec<u64>> {
        let Some(&Entry { width, count, at, .. }) = entries.iter().find(|entry| entry.tag == tag) else {
            return Ok(Vec::new());
        };
        let bytes = self.bytes(at, width.saturating_mul(count))?;
        Ok(bytes.chunks_exact(width as usize).map(|value| self.number(value)).collect())
    }

    /// Notes that the file has so many bytes at a place.
    fn reach(&mut self, place: u64, count: u64) {
        self.end = self.end.max(place.saturating_add(count));
    }

    /// Reads bytes at a place: as many as exist, and may still be read.
    fn bytes(&mut self, at: u64, count: u64) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        let place = self.first.saturating_add(at);
        if place < self.length {
            self.source.seek(SeekFrom::Start(place))?;
            (&mut *self.source).take(count.min(self.left)).read_to_end(&mut bytes)?;
            self.left -= bytes.len() as u64;
        }
        Ok(bytes)
    }

    fn number(&self, bytes: &[u8]) -> u64 {
        let join = |number: u64, byte: &u8| number << 8 | u64::from(*byte);
        if self.is_little { bytes.iter().rev().fold(0, join) } else { bytes.iter().fold(0, join) }
    }
}
