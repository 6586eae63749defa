//! Bounds of a panorama in Matroska, of which ffprobe tells whole pixels, rounded all to one side (`libavutil/spherical.c`).

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::Bounds;

/// Elements from the file to the bounds: segment, tracks, one of them, its video, its projection, and that one's private data (RFC 9559).
const PATH: [u32; 6] = [0x1853_8067, 0x1654_ae6b, 0xae, 0xe0, 0x7670, 0x7672];

/// Bytes of a file among which its tracks stand.
const ENOUGH: u64 = 1 << 20;

/// Reads the bounds that agree with those that are told, to a pixel; `None` if none are there.
pub(super) fn bounds(path: &Path, told: Bounds, (width, height): (usize, usize)) -> Option<Bounds> {
    let mut bytes = Vec::new();
    File::open(path).ok()?.take(ENOUGH).read_to_end(&mut bytes).ok()?;
    let mut found = Vec::new();
    find(&bytes, &PATH, &mut found);
    let is_near = |a: u32, b: u32, pixels: usize| u64::from(a.abs_diff(b)) * pixels as u64 <= 2 << 32;
    found.into_iter().find(|found| {
        is_near(found.left, told.left, width)
            && is_near(found.right, told.right, width)
            && is_near(found.top, told.top, height)
            && is_near(found.bottom, told.bottom, height)
    })
}

/// Finds the private data of equirectangular projections: those of the box `equi` of MP4.
fn find(bytes: &[u8], path: &[u32], found: &mut Vec<Bounds>) {
    let Some((id, inner)) = path.split_first() else {
        let number = |at: usize| Some(u32::from_be_bytes(*bytes.get(at..)?.first_chunk()?));
        // Behind the version and flags.
        let numbers = (number(4), number(8), number(12), number(16));
        if let (Some(top), Some(bottom), Some(left), Some(right)) = numbers {
            found.push(Bounds { top, bottom, left, right });
        }
        return;
    };
    let mut rest = bytes;
    while let Some((name, content, behind)) = element(rest) {
        if name == *id {
            find(content, inner, found);
        }
        rest = behind;
    }
}

/// Takes the first element off: its identifier, its content as far as it is there, and what is behind.
fn element(bytes: &[u8]) -> Option<(u32, &[u8], &[u8])> {
    let length = |first: u8| first.leading_zeros() as usize + 1;
    let id = bytes.get(..length(*bytes.first()?)).filter(|id| id.len() <= 4)?;
    let bytes = &bytes[id.len()..];
    let size = bytes.get(..length(*bytes.first()?)).filter(|size| size.len() <= 8)?;
    let number = |bytes: &[u8]| bytes.iter().fold(0_u64, |number, byte| number << 8 | u64::from(*byte));
    // All ones are an unknown size, which is to the end.
    let mask = (1_u64 << (7 * size.len())) - 1;
    let bytes = &bytes[size.len()..];
    let content = usize::try_from(number(size) & mask).unwrap_or(usize::MAX).min(bytes.len());
    Some((number(id) as u32, &bytes[..content], &bytes[content..]))
}
