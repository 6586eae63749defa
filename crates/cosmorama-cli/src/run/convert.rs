use std::collections::BTreeSet;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use anyhow::Result;
use cosmorama_io::WriteOptions;
use rayon::prelude::*;

use super::engine::{Engine, Picture, save};
use super::frame_light::FrameLight;
use super::pipe::Piped;
use super::progress::Progress;
use super::report::Report;
use super::stages::{Stage, Stages};
use super::{print, use_threads};
use crate::args::ConvertArgs;
use crate::failure::warn;
use crate::job::{Builtin, ConvertJob, FrameOutputs};

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
    let mut stages = Stages::default();
    let job = stages.time(Stage::Plan, || ConvertJob::resolve(args))?;
    let engine = stages.time(Stage::Plan, || Engine::new(&job));
    let progress = Progress::new(args.progress, job.outputs.frames.len());
    let mut run = Run { args, engine, stages, progress, warnings: job.warnings.clone(), is_first: true };
    let mut lights = Vec::new();
    for frames in job.outputs.frames.chunks(run.engine.batch()) {
        run.batch(frames, &mut lights)?;
    }
    run.progress.finish();
    let inputs: BTreeSet<PathBuf> = job.outputs.frames.iter().flat_map(|frame| job.input.paths(frame.frame)).collect();
    let outputs =
        job.outputs.frames.iter().flat_map(|frame| frame.files.iter().map(|(_, path)| path.clone())).collect();
    let counts = (job.outputs.frames.len(), job.outputs.skipped);
    Ok(Report::new(inputs, outputs, counts, start.elapsed(), run.stages, run.warnings))
}

/// A conversion under way.
struct Run<'a> {
    args: &'a ConvertArgs,
    engine: Engine<'a>,
    stages: Stages,
    progress: Progress,
    warnings: Vec<String>,
    /// Whether no frame has been looked at yet.
    is_first: bool,
}

impl Run<'_> {
    /// Some frames at once, stage by stage. Where one cannot be read, those before it are finished first.
    fn batch(&mut self, frames: &[FrameOutputs], lights: &mut Vec<FrameLight>) -> Result<()> {
        let Self { args, engine, stages, is_first, .. } = self;
        while lights.len() < frames.len() {
            lights.push(engine.frame_light());
        }
        let options = WriteOptions::with_quality(args.quality);
        let load = |(frame, light): (&FrameOutputs, &mut FrameLight)| engine.load(frame.frame, light);
        let loaded: Vec<Result<()>> =
            stages.time(Stage::Decode, || frames.par_iter().zip(lights.as_mut_slice()).map(load).collect());
        let good = loaded.iter().take_while(|result| result.is_ok()).count();
        let mut images = Vec::new();
        let mut unfinished = loaded.into_iter().find_map(Result::err);
        for (frame, light) in frames[..good].iter().zip(&*lights) {
            // The first frame tells how the faces lie.
            let continuity = if *is_first { engine.continuity(light) } else { None };
            *is_first = false;
            for warning in engine.warnings(frame.frame, light).into_iter().chain(continuity) {
                warn(&warning);
                self.warnings.push(warning);
            }
            match frame.render(engine, light, stages) {
                Ok(rendered) => images.push((frame, rendered)),
                Err(error) => {
                    unfinished = Some(error);
                    break;
                }
            }
        }
        stages.time(Stage::Encode, || {
            images.par_iter().try_for_each(|(frame, images)| frame.save(engine, images, &options))
        })?;
        images.iter().for_each(|(frame, _)| self.progress.frame_done(frame.frame));
        unfinished.map_or(Ok(()), Err)
    }
}

/// A picture and its smaller copies.
type Levels = Vec<Picture>;

impl FrameOutputs {
    fn render(&self, engine: &Engine<'_>, light: &FrameLight, stages: &mut Stages) -> Result<Vec<Levels>> {
        self.files.iter().map(|(index, _)| engine.render(*index, light, stages)).collect()
    }

    fn save(&self, engine: &Engine<'_>, images: &[Levels], options: &WriteOptions) -> Result<()> {
        let pairs = self.files.par_iter().zip(images);
        pairs.try_for_each(|((_, path), image)| save(engine.light(), image, path, options))
    }
}
