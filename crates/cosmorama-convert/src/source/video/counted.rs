//! Number of frames that a video file gives.

use cosmorama_video::{Announced, AnnouncedBy, CutShort, Damaged, Ffmpeg, VideoError, VideoInfo};

/// Returns the number of frames that a file gives. Where it announces none, as bare streams do, that is noted, so that its reader misses
/// those that are lost.
pub(super) fn count(ffmpeg: &Ffmpeg, info: &mut VideoInfo, damaged: Damaged) -> Result<u64, VideoError> {
    let frames = counted(ffmpeg, info, damaged)?;
    if info.cut.is_none() {
        info.announced.get_or_insert(Announced { frames, by: AnnouncedBy::Count });
    }
    Ok(frames)
}

/// Returns the number of frames that a file announces. Where only its duration tells, which may be rounded, its coded frames are
/// counted; of a file that is cut they would be too few, and nobody would miss the others. Those that were lost between others count.
fn counted(ffmpeg: &Ffmpeg, info: &VideoInfo, damaged: Damaged) -> Result<u64, VideoError> {
    let announced = match info.announced {
        Some(Announced { frames, by: AnnouncedBy::Count }) if !hides_frames(info, frames) => return Ok(frames),
        Some(Announced { frames, .. }) => Some(frames),
        None => None,
    };
    match (announced, info.cut) {
        (Some(frames), Some(_)) => return Ok(frames),
        (None, Some(CutShort { expected, found })) if damaged == Damaged::Error => {
            return Err(VideoError::Cut { path: info.path.clone(), expected, found, is_described: true });
        }
        _ => {}
    }
    // The times of a variable rate are listed one by one.
    let mut listed = info.clone();
    listed.is_variable = true;
    let times = ffmpeg.timeline(&listed)?;
    let coded = times.frames().unwrap_or_default();
    let last = coded.checked_sub(1).and_then(|last| times.time(last));
    let numbered = || -> Result<u64, VideoError> { Ok(ffmpeg.timeline(info)?.frame(last.unwrap_or(0)) + 1) };
    // Where a film without a number was cut out, its end may lack frames before its last.
    if announced.is_none() || hides_frames(info, announced.unwrap_or(coded)) {
        return Ok(numbered()?.max(coded));
    }
    let Some(frames) = announced.filter(|frames| coded < *frames) else { return Ok(coded) };
    // A duration may be rounded up by one frame. Where the last has the last number all the same, another was lost.
    let is_rounded = coded + 1 == frames && numbered()? < frames;
    Ok(if is_rounded { coded } else { frames })
}

/// Returns whether some of the frames that a file counts are not shown: the edit list of an MP4 that was cut without encoding it again
/// leaves them out, and its duration tells so.
fn hides_frames(info: &VideoInfo, counted: u64) -> bool {
    let is_count = matches!(info.announced, Some(Announced { by: AnnouncedBy::Count, .. }));
    // The edit list may begin within a frame, which is left out whole.
    let shown = |seconds: f64| (seconds * info.rate.to_f64() + 0.25).floor() as u64;
    is_count && info.cut.is_none() && info.duration.is_some_and(|seconds| shown(seconds) < counted)
}
