//! Videos that a conversion makes: what is known of them before their first frame.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::diagnostic::{Code, DAMAGED, Diagnostic, FRAMES, Result, YAW};
use crate::job::ConvertJob;
use crate::settings::Conversion;
use crate::source::video::{DamagedFrames, MadeVideos, RawKind, VideoPlan, VideoSource};
use crate::target::TargetFile;

/// Checks the settings of the videos that are made, if there are any.
pub(super) fn check(settings: &Conversion, job: &ConvertJob) -> Result<()> {
    let outputs = outputs(job);
    if outputs.is_empty() { Ok(()) } else { MadeVideos::check(&outputs, &plan(settings, job), job.files.videos()) }
}

/// Returns a warning where an answer to damaged frames is given, and no input is a film.
pub(super) fn idle(settings: &Conversion, job: &ConvertJob) -> Option<Diagnostic> {
    let is_film = |path: &Path| RawKind::of(path).is_none();
    let is_idle = settings.video.damaged != DamagedFrames::Error && !takes(job, is_film);
    let message = || {
        format!(
            "{DAMAGED} has no effect: no input is a film; a damaged picture, or a stream of pictures that is cut, is an error"
        )
    };
    is_idle.then(|| Diagnostic::warning(Code::NoEffect, message()))
}

/// Returns whether some of a job's inputs are such videos.
fn takes(job: &ConvertJob, is_such: impl Fn(&Path) -> bool) -> bool {
    job.layers().any(|job| job.input.present().any(|(view, ..)| view.files.video().is_some_and(&is_such)))
}

/// Returns the warning about a film of a single frame, where nobody asked for that.
pub(super) fn single(settings: &Conversion, job: &ConvertJob) -> Option<Diagnostic> {
    let is_asked = settings.frames.is_some() || takes(job, |_| true);
    let (film, _) = outputs(job).into_iter().next().filter(|_| job.outputs.count() == Some(1) && !is_asked)?;
    let message = || {
        format!(
            "{}: a film of a single frame, since no input has more; for a camera that turns, give {FRAMES} and {YAW} A..B",
            film.display()
        )
    };
    RawKind::of(&film).is_none().then(|| Diagnostic::warning(Code::NoEffect, message()))
}

/// Returns the warnings about films whose rate varies, of which pictures are made: they have no times.
pub(super) fn without_times(job: &ConvertJob) -> Result<Vec<Diagnostic>> {
    let is_sequence = job.outputs.count() != Some(1) && !job.target.format.is_video();
    let films = job.input.present().filter_map(|(view, ..)| view.files.video()).filter(|_| is_sequence);
    let films: BTreeSet<&Path> = films.collect();
    let mut told = Vec::new();
    for film in films {
        let varies = job.files.videos().map_or(Ok(false), |videos| videos.varies(film))?;
        let message = || {
            format!(
                "{}: its rate varies, and numbered pictures have no times: a film of them at one rate leaves its sound; write \
                 a film at once to keep both",
                film.display()
            )
        };
        told.extend(varies.then(|| Diagnostic::warning(Code::FrameRate, message())));
    }
    Ok(told)
}

/// Starts the encoders of the videos that are made.
pub(super) fn start(settings: &Conversion, job: &ConvertJob, told: &mut Vec<Diagnostic>) -> Result<MadeVideos> {
    let (plan, videos) = (plan(settings, job), job.files.videos());
    MadeVideos::start(&outputs(job), (&plan, videos), (settings.sink.as_ref(), &settings.unfinished), told)
}

/// Returns the videos to make, with their sizes.
fn outputs(job: &ConvertJob) -> Vec<(PathBuf, (usize, usize))> {
    if job.outputs.frames.is_empty() {
        return Vec::new();
    }
    let output = |file: &TargetFile| Some((file.files.video()?.to_owned(), file.sheet.size));
    job.target.files.iter().filter_map(output).collect()
}

fn plan(settings: &Conversion, job: &ConvertJob) -> VideoPlan {
    let (count, frames): (_, Vec<u64>) =
        (job.outputs.count(), job.outputs.frames.iter().filter_map(|frame| frame.frame).collect());
    let video = job.input.present().find_map(|(view, ..)| view.files.video());
    VideoPlan {
        settings: settings.video.clone(),
        to: settings.geometry.to.clone(),
        depth: job.light.depth,
        channels: job.light.channels,
        transfer: job.light.transfer.clone(),
        primaries: job.light.working.primaries,
        frames: count.map(|count| count as u64),
        source: video.map(|video| VideoSource { video: video.to_owned(), frames }),
    }
}
