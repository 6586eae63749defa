use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;

use cosmorama::raster::Threads;
use cosmorama::render::Progress;
use cosmorama_io::FrameList;
use cosmorama_spec::Spec;
use rayon::ThreadPool;
use rayon::prelude::*;

use super::report::{Further, LeftOut};
use super::{Checked, Observer, Report, Stop, Work, decisions, threads, videos, watched};
use crate::diagnostic::{Code, ConvertError, DAMAGED, DEPTH, Diagnostic, Result, SCALE};
use crate::engine::unfiltered::{OutputFile, formula, st_map};
use crate::engine::{
    Engine, FrameFile, FrameLight, FrameWords, InterpolationReport, Levels, LightReport, Sequence, Spent, Stage,
    Stages, ViewImage, Watcher, Which, WriterOptions, warnings,
};
use crate::job::options::write_options;
use crate::job::{Content, ConvertJob, FrameOutputs};
use crate::settings::LightSettings;
use crate::source::video::{DamagedFrames, FrameName, Videos};

/// Threads that wait for disks while a sequence is made.
const WAITING: usize = 8;

impl Checked {
    /// Makes the outputs. Each appears whole or not at all.
    ///
    /// # Errors
    /// When a file cannot be read or written, its content contradicts its header, or the observer stops the run.
    pub fn run(mut self, observer: &mut dyn Observer) -> Result<Report> {
        observer.begin(self.job.outputs.count());
        self.decisions().iter().for_each(|decision| observer.decided(decision));
        let (mut lit, mut interpolated, mut further) = (Vec::new(), Vec::new(), Further::default());
        let options = self.writer_options(observer)?;
        let videos = Arc::clone(&options.videos);
        let mut estimated = self.job.estimated_bytes(self.pool.current_num_threads());
        match self.content {
            Content::World => (lit, interpolated, estimated, further) = self.convert(observer, options)?,
            Content::StMap => self.each_file(observer, st_map::make)?,
            Content::Formula(world) => {
                self.each_file(observer, |output| formula::picture(output, world, &options))?;
            }
            Content::Directions(map) => self.each_file(observer, |output| formula::directions(output, map))?,
        }
        // What a decoder says at the end of its video must be known before outputs appear.
        self.job.layers().filter_map(|layer| layer.files.videos()).try_for_each(Videos::end)?;
        let finished = self.stages.alone(Stage::Encode, || videos.finish())?;
        self.tell(observer, finished.into_iter().chain(damaged_frames(&self.job)).collect());
        let Self { job, settings, stages, diagnostics, start, content, .. } = self;
        let inputs: BTreeSet<PathBuf> = if content.has_files() {
            let paths = job.outputs.frames.iter().flat_map(|frame| job.paths(frame.frame));
            paths.map(|path| FrameName::file(&path)).collect()
        } else {
            BTreeSet::from([PathBuf::from(&settings.input)])
        };
        let report = Report::new(inputs, (&job.outputs, further), start.elapsed(), &stages, diagnostics);
        let codec_memory_bytes = job.memory.codecs;
        Ok(Report { light: lit, interpolated, estimated_memory_bytes: estimated, codec_memory_bytes, ..report })
    }

    /// Returns the options of the writer. The encoders of videos are started with it.
    fn writer_options(&mut self, observer: &mut dyn Observer) -> Result<WriterOptions> {
        let files = write_options(&self.settings, self.job.target.format, &self.job.outputs, &self.job.light);
        let mut told = Vec::new();
        let videos = videos::start(&self.settings, &self.job, &mut told)?;
        self.tell(observer, told);
        Ok(WriterOptions { files, videos: Arc::new(videos) })
    }

    fn tell(&mut self, observer: &mut dyn Observer, told: Vec<Diagnostic>) {
        told.iter().for_each(|diagnostic| observer.diagnostic(diagnostic));
        self.diagnostics.extend(told);
    }

