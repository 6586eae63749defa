use std::cmp::Reverse;
use std::collections::{BTreeMap, HashSet};
use std::fmt;
use std::ops::Range;
use std::path::Path;

use super::frame_list::LAST_FRAME;
use crate::{Format, FrameList, FramePattern};

/// Files of a folder whose names form one sequence.
///
/// A sequence prints as the pattern with the numbers: `shot/dome_####.png (1-240)`.
///
/// ```
/// use cosmorama_io::FoundFrames;
///
/// let folder = tempfile::tempdir()?;
/// for name in ["a_1.png", "a_2.png", "b.png"] {
///     std::fs::write(folder.path().join(name), "")?;
/// }
/// let found = FoundFrames::in_folder(folder.path());
/// assert!(found.len() == 1 && found[0].to_string().ends_with("a_#.png (1,2)"));
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FoundFrames {
    /// Pattern of the names.
    pub pattern: FramePattern,
    /// Frame numbers, ascending.
    pub frames: FrameList,
}

/// Greatest average distance between frame numbers; numbers further apart are sizes or dates.
const FARTHEST: u64 = 100;

/// Text before and after a number in a name.
type Around = (String, String);

impl FoundFrames {
    /// Finds the sequences of images in a folder, the longest first; none if it cannot be read. A file belongs to at
    /// most one sequence, and a sequence has at least two files.
    pub fn in_folder(folder: &Path) -> Vec<Self> {
        // Files in the current folder are shown by name alone.
        let here = Path::new(".");
        let (read, folder) =
            if folder == here || folder.as_os_str().is_empty() { (here, Path::new("")) } else { (folder, folder) };
        let Ok(entries) = read.read_dir() else { return Vec::new() };
        let mut numbers: BTreeMap<Around, Vec<String>> = BTreeMap::new();
        for name in entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok()) {
            if Format::of_name(Path::new(&name)).is_some() {
                for digits in runs_of_digits(&name) {
                    let around = (name[..digits.start].to_owned(), name[digits.end..].to_owned());
                    numbers.entry(around).or_default().push(name[digits].to_owned());
                }
            }
        }
        let mut found: Vec<(usize, Self)> = numbers
            .iter()
            .filter_map(|(around, numbers)| Some((around.0.len(), Self::of(folder, around, numbers)?)))
            .collect();
        // If a name has several numbers, the last is most likely the frame's.
        found.sort_by_key(|(before, found)| Reverse((found.frames.frames().len(), *before)));
        let mut told = HashSet::new();
        let is_new = |(_, found): (usize, Self)| {
            let paths = || found.frames.frames().iter().map(|frame| found.pattern.path(*frame));
            if paths().any(|path| told.contains(&path)) {
                return None;
            }
            told.extend(paths());
            Some(found)
        };
        found.into_iter().filter_map(is_new).collect()
    }

    /// Finds the frames with the same text around their numbers; `None` for fewer than two.
    fn of(folder: &Path, (before, after): &Around, numbers: &[String]) -> Option<Self> {
        let places = numbers.iter().map(String::len).min()?;
        // A longer number with leading zeros does not match a pattern of this width.
        let is_found = |digits: &&String| digits.len() == places || !digits.starts_with('0');
        let frames = numbers.iter().filter(is_found).filter_map(|digits| digits.parse().ok());
        let mut frames: Vec<u64> = frames.filter(|frame| *frame <= LAST_FRAME).collect();
        frames.sort_unstable();
        // A placeholder in the text around the numbers would be taken for another number.
        let is_marked = [folder.to_str()?, before, after].into_iter().any(|text| FramePattern::parse(text).is_some());
        let (first, last) = (frames.first()?, frames.last()?);
        let is_sparse = last - first > FARTHEST * (frames.len() as u64 - 1);
        if frames.len() < 2 || is_sparse || is_marked {
            return None;
        }
        let pattern = FramePattern::parse(folder.join(format!("{before}{}{after}", "#".repeat(places))).to_str()?)?;
        Some(Self { pattern, frames: FrameList::new(frames) })
    }
}

impl fmt::Display for FoundFrames {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const LONG: usize = 40;
        let list = self.frames.to_string();
        write!(f, "{} (", self.pattern.as_str())?;
        match self.frames.frames() {
            [first, .., last] if list.len() > LONG => {
                write!(f, "{} frames from {first} to {last})", self.frames.frames().len())
            }
            _ => write!(f, "{list})"),
        }
    }
}

fn runs_of_digits(name: &str) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for (at, _) in name.bytes().enumerate().filter(|(_, byte)| byte.is_ascii_digit()) {
        match runs.last_mut() {
            Some(run) if run.end == at => run.end = at + 1,
            _ => runs.push(at..at + 1),
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(names: &[&str]) -> Vec<String> {
        let folder = tempfile::tempdir().unwrap();
        for name in names {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        let found = FoundFrames::in_folder(folder.path());
        for FoundFrames { pattern, frames } in &found {
            assert!(pattern.existing().unwrap().into_iter().eq(frames.frames().iter().copied()), "{pattern:?}");
        }
        let start = format!("{}/", folder.path().display());
        found.iter().map(|found| found.to_string().replace(&start, "")).collect()
    }

    #[test]
    fn sequences_by_their_names() {
        assert_eq!(found(&["a_0001.png", "a_0002.png", "a_0004.png"]), ["a_####.png (1,2,4)"]);
        assert_eq!(found(&["8.png", "9.png", "10.png", "notes1.txt", "notes2.txt"]), ["#.png (8-10)"]);
        assert_eq!(
            found(&["v2_01.png", "v2_02.png", "v3_01.png", "v3_02.png", "v3_03.png"]),
            ["v3_##.png (1-3)", "v2_##.png (1,2)"]
        );
        assert_eq!(found(&["a_1.png", "b_1.png", "c.png", "#1_1.png", "#1_2.png"]), [""; 0]);
        assert_eq!(found(&["sky_512.png", "sky_1024.png", "sky_2048.png"]), [""; 0]);
    }

    #[test]
    fn many_holes_are_counted() {
        let names: Vec<String> = (0..40).map(|k| format!("{:03}.exr", 2 * k)).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        assert_eq!(found(&names), ["###.exr (40 frames from 0 to 78)"]);
    }
}
