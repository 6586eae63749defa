use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use cosmorama::explain;
use cosmorama::render::Progress;
use cosmorama_io::FrameList;
use cosmorama_spec::TimeRanges;
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::advance::watched;
use super::run::stopped;
use super::{Observer, Quiet, Work, videos};
use crate::diagnostic::{Diagnostic, FRAMES, FROM, IN_PATH, Outcome, Result, bail, failure, usage};
use crate::engine::{FrameFile, Stage, Stages};
use crate::input::is_one_file;
use crate::input::lists::world_file;
use crate::job::{Content, ConvertJob, Purpose};
use crate::settings::{Backdrop, Conversion, GeometrySettings};
use crate::source::{Files, MemoryBudget, Name, ViewFiles, with_videos};

/// A conversion that has been checked as far as possible without decoding pixels.
pub struct Checked {
    pub(crate) settings: Conversion,
    pub(crate) content: Content,
    pub(crate) job: ConvertJob,
    /// Threads of the conversion.
    pub(crate) pool: ThreadPool,
    /// Diagnostics so far.
    pub(crate) diagnostics: Vec<Diagnostic>,
    pub(crate) stages: Stages,
    pub(crate) start: Instant,
    /// Memory that may be used in all.
    pub(crate) allowed: MemoryBudget,
}

impl Conversion {
    /// Checks the settings against the files. Only headers are read, and pixels only where nothing else tells the
    /// projection. Diagnostics are valid with an error, too: the cause may be a wrong guess.
    pub fn check(self) -> Outcome<Checked> {
        self.check_watched(&mut Quiet)
    }

    /// Checks the settings against the files, as [`check`](Self::check) does, while an observer is told how far that is: along a camera's
    /// path, each frame is looked at.
    pub fn check_watched(self, observer: &mut dyn Observer) -> Outcome<Checked> {
        let mut diagnostics = Vec::new();
        let result = self.checked(&mut diagnostics, observer);
        Outcome { result, diagnostics }
    }

    fn checked(self, diagnostics: &mut Vec<Diagnostic>, observer: &mut dyn Observer) -> Result<Checked> {
        let (start, stages) = (Instant::now(), Stages::default());
        let settings = with_frames_at_times(with_layers(self)?)?;
        let content = Content::of(&settings)?;
        let pool = threads(settings.limits.threads)?;
        let allowed = MemoryBudget::new(settings.limits.memory);
        let mut resolve = |progress: &dyn Progress| {
            let job = || ConvertJob::resolve(&settings, (content, Purpose::Pictures), (diagnostics, progress));
            stages.alone(Stage::Plan, job)
        };
        let job = if settings.moves() {
            watched(&pool, observer, Work::Path, resolve).unwrap_or_else(|| Err(stopped((0, None))))?
        } else {
            pool.install(|| resolve(&|_| ControlFlow::Continue(())))?
        };
        if content.has_files() {
            let check = || job.layers().try_for_each(FrameFile::check_frames);
            pool.install(|| stages.alone(Stage::Decode, check))?;
        }
        videos::check(&settings, &job)?;
        diagnostics.extend(videos::idle(&settings, &job));
        diagnostics.extend(videos::without_times(&job)?);
        diagnostics.extend(videos::single(&settings, &job));
        let diagnostics = diagnostics.clone();
        Ok(Checked { settings, content, job, pool, diagnostics, stages, start, allowed })
    }
}

impl Checked {
    /// Explains the conversion. For each picture it returns the name and a report of the parts of each view that it
    /// shows, with their magnification. Formulas have no views.
    pub fn explain(&self) -> Vec<(String, explain::Report)> {
        let Self { job, pool, content, .. } = self;
        let views = job.target.views.iter().filter(|_| content.has_files());
        let report = |target: &crate::target::TargetView| {
            (target.name.clone(), explain::Report::of(job.world(target), &target.view, &job.filter))
        };
        pool.install(|| views.map(report).collect())
    }
}

/// Puts the layers of a world file in place of its name: the first is the input, and the others lie behind it, before a
/// backdrop.
fn with_layers(mut settings: Conversion) -> Result<Conversion> {
    // What is wrong with the file is told when the input is read, after mistakes in the settings.
    let layers = world_file::layers(&settings.input, &*settings.files).unwrap_or_default();
    if layers.is_empty() {
        return Ok(settings);
    }
    if settings.light.is_some() {
        return Err(usage(format!("{} has layers, but light is that of one world; name one of them", settings.input)));
    }
    if settings.geometry.from.is_some() || settings.geometry.in_path.is_some() {
        let name = &settings.input;
        return Err(usage(format!(
            "{name} has layers, each with a spec and a path of its own; leave {FROM} and {IN_PATH} out"
        )));
    }
    let mut front = settings.backdrop.take();
    for layer in layers.into_iter().rev() {
        front = Some(Backdrop { behind: front.map(Box::new), ..layer });
    }
    if let Some(Backdrop { input, from, in_path, opacity, behind, .. }) = front {
        settings.backdrop = behind.map(|behind| *behind);
        settings.geometry = GeometrySettings { from, in_path, ..settings.geometry };
        settings = Conversion { input, opacity, ..settings };
    }
    Ok(settings)
}

/// Puts the numbers of a video's frames in place of the times that are asked for.
fn with_frames_at_times(settings: Conversion) -> Result<Conversion> {
    let Some(times) = &settings.times else { return Ok(settings) };
    let files = with_videos(Arc::clone(&settings.files));
    let frames = frames_at_times(times, &settings.input, &*files)?;
    Ok(Conversion { frames: Some(frames), ..settings })
}

/// Returns the numbers of a video's frames at the times that are asked for.
pub(super) fn frames_at_times(times: &TimeRanges, input: &Name, files: &dyn Files) -> Result<FrameList> {
    let refused =
        |why: &str| Err(usage(format!("{FRAMES} {times}: {input} {why}; give numbers of frames, as in {FRAMES} 0-99")));
    let video = ViewFiles::new(Path::new(input));
    let Some((video, videos)) = video.video().zip(files.videos()) else {
        return refused("is no video, whose frames have times");
    };
    is_one_file(files, input, video)?;
    let Some(count) = videos.count(video)? else { return refused("is a stream whose end is not known") };
    let (frames, beyond, rate) = match (videos.rate(video)?, videos.begins(video)?) {
        (Some(rate), _) => {
            let length = format!("at {rate} a second, until {}", TimeRanges::time_of(rate, count));
            (FrameList::new(times.frames(rate, count)), times.beyond(rate, count), length)
        }
        (None, Some(begins)) => {
            let frames = FrameList::new(times.frames_among(&begins));
            (frames, times.beyond_among(&begins), "at a rate that varies".to_owned())
        }
        (None, None) => return refused("says no frame rate"),
    };
    if let Some(range) = beyond {
        bail!(NotFound: "{FRAMES} {range}: {input} ends before that; it has {count} frames, {rate}");
    }
    if frames.frames().is_empty() {
        bail!(NotFound: "{FRAMES} {times}: {input} has no frame then; it has {count}, {rate}");
    }
    Ok(frames)
}

/// Starts a pool of threads.
pub fn threads(count: Option<usize>) -> Result<ThreadPool> {
    let pool = ThreadPoolBuilder::new().num_threads(count.unwrap_or(0)).build();
    pool.map_err(|error| failure!("cannot start threads: {error}"))
}
