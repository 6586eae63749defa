//! Damage before the first frame that is asked for.

use cosmorama::raster::FramePool;

use super::traces::traces;
use super::{Damaged, Fault, ReadOptions, VideoReader};
use crate::probe::CodedFrame;
use crate::{Ffmpeg, Timeline, VideoError, VideoInfo};

/// Damaged frames up to the first that is asked for.
#[derive(Debug, Default)]
pub(super) struct Preceding {
    /// Damaged frames after which some may take that are asked for.
    pub(super) faults: Vec<Fault>,
    /// First frame that may.
    pub(super) traced: u64,
    /// Fault of the first frame that is asked for.
    pub(super) own: Option<Fault>,
}

/// Finds which frames are damaged from the key frame before the first that is asked for. Messages alone do not tell: decoders complain
/// of frames that lack others before the place where they began, too.
pub(super) fn find(
    (ffmpeg, info, timeline): (&Ffmpeg, &VideoInfo, &Timeline),
    options: &ReadOptions,
    (first, last): (u64, u64),
) -> Result<Preceding, VideoError> {
    let coded = ffmpeg.coded_frames(&info.path, info.stream, &[])?;
    let frames = Some(key_before(&coded, timeline, first)..=first);
    // By one thread, messages come before their frames.
    let options = ReadOptions { frames, damaged: Damaged::Skip, threads: 1, ..options.clone() };
    let mut reader = VideoReader::looking_no_further(ffmpeg, info, options)?;
    let pool = FramePool::default();
    while reader.next_frame_in(&pool)?.is_some() {}
    let (mut own, mut faults) = (None, Vec::new());
    for fault in reader.faults().iter().cloned() {
        if fault.frame + fault.count > first {
            own = Some(fault.clone());
        }
        let count = fault.count.min(first.saturating_sub(fault.frame));
        faults.extend((count > 0).then_some(Fault { count, ..fault }));
    }
    let damaged: Vec<_> = faults.iter().map(|fault| fault.frame..fault.frame + fault.count).collect();
    let traced = if coded.is_empty() { vec![first] } else { traces(&coded, timeline, &damaged) };
    match traced.into_iter().find(|frame| (first..=last).contains(frame)) {
        Some(traced) => Ok(Preceding { faults, traced, own }),
        None => Ok(Preceding { own, ..Preceding::default() }),
    }
}

/// Returns the number of the last key frame that is shown before a frame; 0 where the file does not tell.
fn key_before(coded: &[CodedFrame], timeline: &Timeline, frame: u64) -> u64 {
    let keys = coded.iter().filter(|coded| coded.is_key).map(|coded| timeline.frame(coded.time));
    keys.filter(|key| *key < frame).max().unwrap_or(0)
}
