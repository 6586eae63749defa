use std::collections::BTreeSet;
use std::process::ExitCode;
use std::time::Instant;

use anyhow::Result;

use super::engine::Engine;
use super::progress::Progress;
use super::report::Report;
use super::stages::{Stage, Stages};
use super::{print, use_threads};
use crate::args::ConvertArgs;
use crate::job::ConvertJob;

/// Converts, and tells what it has done.
pub(super) fn run(args: &ConvertArgs) -> Result<ExitCode> {
    use_threads(args.limits.threads)?;
    let report = convert(args)?;
    if args.json {
        print(&report.to_json()?)?;
    } else {
        report.tell();
    }
    Ok(ExitCode::SUCCESS)
}

/// Converts.
pub(super) fn convert(args: &ConvertArgs) -> Result<Report> {
    let start = Instant::now();
    let mut stages = Stages::default();
    let job = stages.time(Stage::Plan, || ConvertJob::resolve(args))?;
    let mut engine = stages.time(Stage::Plan, || Engine::new(&job))?;
    let mut progress = Progress::new(args.progress, job.outputs.frames.len());
    let (mut inputs, mut outputs) = (BTreeSet::new(), Vec::new());
    for frame in &job.outputs.frames {
        stages.time(Stage::Decode, || engine.load(frame.frame))?;
        for (index, path) in &frame.files {
            let image = stages.time(Stage::Filter, || engine.render(*index))?;
            stages.time(Stage::Encode, || engine.save(&image, path, args.quality))?;
            outputs.push(path.clone());
        }
        inputs.extend(engine.inputs(frame.frame));
        progress.frame_done(frame.frame);
    }
    progress.finish();
    let warnings = job.warnings.iter().cloned().chain(engine.warnings.drain(..)).collect();
    let counts = (job.outputs.frames.len(), job.outputs.skipped);
    Ok(Report::new(inputs, outputs, counts, start.elapsed(), stages, warnings))
}
