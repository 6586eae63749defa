//! Tracks of a movie, and the boxes that extend their first description of samples.

use super::Fault;
use super::tree::{Boxed, Name, boxed, get, replaced, split};

/// Kind of a track.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Handler {
    Video,
    Sound,
}

impl Handler {
    fn name(self) -> &'static Name {
        match self {
            Self::Video => b"vide",
            Self::Sound => b"soun",
        }
    }

    /// Returns the bytes of a description before the boxes that extend it.
    fn fixed(self, entry: &[u8]) -> usize {
        match self {
            Self::Video => 78,
            // QuickTime's second and third versions have more fields.
            Self::Sound => match entry.get(8..10) {
                Some([0, 1]) => 28 + 16,
                Some([0, 2]) => 28 + 36,
                _ => 28,
            },
        }
    }
}

/// Bytes of version, flags and count before the descriptions.
const DESCRIPTIONS: usize = 8;

/// Returns the extending boxes of the first description of each track of a kind.
pub(super) fn extensions(movie: &[u8], handler: Handler) -> Result<Vec<&[u8]>, Fault> {
    let mut found = Vec::new();
    for track in split(movie)?.into_iter().filter(|found| found.name == *b"trak") {
        if !is_of(track.content, handler) {
            continue;
        }
        let media = get(track.content, b"mdia")?.content;
        let table = get(get(media, b"minf")?.content, b"stbl")?.content;
        let descriptions = get(table, b"stsd")?.content.get(DESCRIPTIONS..).unwrap_or_default();
        let first = split(descriptions)?.first().copied().ok_or("a track has no description")?;
        found.push(first.content.get(handler.fixed(first.content)..).unwrap_or_default());
    }
    Ok(found)
}

/// Returns a movie whose tracks of a kind have other extending boxes: those of the names `old` are taken away, and those in
/// `new` added, a text of boxes for each track. Tracks without one stay as they are.
pub(super) fn with_extensions(
    movie: &[u8],
    handler: Handler,
    old: &[&Name],
    new: &[Option<Vec<u8>>],
) -> Result<Vec<u8>, Fault> {
    let mut news = new.iter();
    let mut changed = Vec::with_capacity(movie.len() + 256);
    for found in split(movie)? {
        let added = if found.name == *b"trak" && is_of(found.content, handler) { news.next() } else { None };
        match added {
            Some(Some(added)) => changed.extend(boxed(b"trak", &with_extension(found.content, handler, old, added)?)?),
            _ => changed.extend(found.whole),
        }
    }
    Ok(changed)
}

fn with_extension(track: &[u8], handler: Handler, old: &[&Name], added: &[u8]) -> Result<Vec<u8>, Fault> {
    let described = |content: &[u8]| {
        let (head, descriptions) = content.split_at_checked(DESCRIPTIONS).ok_or("a track has no description")?;
        let first = split(descriptions)?.first().copied().ok_or("a track has no description")?;
        let (fixed, boxes) =
            first.content.split_at_checked(handler.fixed(first.content)).ok_or("a description is too short")?;
        let kept: Vec<_> = split(boxes)?.into_iter().filter(|found| !old.contains(&&found.name)).collect();
        if kept.iter().any(Boxed::is_open) {
            return Err("a box in a description has no size of its own, and would hold what is added".to_owned());
        }
        let kept = kept.iter().flat_map(|found| found.whole.iter().copied()).collect::<Vec<_>>();
        let entry = boxed(&first.name, &[fixed, &kept, added].concat())?;
        Ok([head, &entry, &descriptions[first.whole.len()..]].concat())
    };
    replaced(track, b"mdia", |media| {
        replaced(media, b"minf", |information| {
            replaced(information, b"stbl", |table| replaced(table, b"stsd", described))
        })
    })
}

/// Returns whether a track is of a kind.
fn is_of(track: &[u8], handler: Handler) -> bool {
    let name = |content| get(get(content, b"mdia").ok()?.content, b"hdlr").ok()?.content.get(8..12);
    name(track).is_some_and(|name| name == handler.name())
}