    /// Makes one file after the other.
    fn each_file(&self, observer: &mut dyn Observer, make: impl Fn(&OutputFile) -> Result<()> + Sync) -> Result<()> {
        let Self { job, stages, settings, pool, .. } = self;
        let unfinished = &settings.unfinished;
        let frames = &job.outputs.frames;
        for (done, FrameOutputs { frame, files }) in (1..).zip(frames) {
            let (views, exposure) = (&job.views_in(job.pose(*frame).as_ref())?[..], &job.exposure(*frame)?[..]);
            let make = |(index, path): &(usize, PathBuf)| {
                let place = done - 1;
                make(&OutputFile {
                    job,
                    frame: *frame,
                    place,
                    views,
                    exposure,
                    stages,
                    unfinished,
                    index: *index,
                    path,
                })
            };
            pool.install(|| files.iter().try_for_each(make))?;
            tell_done(observer, *frame, (done, Some(frames.len())))?;
        }
        Ok(())
    }

    /// Converts the light of files.
    fn convert(&mut self, observer: &mut dyn Observer, options: WriterOptions) -> Result<Converted> {
        let Self { settings, job, pool, stages, diagnostics, .. } = self;
        let prepare = |progress: &dyn Progress| stages.alone(Stage::Plan, || Engine::new(job, options, progress));
        let engine = watched(pool, observer, Work::Plan, prepare).and_then(Result::ok);
        let Some(engine) = &engine else { return Err(stopped((0, job.outputs.count()))) };
        let from = settings.geometry.from.as_ref();
        let tally = warnings::Tally::default();
        let mut run = Run {
            job,
            engine,
            stages,
            pool,
            observer,
            diagnostics,
            from,
            tally,
            is_first: true,
            done: 0,
            files: Vec::new(),
            left_out: LeftOut::default(),
            stale: Vec::new(),
        };
        run.tell(engine.told());
        engine.decisions().iter().for_each(|decision| run.observer.decided(decision));
        let estimated = pool.install(|| engine.estimated_bytes());
        let made = match &job.outputs.frames[..] {
            [] => Ok(Vec::new()),
            // A frame that may be left out has no picture.
            [frame] if !job.outputs.go_on && settings.video.damaged != DamagedFrames::Skip => {
                run.still(frame).map(|()| Vec::new())
            }
            _ => {
                // Pictures of videos wait for no disk.
                let disks = &threads(Some(if job.target.format.is_video() { 1 } else { WAITING }))?;
                let sequence = Sequence { job, engine, stages, pool, disks };
                stages.among(Stage::Filter, || sequence.run(&mut run))
            }
        };
        let mut told = engine.told();
        told.extend(run.tally.warnings(job));
        told.extend(stale(&run.stale));
        told.extend(engine.tallied_behind());
        // Maps of light are measured by frame.
        let output = &*settings.output;
        if job.lighting.is_none() && (job.light.depth.is_float() || warnings::is_of_any_range(job)) {
            told.extend(too_bright((job, output), (None, 0), engine.writer().overflowed()));
        }
        run.tell(told);
        // Frames that were being written at a stop are done by now.
        let interpolated =
            made.map_err(|error| if let ConvertError::Stopped { .. } = error { run.stopped() } else { error })?;
        let lit = engine.light_reports();
        let told =
            lit.iter().filter_map(|report| too_bright((job, output), (report.frame, report.level), report.overflowed));
        run.tell(told.chain(lit.first().and_then(|report| fitted(job, output, report.scale))).collect());
        let frames = run.done.saturating_sub(job.outputs.frames.len());
        let further = Further { frames, files: run.files, left_out: run.left_out };
        Ok((lit, interpolated, estimated, further))
    }
}

/// Returns the warnings about damaged frames of videos in place of which others were shown.
fn damaged_frames(job: &ConvertJob) -> Vec<Diagnostic> {
    let makes_film = job.target.format.is_video();
    let videos = job.layers().filter_map(|layer| layer.files.videos());
    videos
        .flat_map(|videos| videos.complaints(makes_film))
        .map(|message| Diagnostic::warning(Code::DamagedFrames, message))
        .collect()
}

