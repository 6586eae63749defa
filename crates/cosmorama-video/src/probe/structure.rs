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

/// Finds out whether a file has fewer bytes than its structure says; `None` also for files without such a structure.
pub(super) fn cut(file: &mut File) -> Option<CutShort> {
    let found = file.metadata().ok()?.len();
    let mut start = [0; 12];
    file.seek(SeekFrom::Start(0)).ok()?;
    file.read_exact(&mut start).ok()?;
    let expected = match &start {
        [0x1a, 0x45, 0xdf, 0xa3, ..] => end_of_segment(file)?,
        [b'R', b'I', b'F', b'F', size @ .., _, _, _, _] => 8 + u64::from(u32::from_le_bytes(*size)),
        [b'F', b'L', b'V', ..] => size_in_flv(&beginning(file)?)?,
        [b'O', b'g', b'g', b'S', ..] => end_of_pages(file, found)?,
        [b'n', b'u', b't', b'/', ..] => end_of_index(file, found)?,
        [0x1f, 7, 0, system, ..] if system & 0x3f == 0x3f => {
            let frame = frame_of_dv(file, *system)?;
            found.div_ceil(frame) * frame
        }
        [0x30, 0x26, 0xb2, 0x75, ..] => size_in_asf(&beginning(file)?)?,
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

/// Returns the first bytes of a file.
fn beginning(file: &mut File) -> Option<Vec<u8>> {
    const ENOUGH: u64 = 1 << 16;
    file.seek(SeekFrom::Start(0)).ok()?;
    let mut bytes = Vec::new();
    file.take(ENOUGH).read_to_end(&mut bytes).ok()?;
    Some(bytes)
}

/// Returns the bytes behind some others.
fn behind<'a>(bytes: &'a [u8], mark: &[u8]) -> Option<&'a [u8]> {
    let at = bytes.windows(mark.len()).position(|window| window == mark)?;
    bytes.get(at + mark.len()..)
}

/// Returns the size that FLV tells of itself, as most writers do: a number of AMF in `onMetaData` (Adobe, Flash Video File Format 10.1).
fn size_in_flv(bytes: &[u8]) -> Option<u64> {
    let number = behind(bytes, b"\0\x08filesize\0")?.first_chunk()?;
    Some(f64::from_be_bytes(*number) as u64)
}

/// Returns the size that ASF tells in its File Properties (Microsoft, Advanced Systems Format 3.2); none of a broadcast is right.
fn size_in_asf(bytes: &[u8]) -> Option<u64> {
    const PROPERTIES: [u8; 16] = *b"\xa1\xdc\xab\x8c\x47\xa9\xcf\x11\x8e\xe4\x00\xc0\x0c\x20\x53\x65";
    let properties = behind(bytes, &PROPERTIES)?;
    let is_broadcast = properties.get(72)? & 1 == 1;
    let size = properties.get(24..)?.first_chunk()?;
    (!is_broadcast).then_some(u64::from_le_bytes(*size))
}

/// Returns the end of the last page of an Ogg file (RFC 3533), or a greater length than the file's where its header is not whole, bytes follow, or
/// it is not the last of its stream.
fn end_of_pages(file: &mut File, length: u64) -> Option<u64> {
    const LONGEST: u64 = 27 + 255 + 255 * 255;
    let start = length.saturating_sub(LONGEST);
    file.seek(SeekFrom::Start(start)).ok()?;
    let mut bytes = Vec::new();
    file.take(LONGEST).read_to_end(&mut bytes).ok()?;
    let at = bytes.windows(5).rposition(|window| window == b"OggS\0")?;
    let page = bytes.get(at..)?;
    let Some(segments) = page.get(26).and_then(|count| page.get(27..27 + usize::from(*count))) else {
        return Some(length + 1);
    };
    let content: u64 = segments.iter().copied().map(u64::from).sum();
    let end = start + at as u64 + 27 + segments.len() as u64 + content;
    let is_last = page[5] & 4 != 0;
    Some(if end == length && !is_last { length + 1 } else { end.max(length + u64::from(end < length)) })
}

