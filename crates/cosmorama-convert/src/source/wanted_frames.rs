use std::collections::BTreeSet;

use cosmorama_io::{FrameList, FramePattern, Frames, IoError};

use crate::diagnostic::{FRAMES, PATH, Result, YAW, bail, usage};
use crate::source::{Files, ViewFiles};

/// Pictures by frame.
enum Series<'a> {
    /// A file for each frame.
    Files(&'a FramePattern),
    /// A video, with the number of its frames; `None` for a stream that is read as it comes.
    Video { name: String, count: Option<u64> },
}

/// Finds the frames to work on: the requested ones, or all that there are. `[None]` where there is no sequence.
pub(crate) fn find(files: &ViewFiles, inputs: &dyn Files, wanted: Option<&FrameList>) -> Result<Vec<Option<u64>>> {
    let series = Series::of(files, inputs)?;
    find_in(series.as_slice(), wanted, |_| String::new())
}

/// Finds the frames of a cube's faces: the requested ones, or all that any face has. One error names all that are
/// missing: faces by their names and the pattern of all.
pub(crate) fn find_of_faces(
    pattern: &str,
    faces: &[(&str, &ViewFiles)],
    inputs: &dyn Files,
    wanted: Option<&FrameList>,
) -> Result<Vec<Option<u64>>> {
    let (mut names, mut all) = (Vec::new(), Vec::new());
    for (name, files) in faces {
        if let Some(series) = Series::of(files, inputs)? {
            names.push(*name);
            all.push(series);
        }
    }
    find_in(&all, wanted, |lacking| {
        let names: Vec<&str> = lacking.iter().map(|face| names[*face]).collect();
        format!("{pattern} ({})", names.join(", "))
    })
}

impl<'a> Series<'a> {
    /// Returns the pictures of a view by frame; `None` if one picture is for all frames.
    fn of(files: &'a ViewFiles, inputs: &dyn Files) -> Result<Option<Self>> {
        Ok(match files {
            ViewFiles::One(_) => None,
            ViewFiles::Sequence(pattern) => Some(Self::Files(pattern)),
            ViewFiles::Video(video) => {
                let count = inputs.videos().map_or(Ok(Some(0)), |videos| videos.count(video))?;
                Some(Self::Video { name: video.display().to_string(), count })
            }
        })
    }

    fn existing(&self) -> Result<BTreeSet<u64>, IoError> {
        match self {
            Self::Files(pattern) => pattern.existing(),
            // Of a stream, the first; the others follow until it ends.
            Self::Video { count, .. } => Ok((0..count.unwrap_or(1)).collect()),
        }
    }

    /// Checks that all frames of a list, or any without one, exist.
    fn check(&self, list: Option<&FrameList>) -> Result<(), IoError> {
        match self {
            Self::Files(pattern) => Frames::find((*pattern).clone(), list).map(|_| ()),
            Self::Video { count: None, .. } => Ok(()),
            Self::Video { name, count: Some(count) } => {
                let missing = list.iter().flat_map(|list| list.frames()).copied().filter(|frame| frame >= count);
                let missing: Vec<u64> = missing.collect();
                if missing.is_empty() {
                    return Ok(());
                }
                Err(IoError::MissingFrames {
                    pattern: name.clone(),
                    count: missing.len(),
                    missing: FrameList::new(missing).to_string(),
                    existing: (0, count.saturating_sub(1)),
                })
            }
        }
    }
}

/// Finds the frames of several sequences; `called` returns a common name for the sequences with some indices.
fn find_in(
    sequences: &[Series],
    wanted: Option<&FrameList>,
    called: impl Fn(&[usize]) -> String,
) -> Result<Vec<Option<u64>>> {
    if sequences.is_empty() {
        return match wanted {
            Some(_) => Err(usage(format!(
                "{FRAMES} is given, but the input has no frame marker such as #### or %04d; write one where the frame number \
                 stands, or leave {FRAMES} out; where the camera moves ({YAW} A..B, {PATH}), a still picture has frames"
            ))),
            None => Ok(vec![None]),
        };
    }
    let list = match wanted {
        Some(list) => list.clone(),
        None => all_frames(sequences)?,
    };
    let missing = missing(sequences, &list, called);
    if !missing.is_empty() {
        bail!(NotFound: "{}", missing.join("\n       "));
    }
    Ok(list.frames().iter().copied().map(Some).collect())
}