/// Figures of maps of light, differences of interpolated ones, the memory that was expected to be needed, and frames of a stream after
/// its first.
type Converted = (Vec<LightReport>, Vec<InterpolationReport>, u64, Further);

/// Returns the warning about light that was scaled to fit the output's sample type.
fn fitted(job: &ConvertJob, output: &str, scale: f64) -> Option<Diagnostic> {
    let is_asked = job.lighting.as_ref().is_some_and(LightSettings::fits);
    (is_asked && scale != 1.0).then(|| {
        let message = format!(
            "{output}: the light is written times {scale}, so that all of it fits {DEPTH} {}; times {} it is what it was (lightScale in \
             files that have a place for it)",
            job.light.depth,
            scale.recip()
        );
        Diagnostic::warning(Code::TooBright, message)
    })
}

/// Returns the warning about light that the output's sample type cannot hold.
fn too_bright(
    (job, output): (&ConvertJob, &str),
    (frame, level): (Option<u64>, usize),
    samples: usize,
) -> Option<Diagnostic> {
    let mut place = format!("{output}: ");
    if let Some(frame) = frame {
        place += &format!("frame {frame}: ");
    }
    if level > 0 {
        place += &format!("level {level}: ");
    }
    let scale = if job.lighting.is_some() { format!(", or give {SCALE} auto") } else { String::new() };
    (samples > 0).then(|| {
        let message = format!(
            "{place}{samples} {} brighter than {DEPTH} {} holds, and {} cut to its largest; write OpenEXR, Radiance, KTX 2 or \
             DDS files with {DEPTH} float{scale}",
            if samples == 1 { "sample is" } else { "samples are" },
            job.light.depth,
            if samples == 1 { "is" } else { "are" }
        );
        Diagnostic::warning(Code::TooBright, message)
    })
}

/// A conversion of light under way.
struct Run<'a> {
    job: &'a ConvertJob,
    engine: &'a Engine<'a>,
    stages: &'a Stages,
    pool: &'a ThreadPool,
    observer: &'a mut dyn Observer,
    diagnostics: &'a mut Vec<Diagnostic>,
    /// Declared projection of the input.
    from: Option<&'a Spec>,
    /// Counts of pixels that are told of once for all frames.
    tally: warnings::Tally,
    /// Whether no frame has been examined yet.
    is_first: bool,
    /// Number of frames written so far.
    done: usize,
    /// Files of frames that were not known at the beginning.
    files: Vec<PathBuf>,
    /// Frames that are left out.
    left_out: LeftOut,
    /// Numbers of those in whose places there are files.
    stale: Vec<u64>,
}

impl Run<'_> {
    /// Makes a single picture, stage by stage, each with all threads, and frees memory as early as possible.
    fn still(&mut self, frame: &FrameOutputs) -> Result<()> {
        let Self { job, engine, stages, pool, .. } = *self;
        let light = pool.install(|| light_of(job, engine, stages, frame))?;
        self.look(frame, &light);
        let pictures = stages.alone(Stage::Filter, || self.render(frame, &light))?;
        let (carried, origin) = (light.carried(), job.origin_of(frame.frame)?);
        light.check_unchanged(job)?;
        drop(light);
        let write = || {
            let outputs = frame.files.par_iter().zip(pictures);
            let words = FrameWords { place: 0, carried, origin: origin.map(Arc::from) };
            let save = |path, levels| engine.writer().save(words.clone(), levels, path, Threads::All);
            outputs.try_for_each(|((_, path), levels)| save(path, levels))
        };
        pool.install(|| stages.alone(Stage::Encode, write))?;
        self.done(frame)
    }
}

