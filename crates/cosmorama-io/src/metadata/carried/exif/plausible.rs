//! Directories of an Exif block, counted before memory is taken for what they list.

/// Greatest number of directories: those of the picture, its preview, Exif, GPS and a few more.
const MOST_DIRECTORIES: usize = 16;
/// Greatest number of entries in a directory.
const MOST_ENTRIES: usize = 1024;

/// Tags of the places of further directories: Exif, GPS and interoperability.
const POINTERS: [u32; 3] = [0x8769, 0x8825, 0xa005];

/// Checks that a block lists no more than a camera writes.
pub(super) fn check(block: &[u8]) -> Result<(), String> {
    let block = Block { bytes: block, is_little: block.starts_with(b"II") };
    let mut places = vec![block.number(4, 4).ok_or("it ends too early")?];
    let mut count = 0;
    while let Some(place) = places.pop() {
        count += 1;
        if count > MOST_DIRECTORIES {
            return Err(format!("more than {MOST_DIRECTORIES} directories"));
        }
        let Some(entries) = block.number(place as usize, 2).map(|entries| entries as usize) else { continue };
        if entries > MOST_ENTRIES {
            return Err(format!("{entries} entries in a directory, more than {MOST_ENTRIES}"));
        }
        let first = place as usize + 2;
        for entry in (0..entries).map(|entry| first + 12 * entry) {
            let is_pointer = block.number(entry, 2).is_some_and(|tag| POINTERS.contains(&tag));
            let is_short = block.number(entry + 2, 2) == Some(3);
            let at = block.number(entry + 8, if is_short { 2 } else { 4 });
            places.extend(at.filter(|_| is_pointer));
        }
        places.extend(block.number(first + 12 * entries, 4).filter(|next| *next != 0));
    }
    Ok(())
}

struct Block<'a> {
    bytes: &'a [u8],
    is_little: bool,
}

impl Block<'_> {
    /// Reads a number of a few bytes; `None` beyond the end.
    fn number(&self, at: usize, count: usize) -> Option<u32> {
        let bytes = self.bytes.get(at..at.checked_add(count)?)?;
        let join = |number: u32, byte: &u8| number << 8 | u32::from(*byte);
        Some(if self.is_little { bytes.iter().rev().fold(0, join) } else { bytes.iter().fold(0, join) })
    }
}
