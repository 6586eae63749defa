//! The outermost structure of a file: it tells whether the end is missing, which ffmpeg takes for the end of the video.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};

use super::CutShort;

/// Boxes that are passed over at most.
const MOST_BOXES: usize = 1 << 16;

/// Names of boxes with which MP4 and MOV files begin.
const FIRST: [&[u8; 4]; 9] = [b"ftyp", b"styp", b"moov", b"mdat", b"free", b"skip", b"wide", b"pnot", b"uuid"];

/// Names of boxes that follow others in them.
const LATER: [&[u8; 4]; 8] = [b"moof", b"mfra", b"sidx", b"ssix", b"meta", b"udta", b"prft", b"emsg"];

/// Returns whether ffprobe's names of a container are those of MP4 and MOV.
pub(crate) fn is_boxes(container: &str) -> bool {
    container.split(',').any(|name| name == "mov" || name == "mp4")
}

/// Finds out whether a file has fewer bytes than its structure says; `None` also for files without such a structure.
pub(super) fn cut(file: &mut File) -> Option<CutShort> {
    let found = file.metadata().ok()?.len();
    let mut start = [0; 12];
    file.seek(SeekFrom::Start(0)).ok()?;
    file.read_exact(&mut start).ok()?;
    let expected = match &start {
        [0x1a, 0x45, 0xdf, 0xa3, ..] => end_of_segment(file)?,
        [b'R', b'I', b'F', b'F', size @ .., _, _, _, _] => 8 + u64::from(u32::from_le_bytes(*size)),
        [_, _, _, _, name @ .., _, _, _, _] if FIRST.contains(&name) => end_of_boxes(file, found)?,
        _ => return None,
    };
    (expected > found).then_some(CutShort { expected, found })
}

/// Returns the end of the first box that reaches beyond the file, or of the last. Behind the frames and their description, cameras
/// write bytes of their own, which are no boxes.
fn end_of_boxes(file: &mut File, length: u64) -> Option<u64> {
    let (mut at, mut has_frames, mut has_description) = (0_u64, false, false);
    for _ in 0..MOST_BOXES {
        // Fewer bytes than a box has at least are padding.
        if at.checked_add(8)? > length {
            return Some(at);
        }
        file.seek(SeekFrom::Start(at)).ok()?;
        let mut head = [0; 8];
        file.read_exact(&mut head).ok()?;
        let name: &[u8; 4] = head.last_chunk()?;
        if has_frames && has_description && !FIRST.contains(&name) && !LATER.contains(&name) {
            return Some(at);
        }
        has_frames |= name == b"mdat";
        has_description |= name == b"moov";
        let size = match u32::from_be_bytes([head[0], head[1], head[2], head[3]]) {
            // To the end of the file, wherever that is.
            0 => return Some(length),
            1 => {
                let mut size = [0; 8];
                file.read_exact(&mut size).ok()?;
                u64::from_be_bytes(size)
            }
            size => u64::from(size),
        };
        at = at.checked_add(size.max(8))?;
    }
    None
}

/// Returns the end of a Matroska file's segment; `None` if its size is not said.
fn end_of_segment(file: &mut File) -> Option<u64> {
    file.seek(SeekFrom::Start(4)).ok()?;
    let header = size(file)??;
    file.seek(SeekFrom::Current(i64::try_from(header).ok()?)).ok()?;
    let mut id = [0; 4];
    file.read_exact(&mut id).ok()?;
    if id != [0x18, 0x53, 0x80, 0x67] {
        return None;
    }
    let content = size(file)??;
    file.stream_position().ok()?.checked_add(content)
}

/// Reads the size of an EBML element; the inner `None` is an unknown size.
fn size(file: &mut File) -> Option<Option<u64>> {
    let mut first = [0];
    file.read_exact(&mut first).ok()?;
    let more = first[0].leading_zeros() as usize;
    let mut rest = [0; 7];
    file.read_exact(rest.get_mut(..more)?).ok()?;
    let marked = u64::from(first[0]) & ((1 << (7 - more)) - 1);
    let value = rest[..more].iter().fold(marked, |value, byte| value << 8 | u64::from(*byte));
    let unknown = (1_u64 << (7 * (more + 1))) - 1;
    Some((value != unknown).then_some(value))
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    fn found(bytes: &[u8]) -> Option<CutShort> {
        let mut file = tempfile::tempfile().unwrap();
        file.write_all(bytes).unwrap();
        cut(&mut file)
    }

    #[test]
    fn a_file_that_ends_too_early_is_found_out() {
        let boxes = [b"\0\0\0\x10ftypisom\0\0\0\0".as_slice(), b"\0\0\0\x0cmdat\0\0\0\0"].concat();
        assert_eq!(found(&boxes), None);
        assert_eq!(found(&boxes[..24]), Some(CutShort { expected: 28, found: 24 }));
        let large = [b"\0\0\0\x10ftypisom\0\0\0\0".as_slice(), b"\0\0\0\x01mdat\0\0\0\x01\0\0\0\0"].concat();
        let description = b"\0\0\0\x08moov".as_slice();
        let trailer = b"\0\xff\xff\xff\0\0\x01\x01 of a camera".as_slice();
        assert_eq!(found(&[&boxes, description, trailer].concat()), None);
        // Without the description, it may be anything; and a known box is cut wherever it stands.
        assert!(found(&[&boxes, trailer].concat()).is_some());
        assert!(found(&[&boxes, description, b"\0\0\x01\0mdat".as_slice()].concat()).is_some());
        assert_eq!(found(&large), Some(CutShort { expected: 16 + (1 << 32), found: 32 }));
        let matroska = b"\x1a\x45\xdf\xa3\x81x\x18\x53\x80\x67\x01\0\0\0\0\0\0\x05abcde";
        assert_eq!(found(matroska), None);
        assert_eq!(found(&matroska[..20]), Some(CutShort { expected: 23, found: 20 }));
        // A live stream does not say how long it is.
        assert_eq!(found(b"\x1a\x45\xdf\xa3\x81x\x18\x53\x80\x67\x01\xff\xff\xff\xff\xff\xff\xffabc"), None);
        assert_eq!(found(b"RIFF\x10\0\0\0AVI LIST"), Some(CutShort { expected: 24, found: 16 }));
        assert_eq!(found(b"\x1a\x45\xdf\xa3\0\0\0\0\0\0\0\0\0\0\0"), None);
        assert_eq!(found(b"short"), None);
        assert_eq!(found(b"ffconcat version 1.0"), None);
    }
}
