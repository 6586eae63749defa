use std::collections::BTreeSet;
use std::path::PathBuf;

use super::FoundFrames;
use crate::{FrameList, FramePattern, IoError};

/// Frames of a sequence that all exist.
///
/// ```
/// use cosmorama_io::{FramePattern, Frames};
///
/// let folder = tempfile::tempdir()?;
/// for frame in 1..=3 {
///     std::fs::write(folder.path().join(format!("dome_{frame:04}.png")), "")?;
/// }
/// let pattern = FramePattern::parse(&format!("{}/dome_####.png", folder.path().display())).expect("a pattern");
/// let frames = Frames::find(pattern, None)?;
/// assert_eq!(frames.list().to_string(), "1-3");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frames {
    pattern: FramePattern,
    list: FrameList,
}

impl Frames {
    /// Frames from the first to the last of one sequence, at most; more is another sequence's number, or a date.
    pub const MOST: u64 = 10_000_000;

    /// Finds the requested frames, or all that exist.
    ///
    /// # Errors
    /// When there are no frames, a requested frame is missing, or, without a list, a frame between the first and the
    /// last is missing, or these two are [`Self::MOST`] or more apart. The message names all missing frames.
    pub fn find(pattern: FramePattern, wanted: Option<&FrameList>) -> Result<Self, IoError> {
        let existing = pattern.existing()?;
        let (Some(&first), Some(&last)) = (existing.first(), existing.last()) else {
            return Err(no_frames(&pattern));
        };
        let list = match wanted {
            Some(list) => list.clone(),
            None => FrameList::new(existing.iter().copied()),
        };
        let missing = match wanted {
            Some(list) => FrameList::new(list.frames().iter().copied().filter(|frame| !existing.contains(frame))),
            None if last - first >= Self::MOST => {
                return Err(IoError::FarFrames { pattern: pattern.as_str().to_owned(), existing: (first, last) });
            }
            None => holes(&existing, first, last),
        };
        if missing.frames().is_empty() {
            return Ok(Self { pattern, list });
        }
        Err(IoError::MissingFrames {
            pattern: pattern.as_str().to_owned(),
            count: missing.frames().len(),
            existing: (first, last),
            missing: missing.to_string(),
        })
    }

    /// Returns the numbers of the frames.
    pub fn list(&self) -> &FrameList {
        &self.list
    }

    /// Iterates over numbers and files.
    pub fn paths(&self) -> impl Iterator<Item = (u64, PathBuf)> {
        self.list.frames().iter().map(|&frame| (frame, self.pattern.path(frame)))
    }
}

fn no_frames(pattern: &FramePattern) -> IoError {
    IoError::NoFrames {
        pattern: pattern.as_str().to_owned(),
        folder: pattern.folder(),
        example: pattern.path(1).display().to_string(),
        found: FoundFrames::in_folder(&pattern.folder()).first().map(ToString::to_string),
    }
}

/// Returns the missing frames between the first and the last.
fn holes(existing: &BTreeSet<u64>, first: u64, last: u64) -> FrameList {
    FrameList::new((first..=last).filter(|frame| !existing.contains(frame)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sequence(frames: &[u64]) -> (tempfile::TempDir, FramePattern) {
        let folder = tempfile::tempdir().unwrap();
        let pattern = FramePattern::parse(&format!("{}/f_####.png", folder.path().display())).unwrap();
        for frame in frames {
            std::fs::write(pattern.path(*frame), "").unwrap();
        }
        (folder, pattern)
    }

    #[test]
    fn all_that_exist_in_order() {
        let (_folder, pattern) = sequence(&[3, 1, 2]);
        assert_eq!(Frames::find(pattern, None).unwrap().list().frames(), [1, 2, 3]);
    }

    #[test]
    fn every_missing_frame_is_named() {
        let (_folder, pattern) = sequence(&[1, 2, 6, 8, 9]);
        let message = Frames::find(pattern, None).unwrap_err().to_string();
        assert!(message.contains("4 frames are missing: 3-5,7;"), "{message}");
    }

    #[test]
    fn a_list_needs_only_its_own_frames() {
        let (_folder, pattern) = sequence(&[1, 3, 5]);
        let list = FrameList::new([1, 3, 5]);
        assert_eq!(Frames::find(pattern.clone(), Some(&list)).unwrap().list().frames(), [1, 3, 5]);
        let list = FrameList::new([4, 5]);
        let message = Frames::find(pattern, Some(&list)).unwrap_err().to_string();
        assert!(
            message.contains("1 frame is missing: 4; the first that exists is 1, the last 5; make it,"),
            "{message}"
        );
    }

    #[test]
    fn no_frame_at_all() {
        let (_folder, pattern) = sequence(&[]);
        let message = Frames::find(pattern, None).unwrap_err().to_string();
        assert!(message.contains("f_0001.png"), "{message}");
    }
}