/// Returns the length of a NUT file that ends with an index, as ffmpeg always writes it unless it is told not to, or a greater one
/// (NUT, version 3, index packet).
fn end_of_index(file: &mut File, length: u64) -> Option<u64> {
    const INDEX: [u8; 8] = *b"NX\xdd\x67\x2f\x23\xe6\x4e";
    let start_of = |file: &mut File, before: u64| {
        let mut number = [0; 8];
        file.seek(SeekFrom::Start(length.checked_sub(before)?)).ok()?;
        file.read_exact(&mut number).ok().map(|()| number)
    };
    // Its last number, before the sum, is its own length.
    let own = u64::from_be_bytes(start_of(file, 12)?);
    Some(if start_of(file, own) == Some(INDEX) { length } else { length + 1 })
}

/// Returns the bytes of a frame of DV by the mark of its system, and of the second channel of 50 Mbit (IEC 61834-2, SMPTE 314M, header section).
fn frame_of_dv(file: &mut File, system: u8) -> Option<u64> {
    const SECOND: u8 = 0x08;
    let channel = if system & 0x80 == 0 { 120_000 } else { 144_000 };
    let mut next = [0; 2];
    file.seek(SeekFrom::Start(channel)).ok()?;
    let has_second = file.read_exact(&mut next).is_ok() && next[0] == 0x1f && next[1] & SECOND != 0;
    Some(if has_second { 2 * channel } else { channel })
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
        let flv = |size: f64| [&b"FLV\x01\x05\0\0\0\x09\0\x08filesize\0"[..], &size.to_be_bytes()].concat();
        assert_eq!(found(&flv(28.0)), None);
        assert_eq!(found(&flv(40.0)), Some(CutShort { expected: 40, found: 28 }));
        assert!([f64::NAN, -1.0, 0.0].iter().all(|size| found(&flv(*size)).is_none()));
        let asf = |size: u64, flags: u8| {
            let guid = b"\xa1\xdc\xab\x8c\x47\xa9\xcf\x11\x8e\xe4\0\xc0\x0c\x20\x53\x65";
            [&b"\x30\x26\xb2\x75"[..], guid, &[0; 24], &size.to_le_bytes(), &[0; 40], &[flags, 0, 0, 0]].concat()
        };
        assert_eq!((found(&asf(96, 2)), found(&asf(97, 3)), found(&asf(97, 2)[..90])), (None, None, None));
        assert_eq!(found(&asf(97, 2)), Some(CutShort { expected: 97, found: 96 }));
        assert_eq!(found(b"\x1a\x45\xdf\xa3\0\0\0\0\0\0\0\0\0\0\0"), None);
        let page =
            |length: u8| [&b"OggS\0\x04"[..], &[0; 20], &[2, 200, length], &[7; 200], &vec![7; length.into()]].concat();
        let ogg = [page(3), page(5)].concat();
        assert_eq!((found(&ogg), found(&ogg[..232])), (None, None));
        assert_eq!(found(&ogg[..ogg.len() - 1]), Some(CutShort { expected: 466, found: 465 }));
        assert_eq!(found(&ogg[..250]), Some(CutShort { expected: 251, found: 250 }));
        assert_eq!(found(&ogg[..234]), Some(CutShort { expected: 235, found: 234 }));
        let more_follow = [&ogg[..5], b"\0", &ogg[6..232]].concat();
        assert_eq!(found(&more_follow), Some(CutShort { expected: 233, found: 232 }));
        let nut =
            [&b"nut/multimedia container\0NX\xdd\x67\x2f\x23\xe6\x4e"[..], &20_u64.to_be_bytes(), b"\0\0\0\0"].concat();
        assert_eq!(found(&nut), None);
        assert_eq!(found(&nut[..nut.len() - 3]), Some(CutShort { expected: 43, found: 42 }));
        let dv = [&b"\x1f\x07\0\x3f"[..], &vec![0; 239_996]].concat();
        assert_eq!((found(&dv), found(&dv[..120_000])), (None, None));
        assert_eq!(found(&dv[..120_001]), Some(CutShort { expected: 240_000, found: 120_001 }));
        let dv_50 = [&dv[..120_000], b"\x1f\x0f", &dv[..119_998]].concat();
        assert_eq!(found(&dv_50), None);
        assert_eq!(found(&dv_50[..130_000]), Some(CutShort { expected: 240_000, found: 130_000 }));
        assert_eq!(found(b"short"), None);
        assert_eq!(found(b"ffconcat version 1.0"), None);
    }
}
