use std::collections::BTreeSet;

use cosmorama_io::{FrameList, FramePattern, Frames};

use crate::diagnostic::{FRAMES, Result, bail, usage};
use crate::input::ViewFiles;

/// Finds the frames to work on: the requested ones, or all that any view has. `[None]` where there is no sequence.
///
/// All missing frames of all views are named in one error.
pub(crate) fn find<'a>(
    files: impl Iterator<Item = &'a ViewFiles> + Clone,
    wanted: Option<&FrameList>,
) -> Result<Vec<Option<u64>>> {
    let sequences: Vec<&FramePattern> = files.filter_map(ViewFiles::sequence).collect();
    if sequences.is_empty() {
        return match wanted {
            Some(_) => Err(usage(format!(
                "{FRAMES} is given, but the input has no frame marker such as #### or %04d; write one where the frame number \
                 stands, or leave {FRAMES} out"
            ))),
            None => Ok(vec![None]),
        };
    }
    let list = match wanted {
        Some(list) => list.clone(),
        None => all_frames(&sequences)?,
    };
    let missing: Vec<String> = sequences
        .iter()
        .filter_map(|pattern| Frames::find((*pattern).clone(), Some(&list)).err())
        .map(|error| error.to_string())
        .collect();
    if !missing.is_empty() {
        bail!(NotFound: "{}", missing.join("\n       "));
    }
    Ok(list.frames().iter().copied().map(Some).collect())
}

/// Returns the existing frames; none where there is no sequence.
///
/// # Errors
/// When the files are a sequence, but not one frame exists.
pub fn existing(files: &ViewFiles) -> Result<Vec<u64>> {
    let Some(pattern) = files.sequence() else { return Ok(Vec::new()) };
    let frames = pattern.existing()?;
    if frames.is_empty() {
        // The search for them says best that there is none.
        Frames::find(pattern.clone(), None)?;
    }
    Ok(frames.into_iter().collect())
}

/// Returns all frames from the first to the last of any view.
fn all_frames(sequences: &[&FramePattern]) -> Result<FrameList> {
    let mut existing = BTreeSet::new();
    for pattern in sequences {
        existing.extend(pattern.existing()?);
    }
    match (existing.first(), existing.last()) {
        (Some(&first), Some(&last)) if last - first < 10_000_000 => Ok(FrameList::new(first..=last)),
        // The search for one of them says best that there is none.
        _ => Ok(Frames::find(sequences[0].clone(), None)?.list().clone()),
    }
}
