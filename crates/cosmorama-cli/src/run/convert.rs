use std::collections::BTreeSet;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use anyhow::Result;
use rayon::prelude::*;

use super::engine::Engine;
use super::frame_files::{FrameFile, ViewImage, Which};
use super::frame_light::FrameLight;
use super::pipe::Piped;
use super::progress::Progress;
use super::report::Report;
use super::sequence::Sequence;
use super::stages::{Stage, Stages};
use super::{print, use_threads};
use crate::args::ConvertArgs;
use crate::failure::warn;
use crate::job::{Builtin, ConvertJob, FrameOutputs, write_options};

/// Converts, and tells what it has done.
pub(super) fn run(args: &ConvertArgs) -> Result<ExitCode> {
    use_threads(args.limits.threads)?;
    let piped = Piped::open(args)?;
    let report = convert(&piped.args)?;
    piped.finish()?;
    if args.json {
        print(&report.to_json()?)?;
    } else if args.progress.is_for_people() {
        report.tell();
    }
    Ok(ExitCode::SUCCESS)
}

/// Converts.
pub(super) fn convert(args: &ConvertArgs) -> Result<Report> {
    if args.st_map {
        return super::st_map::convert(args);
    }
    if let Some(builtin) = Builtin::named(&args.input)? {
        return super::builtin::convert(builtin, args);
    }
    let start = Instant::now();
    let stages = Stages::default();
    let job = stages.alone(Stage::Plan, || ConvertJob::resolve(args))?;
    let engine = stages
        .alone(Stage::Plan, || Engine::new(&job, write_options(args, job.target.format, &job.outputs, &job.light)));
    engine.told().iter().for_each(|warning| warn(warning));
    let warnings = [&job.warnings[..], engine.told()].concat();
    let mut run = Run { job: &job, engine: &engine, stages: &stages, warnings, is_first: true };
    let mut progress = Progress::new(args.progress, job.outputs.frames.len());
    match &job.outputs.frames[..] {
        [] => {}
        [frame] => {
            run.still(frame)?;
            progress.frame_done(frame.frame);
        }
        _ => {
            let sequence = Sequence { job: &job, engine: &engine, stages: &stages };
            let look = |frame: &FrameOutputs, light: &FrameLight| run.look(frame, light);
            stages.among(Stage::Filter, || sequence.run(look, |frame| progress.frame_done(frame.frame)))?;
        }
    }
    progress.finish();
    let inputs: BTreeSet<PathBuf> = job.outputs.frames.iter().flat_map(|frame| job.input.paths(frame.frame)).collect();
    Ok(Report::new(inputs, &job.outputs, start.elapsed(), &stages, run.warnings))
}

/// A conversion under way.
struct Run<'a> {
    job: &'a ConvertJob,
    engine: &'a Engine<'a>,
    stages: &'a Stages,
    warnings: Vec<String>,
    /// Whether no frame has been looked at yet.
    is_first: bool,
}

impl Run<'_> {
    /// A single picture: stage by stage, each with all threads, and in memory no longer than it is needed.
    fn still(&mut self, frame: &FrameOutputs) -> Result<()> {
        let Self { job, engine, stages, .. } = *self;
        let mut light = engine.frame_light();
        let images = stages.alone(Stage::Decode, || {
            let files = FrameFile::all(job, frame.frame, Which::All).into_par_iter();
            // In the order of files, so that of several errors it is always the same that is told.
            files.map(|file| file.read(job)).collect::<Vec<_>>().into_iter().collect::<Result<Vec<_>>>()
        })?;
        let images: Vec<ViewImage> = images.into_iter().flatten().collect();
        light.fill(job, frame.frame, &images, stages)?;
        drop(images);
        self.look(frame, &light);
        let pictures = stages.alone(Stage::Filter, || engine.render(frame, &light, Vec::new()))?;
        drop(light);
        stages.alone(Stage::Encode, || {
            let outputs = frame.files.par_iter().zip(pictures);
            outputs.try_for_each(|((_, path), levels)| engine.writer().save(levels, path))
        })
    }

    /// Tells what should be known about the light of a frame.
    fn look(&mut self, frame: &FrameOutputs, light: &FrameLight) {
        // The first frame tells how the faces lie.
        let continuity = if self.is_first { self.engine.continuity(light) } else { None };
        self.is_first = false;
        for warning in self.engine.warnings(frame.frame, light).into_iter().chain(continuity) {
            warn(&warning);
            self.warnings.push(warning);
        }
    }
}
