//! Index of an AVI: it tells which places for frames are empty, where the frame before is shown on, and which the file has lost.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::Path;

/// Chunks before the index that are passed over at most.
const MOST_CHUNKS: usize = 1 << 10;

/// Entries of the index that are read at most: ten days of frames and sound.
const MOST_ENTRIES: u32 = 1 << 26;

/// Bytes before each chunk: its name and size.
const MARK: u64 = 8;

/// Places for a stream's frames, in order, as the index tells them.
#[derive(Debug, Default)]
pub(crate) struct Places {
    all: Vec<Place>,
    /// Places whose size the file itself tells otherwise, in order.
    resized: Vec<i64>,
    uncounted: Option<Uncounted>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Place {
    is_empty: bool,
    is_key: bool,
}

/// First place where the file itself has no frame: ffmpeg, which counts frames, gives those behind it numbers that are too low.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Uncounted {
    pub(crate) place: i64,
    /// Byte of the file at which its frame should begin.
    pub(crate) byte: u64,
}

impl Places {
    /// Reads the index of a file. Without one, and behind its end (the first gigabyte, where there is more than one `RIFF`), no place is
    /// known to be empty.
    pub(crate) fn read(path: &Path, stream: u32) -> Self {
        Self::compared(path, stream, 0)
    }

    /// Reads the index of a file, and compares the first places with the file itself.
    pub(crate) fn compared(path: &Path, stream: u32, count: u64) -> Self {
        let open = || File::open(path).ok();
        let files = open().zip(open()).zip(path.metadata().ok());
        let count = usize::try_from(count).unwrap_or(usize::MAX);
        let places = files.and_then(|((index, film), about)| {
            let chunks = Chunks::new(film, about.len());
            places(BufReader::new(index), chunks, (stream, count))
        });
        places.unwrap_or_default()
    }

    /// Counts the places that are not empty.
    pub(crate) fn filled(&self) -> u64 {
        self.all.iter().filter(|place| !place.is_empty).count() as u64
    }

    /// Counts the empty places before a time, in ticks.
    pub(crate) fn empty_before(&self, time: i64) -> u64 {
        let count = usize::try_from(time).unwrap_or(0);
        self.all.iter().take(count).filter(|place| place.is_empty).count() as u64
    }

    /// Returns whether a frame of this time is a place that is left empty. A tick is a place; decoders that keep frames back give times that
    /// are later by so many.
    pub(crate) fn is_empty(&self, time: i64, delay: u64) -> bool {
        let Ok(place) = usize::try_from(time) else { return false };
        let delay = usize::try_from(delay).unwrap_or(usize::MAX);
        let around = self.all.get(place.saturating_sub(delay)..=place);
        around.is_some_and(|around| around.iter().any(|place| place.is_empty))
    }

    /// Returns whether the file tells another size of a place before one: decoders may pass over it without a word.
    pub(crate) fn is_resized_before(&self, place: u64) -> bool {
        self.resized.first().is_some_and(|resized| (*resized as u64) < place)
    }

    /// Returns the places whose size the file tells otherwise, in order.
    pub(crate) fn resized(&self) -> &[i64] {
        &self.resized
    }

    /// Returns once the first place that ffmpeg does not count when it reads on from a time. It seeks by the index, to the key frame before.
    pub(crate) fn take_uncounted_from(&mut self, time: i64) -> Option<Uncounted> {
        let count = usize::try_from(time).unwrap_or(0).saturating_add(1).min(self.all.len());
        let key = self.all[..count].iter().rposition(|place| place.is_key).unwrap_or(0);
        self.uncounted.take_if(|uncounted| uncounted.place >= key as i64)
    }
}

/// Entry of the index `idx1` (Microsoft, AVI RIFF File Reference).
struct Entry {
    name: [u8; 4],
    is_key: bool,
    /// Bytes before its chunk: of the file, or of the list of chunks.
    offset: u32,
    size: u32,
}

impl Entry {
    fn read(file: &mut impl Read) -> Option<Self> {
        const KEY: u32 = 0x10;
        let mut name = [0; 4];
        let mut numbers = [[0; 4]; 3];
        file.read_exact(&mut name).ok()?;
        file.read_exact(numbers.as_flattened_mut()).ok()?;
        let [flags, offset, size] = numbers.map(u32::from_le_bytes);
        Some(Self { name, is_key: flags & KEY != 0, offset, size })
    }

    fn is_frame_of(&self, stream: u32) -> bool {
        let name = str::from_utf8(&self.name).unwrap_or_default();
        matches!(name.split_at_checked(2), Some((number, "dc" | "db")) if number.parse() == Ok(stream))
    }
}