/// Describes the missing frames of sequences, with those that lack the same ones on one line.
fn missing(sequences: &[Series], list: &FrameList, called: impl Fn(&[usize]) -> String) -> Vec<String> {
    let mut found: Vec<(Vec<usize>, IoError)> = Vec::new();
    for (index, series) in sequences.iter().enumerate() {
        let Err(error) = series.check(Some(list)) else { continue };
        match found.iter_mut().find(|(_, other)| is_alike(other, &error)) {
            Some((lacking, _)) => lacking.push(index),
            None => found.push((vec![index], error)),
        }
    }
    let told = |(lacking, mut error): (Vec<usize>, IoError)| {
        if let (2.., IoError::MissingFrames { pattern, .. }) = (lacking.len(), &mut error) {
            *pattern = called(&lacking);
        }
        error.to_string()
    };
    found.into_iter().map(told).collect()
}

/// Returns whether two sequences lack the same frames, and have the same first and last ones.
fn is_alike(a: &IoError, b: &IoError) -> bool {
    match (a, b) {
        (
            IoError::MissingFrames { missing: a, existing: of_a, .. },
            IoError::MissingFrames { missing: b, existing: of_b, .. },
        ) => a == b && of_a == of_b,
        _ => false,
    }
}

/// Returns the existing frames; none where there is no sequence.
///
/// # Errors
/// When the files are a sequence, but not one frame exists, or a video that cannot be read.
pub fn existing(files: &ViewFiles, inputs: &dyn Files) -> Result<Vec<u64>> {
    let Some(series) = Series::of(files, inputs)? else { return Ok(Vec::new()) };
    let frames = series.existing()?;
    if frames.is_empty() {
        // Searching for frames returns the best error when there is none.
        series.check(None)?;
    }
    Ok(frames.into_iter().collect())
}

/// Returns all frames from the first to the last of any view.
fn all_frames(sequences: &[Series]) -> Result<FrameList> {
    let mut existing = BTreeSet::new();
    for series in sequences {
        existing.extend(series.existing()?);
    }
    match (existing.first(), existing.last(), &sequences[0]) {
        (Some(&first), Some(&last), _) if last - first < Frames::MOST => Ok(FrameList::new(first..=last)),
        (Some(&first), Some(&last), Series::Files(pattern)) => {
            Err(IoError::FarFrames { pattern: pattern.as_str().to_owned(), existing: (first, last) }.into())
        }
        // Searching for frames of one sequence returns the best error when there is none.
        (.., Series::Files(pattern)) => Ok(Frames::find((*pattern).clone(), None)?.list().clone()),
        (.., Series::Video { name, .. }) => bail!(NotFound: "{name}: a video without a frame; make it again"),
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::source::Disk;

    /// Returns the messages about faces that have these frames, of which two are asked for.
    fn said(faces: &[(&str, &[u64])]) -> String {
        let folder = tempfile::tempdir().expect("a folder");
        let pattern = folder.path().join("{face}_##.png").display().to_string();
        let files: Vec<ViewFiles> =
            faces.iter().map(|(face, _)| ViewFiles::new(Path::new(&pattern.replace("{face}", face)))).collect();
        for ((_, frames), files) in faces.iter().zip(&files) {
            frames.iter().for_each(|frame| std::fs::write(files.path(Some(*frame)), "").expect("a file"));
        }
        let faces: Vec<_> = faces.iter().map(|(face, _)| *face).zip(&files).collect();
        let error =
            find_of_faces(&pattern, &faces, &Disk, Some(&FrameList::new([1, 2]))).expect_err("frames are missing");
        error.to_string().replace(&format!("{}/", folder.path().display()), "")
    }

    #[test]
    fn faces_that_lack_the_same_frames_share_a_line() {
        let rest = "the first that exists is 1, the last 1; make it";
        let all = said(&[("up", &[1]), ("down", &[1]), ("left", &[1])]);
        assert!(all.starts_with(&format!("{{face}}_##.png (up, down, left): 1 frame is missing: 2; {rest}")), "{all}");
        assert_eq!(all.lines().count(), 1, "{all}");
        let two = said(&[("up", &[1]), ("down", &[1, 2]), ("left", &[2]), ("right", &[1])]);
        let lines: Vec<&str> = two.lines().collect();
        assert!(lines[0].starts_with(&format!("{{face}}_##.png (up, right): 1 frame is missing: 2; {rest}")), "{two}");
        assert!(lines[1].trim().starts_with("left_##.png: 1 frame is missing: 1; ") && lines.len() == 2, "{two}");
    }
}
