//! Frames beside those over which a camera turns.

use std::collections::{BTreeSet, HashSet};

use cosmorama_io::FrameList;

use super::numbered_frames;
use crate::diagnostic::{Code, Diagnostic, FRAMES, PATH, RESUME};
use crate::job::ConvertJob;
use crate::target::Movement;

/// Returns the warning about frames that exist, and are none of those over which the camera turns: theirs was another turn, as where a
/// few frames of a turn are made again.
pub(crate) fn frames_beside_turn(job: &ConvertJob) -> Option<Diagnostic> {
    let is_turn = job.movement.as_ref().is_some_and(Movement::is_turn);
    if !is_turn || job.target.format.is_video() {
        return None;
    }
    let made: HashSet<u64> = job.input.frames.iter().copied().flatten().collect();
    let others: Vec<u64> = numbered_frames(&job.target).filter(|frame| !made.contains(frame)).collect();
    let first = job.target.files.first()?.files.path(others.first().copied()).display().to_string();
    let count = match others.len() {
        0 => return None,
        1 => "exists, and is".to_owned(),
        count => format!("and {} more exist, and are", count - 1),
    };
    let turn = FrameList::new(made.into_iter().collect::<BTreeSet<_>>()).to_string();
    let message = format!(
        "{first} {count} no part of this turn, which goes from the first frame of {FRAMES} {turn} to the last; to make some frames of a longer \
         turn again, remove them and give all of its frames with {RESUME}, or give a {PATH}"
    );
    Some(Diagnostic::warning(Code::Exists, message))
}