/// Reads the places of a stream's frames from a file's index, and compares so many of them with the file; `None` where it has no index.
fn places<F: Read + Seek>(
    mut index: impl Read + Seek,
    mut chunks: Chunks<F>,
    (stream, compared): (u32, usize),
) -> Option<Places> {
    let (count, list) = find_index(&mut index)?;
    chunks.bases[0] = list;
    let (mut places, mut missing) = (Places::default(), None);
    for _ in 0..count {
        let entry = Entry::read(&mut index)?;
        let place = places.all.len();
        // What is empty may have no chunk.
        let is_compared = entry.size > 0 && place < compared;
        let chunk = if is_compared { chunks.of(&entry) } else { Chunk::AsTold };
        if !entry.is_frame_of(stream) {
            continue;
        }
        places.all.push(Place { is_empty: entry.size == 0, is_key: entry.is_key });
        match chunk {
            Chunk::AsTold => {}
            Chunk::Resized => places.resized.push(place as i64),
            Chunk::Missing => missing = missing.or(Some((place, entry.offset))),
        }
    }
    match chunks.base() {
        Some(base) => {
            let uncounted = |(place, offset)| Uncounted { place: place as i64, byte: base + u64::from(offset) };
            places.uncounted = missing.map(uncounted);
        }
        None => places.resized.clear(),
    }
    Some(places)
}

/// Goes to the entries of the index. Returns their number, and the byte of the list of chunks from which their offsets may count.
fn find_index(file: &mut (impl Read + Seek)) -> Option<(u32, Option<u64>)> {
    let mut head = [0; 12];
    file.read_exact(&mut head).ok()?;
    if !(head.starts_with(b"RIFF") && head.ends_with(b"AVI ")) {
        return None;
    }
    let mut list = None;
    for _ in 0..MOST_CHUNKS {
        let mut head = [0; MARK as usize];
        file.read_exact(&mut head).ok()?;
        let [name @ .., a, b, c, d] = head;
        let size = u32::from_le_bytes([a, b, c, d]);
        if name == *b"idx1" {
            return Some(((size / 16).min(MOST_ENTRIES), list));
        }
        let start = file.stream_position().ok()?;
        let mut kind = [0; 4];
        if name == *b"LIST" && file.read_exact(&mut kind).is_ok() && kind == *b"movi" {
            list = list.or(Some(start));
        }
        file.seek(SeekFrom::Start(start.saturating_add(u64::from(size) + u64::from(size % 2)))).ok()?;
    }
    None
}

/// Chunks of a file, in the order of the index.
struct Chunks<F> {
    file: F,
    length: u64,
    /// Bytes from which offsets may count: writers do not agree. From the first chunk that is found, one is known.
    bases: [Option<u64>; 2],
    /// End of the chunk before.
    end: u64,
    is_in_order: bool,
    last: Option<u32>,
}

/// Finding where the index tells of a chunk.
#[derive(Debug, PartialEq, Eq)]
enum Chunk {
    AsTold,
    /// One of another size.
    Resized,
    /// None, or one that lies in the chunk before.
    Missing,
}

impl<F: Read + Seek> Chunks<F> {
    fn new(file: F, length: u64) -> Self {
        Self { file, length, bases: [None, Some(0)], end: 0, is_in_order: true, last: None }
    }

    fn of(&mut self, entry: &Entry) -> Chunk {
        self.is_in_order &= self.last.is_none_or(|last| last < entry.offset);
        self.last = Some(entry.offset);
        for base in self.bases.into_iter().flatten() {
            let start = base.saturating_add(u64::from(entry.offset));
            // What ends behind the file, ffmpeg takes for no chunk.
            let size = self.size(start, entry.name).filter(|size| start + MARK + u64::from(*size) <= self.length);
            if let Some(size) = size.filter(|_| start >= self.end) {
                self.bases = [Some(base), None];
                self.end = start + MARK + u64::from(size);
                return if size == entry.size { Chunk::AsTold } else { Chunk::Resized };
            }
        }
        Chunk::Missing
    }

    /// Returns the size of the chunk that begins at a byte, if one of this stream does.
    fn size(&mut self, start: u64, name: [u8; 4]) -> Option<u32> {
        let mut found = [[0; 4]; 2];
        self.file.seek(SeekFrom::Start(start)).ok()?;
        self.file.read_exact(found.as_flattened_mut()).ok()?;
        // Some writers call the same frames `dc` and `db`.
        (found[0][..3] == name[..3]).then_some(u32::from_le_bytes(found[1]))
    }

