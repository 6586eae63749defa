//! Marks in a JPEG file: where a picture ends, and which further pictures lie behind it.

use std::io::{self, BufRead, Seek};

/// Mark of a picture's beginning, with the first byte of the mark behind it.
const BEGINNING: [u8; 3] = [0xff, 0xd8, 0xff];
const END: u8 = 0xd9;
const SCAN: u8 = 0xda;
const COMMENT: u8 = 0xfe;
const APPLICATION_2: u8 = 0xe2;

/// Beginning of the segment that lists further pictures of a file (CIPA DC-007).
const INDEX: &[u8] = b"MPF\0";
/// Beginning of the segments that hold an ICC profile (ICC.1, B.4).
const PROFILE: &[u8] = b"ICC_PROFILE\0";
/// Tag of that list's length.
const NUMBER_OF_IMAGES: u16 = 0xb001;

/// Returns where the picture at the beginning ends; `None` where its end mark is missing.
pub(super) fn end(bytes: &[u8]) -> Option<usize> {
    let mut marks = Marks { bytes, at: 0 };
    marks.find(|(mark, _)| *mark == END).map(|_| marks.at)
}

/// Counts the pictures that lie one behind the other and have the size of the first. Smaller ones are previews.
pub(super) fn count_alike(bytes: &[u8]) -> usize {
    let first = size(bytes);
    let (mut rest, mut count) = (bytes, 0);
    while rest.starts_with(&BEGINNING) {
        count += usize::from(size(rest) == first);
        let Some(end) = end(rest) else { break };
        let padding = rest[end..].iter().take_while(|byte| **byte == 0).count();
        rest = &rest[end + padding..];
    }
    count
}

/// Returns height and width as the segment of the picture's frame has them.
fn size(bytes: &[u8]) -> Option<&[u8]> {
    let is_frame = |mark: u8| (0xc0..=0xcf).contains(&mark) && ![0xc4, 0xc8, 0xcc].contains(&mark);
    let (_, segment) = Marks { bytes, at: 0 }.find(|(mark, _)| is_frame(*mark))?;
    segment.get(1..5)
}

/// The marks of a picture, each with the content of its segment if it has one. Compressed data between marks are
/// skipped.
struct Marks<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Iterator for Marks<'a> {
    type Item = (u8, &'a [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            self.at += self.bytes.get(self.at..)?.iter().position(|byte| *byte == 0xff)?;
            self.at += self.bytes[self.at..].iter().position(|byte| *byte != 0xff)?;
            let mark = self.bytes[self.at];
            self.at += 1;
            match mark {
                // A stuffed byte of compressed data, or a mark within them that stands alone.
                0x00 | 0x01 | 0xd0..=0xd8 => {}
                END => return Some((mark, &[])),
                _ => {
                    let length = self.bytes.get(self.at..self.at + 2)?;
                    let end = self.at + usize::from(u16::from_be_bytes([length[0], length[1]])).max(2);
                    let segment = self.bytes.get(self.at + 2..end)?;
                    self.at = end;
                    return Some((mark, segment));
                }
            }
        }
    }
}

/// Segments before a file's pixels that no decoder reads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Beside {
    /// Number of further pictures that are listed, such as previews and gain maps of cameras.
    pub(super) pictures: u32,
    /// Whether there is an ICC profile, or a part of one.
    pub(super) has_profile: bool,
    /// Whether there is a comment.
    pub(super) has_comment: bool,
}

/// Returns what lies before the pixels. A file that is too short for its marks has what was found until there.
pub(super) fn beside(source: &mut (impl BufRead + Seek + ?Sized)) -> Beside {
    let mut beside = Beside::default();
    // The decoder tells what is wrong.
    let _ = look_beside(source, &mut beside);
    beside
}

fn look_beside(source: &mut (impl BufRead + Seek + ?Sized), beside: &mut Beside) -> io::Result<()> {
    source.seek_relative(2)?;
    loop {
        let mut start = [0; 4];
        source.read_exact(&mut start)?;
        let [0xff, mark, high, low] = start else { return Ok(()) };
        let length = usize::from(u16::from_be_bytes([high, low])).saturating_sub(2);
        if mark == SCAN {
            return Ok(());
        }
        beside.has_comment |= mark == COMMENT;
        if mark != APPLICATION_2 {
            source.seek_relative(length as i64)?;
            continue;
        }
        let mut segment = vec![0; length];
        source.read_exact(&mut segment)?;
        beside.has_profile |= segment.starts_with(PROFILE);
        if let Some(list) = segment.strip_prefix(INDEX) {
            beside.pictures = number_of_images(list).unwrap_or(1).saturating_sub(1);
        }
    }
}

/// Returns the number of pictures in the list, which has the structure of a TIFF file.
fn number_of_images(list: &[u8]) -> Option<u32> {
    let is_little = list.starts_with(b"II");
    let bytes = |at: usize, count: usize| -> Option<u32> {
        let bytes = list.get(at..at.checked_add(count)?)?;
        let join = |number: u32, byte: &u8| number << 8 | u32::from(*byte);
        Some(if is_little { bytes.iter().rev().fold(0, join) } else { bytes.iter().fold(0, join) })
    };
    let table = bytes(4, 4)? as usize;
    let entries = bytes(table, 2)? as usize;
    let mut places = (0..entries).map(|entry| table + 2 + 12 * entry);
    let entry = places.find(|at| bytes(*at, 2) == Some(NUMBER_OF_IMAGES.into()))?;
    bytes(entry + 8, 4)
}