impl Watcher for Run<'_> {
    fn look(&mut self, frame: &FrameOutputs, light: &FrameLight) {
        self.tally.add(self.job, frame.frame, light);
        // The first frame tells how the faces lie.
        let (job, engine, is_first) = (self.job, self.engine, std::mem::take(&mut self.is_first));
        let found = self.pool.install(|| {
            let continuity = if is_first { engine.continuity(light) } else { None };
            let circle = self.from.filter(|_| is_first).and_then(|from| warnings::circle(job, from, light));
            engine.warnings(frame.frame, light).into_iter().chain(continuity).chain(circle).collect()
        });
        self.tell(found);
    }

    fn render(&mut self, frame: &FrameOutputs, light: &FrameLight) -> Result<Vec<Levels>> {
        let engine = self.engine;
        let render = |progress: &dyn Progress| engine.render(frame, light, progress);
        watched(self.pool, self.observer, Work::Render(frame.frame), render).unwrap_or_else(|| Err(self.stopped()))
    }

    fn left_out(&mut self, frame: &FrameOutputs) {
        let has_files = !self.job.target.format.is_video();
        let files = frame.files.iter().filter(|_| has_files).map(|(_, path)| path.clone());
        self.left_out.frames += 1;
        self.left_out.files.extend(files);
        let is_there = has_files && frame.files.iter().any(|(_, path)| path.exists());
        self.stale.extend(frame.frame.filter(|_| is_there));
    }

    fn done(&mut self, frame: &FrameOutputs) -> Result<()> {
        self.done += 1;
        // A video is one file of all frames, and named already.
        if self.done > self.job.outputs.frames.len() && !self.job.target.format.is_video() {
            self.files.extend(frame.files.iter().map(|(_, path)| path.clone()));
        }
        decisions::of_done(self.job, frame).iter().for_each(|decision| self.observer.decided(decision));
        tell_done(self.observer, frame.frame, (self.done, self.job.outputs.count()))
    }
}

impl Run<'_> {
    fn tell(&mut self, found: Vec<Diagnostic>) {
        found.iter().for_each(|diagnostic| self.observer.diagnostic(diagnostic));
        self.diagnostics.extend(found);
    }

    fn stopped(&self) -> ConvertError {
        stopped((self.done, self.job.outputs.count()))
    }
}

/// Returns the warning about files in the places of frames that are left out.
fn stale(frames: &[u64]) -> Option<Diagnostic> {
    let which = FrameList::new(frames.iter().copied());
    let message =
        format!("{DAMAGED}: of frames that are left out, there are files from an earlier run: {which}; remove these");
    (!frames.is_empty()).then(|| Diagnostic::warning(Code::DamagedFrames, message))
}

/// Creates the error of a stop, when `done` of all `frames` are written.
pub(super) fn stopped((done, frames): (usize, Option<usize>)) -> ConvertError {
    ConvertError::Stopped { done, frames }
}

/// Calls an observer after a frame, when `done` of all `frames` are written. Returns an error if it stops the run early.
fn tell_done(observer: &mut dyn Observer, frame: Option<u64>, (done, frames): (usize, Option<usize>)) -> Result<()> {
    match observer.frame_done(frame) {
        ControlFlow::Break(Stop) if frames.is_none_or(|frames| done < frames) => Err(stopped((done, frames))),
        _ => Ok(()),
    }
}

/// Reads the files of a frame and decodes them to light.
pub(super) fn light_of(job: &ConvertJob, engine: &Engine, stages: &Stages, frame: &FrameOutputs) -> Result<FrameLight> {
    let mut light = engine.frame_light();
    let images = stages.alone(Stage::Decode, || {
        let files = FrameFile::all(job, frame.frame, Which::All).into_par_iter();
        // In the order of files, so that of several errors it is always the same that is told.
        files.map(|file| file.read(job, engine.pool())).collect::<Vec<_>>().into_iter().collect::<Result<Vec<_>>>()
    })?;
    let mut images: Vec<ViewImage> = images.into_iter().flatten().collect();
    light.fill(job, frame.frame, (&mut images, Spent::Freed), (stages, engine.pool()))?;
    Ok(light)
}