    /// Returns the byte from which offsets count, if the index is one of this file: it is in the file's order, and some chunk is where it
    /// tells.
    fn base(&self) -> Option<u64> {
        self.bases[0].filter(|_| self.is_in_order && self.bases[1].is_none())
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    /// Makes a file of two chunks at bytes 24 and 38, whose index has these entries.
    fn file(entries: &[(&[u8; 4], u32, u32)]) -> Vec<u8> {
        let mut bytes = b"RIFF\0\0\0\0AVI LIST\x20\0\0\0movi00dc\x06\0\0\0abcdef00dc\x06\0\0\0ghijkl".to_vec();
        bytes.extend([&b"idx1"[..], &(entries.len() as u32 * 16).to_le_bytes()].concat());
        for (name, offset, size) in entries {
            bytes.extend([&name[..], &[0x10, 0, 0, 0], &offset.to_le_bytes(), &size.to_le_bytes()].concat());
        }
        bytes
    }

    fn read(bytes: &[u8], stream: u32) -> Option<Places> {
        places(Cursor::new(bytes), Chunks::new(Cursor::new(bytes), bytes.len() as u64), (stream, 9))
    }

    #[test]
    fn places_are_empty_as_the_index_tells() {
        let list: [(&[u8; 4], u32, u32); 5] =
            [(b"00dc", 4, 9), (b"01wb", 0, 0), (b"00dc", 0, 0), (b"01dc", 18, 7), (b"00db", 32, 300)];
        let bytes = file(&list);
        let is_empty =
            |stream| read(&bytes, stream).unwrap().all.iter().map(|place| place.is_empty).collect::<Vec<_>>();
        assert_eq!(is_empty(0), [false, true, false]);
        assert_eq!(is_empty(1), [false]);
        assert!(is_empty(2).is_empty());
        for length in 0..bytes.len() {
            assert!(read(&bytes[..length], 0).is_none(), "{length} bytes");
        }
        // Whatever else a file holds, it is read to an end.
        for (byte, value) in (0..bytes.len()).flat_map(|byte| [(byte, 0), (byte, 0x7f), (byte, 0xff)]) {
            let mut bytes = bytes.clone();
            bytes[byte] = value;
            assert!(read(&bytes, 0).is_none_or(|places| places.all.len() <= list.len()));
        }
    }

    #[test]
    fn what_the_index_does_not_tell_is_not_empty() {
        let all = [false, true, false, false].map(|is_empty| Place { is_empty, is_key: false }).to_vec();
        let places = Places { all, ..Places::default() };
        assert_eq!((places.filled(), [-1, 1, 2, 9].map(|time| places.empty_before(time))), (3, [0, 0, 1, 1]));
        assert_eq!([-1, 0, 1, 2, 3, 4].map(|time| places.is_empty(time, 0)), [false, false, true, false, false, false]);
        assert_eq!([0, 1, 2, 3].map(|time| places.is_empty(time, 1)), [false, true, true, false]);
    }

    #[test]
    fn places_that_the_file_has_lost_are_found() {
        let found =
            |bytes: &[u8]| read(bytes, 0).map(|places| (places.resized.first().copied(), places.uncounted)).unwrap();
        let uncounted = |place, byte| Some(Uncounted { place, byte });
        // Offsets count from the list, or from the beginning.
        for base in [0, 20] {
            let bytes = file(&[(b"00dc", 24 - base, 6), (b"00dc", 38 - base, 6)]);
            assert_eq!(found(&bytes), (None, None));
            let with = |byte: usize, new: &[u8]| {
                let mut bytes = bytes.clone();
                bytes[byte..byte + new.len()].copy_from_slice(new);
                found(&bytes)
            };
            assert_eq!(with(38, b"XX"), (None, uncounted(1, 38)), "no chunk");
            assert_eq!(with(42, &[0, 9, 0]), (None, uncounted(1, 38)), "longer than the file");
            assert_eq!(with(28, &[7]), (Some(0), uncounted(1, 38)), "longer than the place");
            assert_eq!(with(28, &[0]), (Some(0), None));
            assert_eq!(with(24, b"01wb"), (None, uncounted(0, 24)));
        }
        // An index of another file, and one in another order.
        assert_eq!(found(&file(&[(b"00dc", 5, 6), (b"00dc", 19, 6)])), (None, None));
        assert_eq!(found(&file(&[(b"00dc", 18, 6), (b"00dc", 4, 7)])), (None, None));
    }

    #[test]
    fn what_is_lost_before_the_key_frame_of_a_seek_is_counted() {
        let all = [true, false, false, true, false].map(|is_key| Place { is_empty: false, is_key }).to_vec();
        let uncounted = Some(Uncounted { place: 1, byte: 9 });
        let found =
            |time| Places { all: all.clone(), uncounted, ..Places::default() }.take_uncounted_from(time).is_some();
        assert_eq!([-1, 0, 2, 3, 9].map(found), [true, true, true, false, false]);
    }
}
