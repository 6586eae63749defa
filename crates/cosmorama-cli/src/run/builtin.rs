use std::collections::BTreeSet;
use std::path::PathBuf;
use std::time::Instant;

use anyhow::Result;
use cosmorama::raster::{Image, Rgba};
use cosmorama_builtin::BuiltinWorld;
use cosmorama_io::WriteOptions;

use super::engine::{assemble, save};
use super::progress::Progress;
use super::report::Report;
use super::stages::{Stage, Stages};
use crate::args::ConvertArgs;
use crate::job::{BuiltinJob, FrameOutputs};

/// Makes pictures of a built-in world.
pub(super) fn convert(world: BuiltinWorld, args: &ConvertArgs) -> Result<Report> {
    let start = Instant::now();
    let mut stages = Stages::default();
    let job = stages.time(Stage::Plan, || BuiltinJob::resolve(world, args))?;
    let options = WriteOptions::with_quality(args.quality);
    let mut progress = Progress::new(args.progress, job.outputs.frames.len());
    for FrameOutputs { frame, files } in &job.outputs.frames {
        for (index, path) in files {
            let image = stages.time(Stage::Filter, || picture(&job, *index))?;
            stages.time(Stage::Encode, || save(&job.light, &image, path, &options))?;
        }
        progress.frame_done(*frame);
    }
    progress.finish();
    let outputs =
        job.outputs.frames.iter().flat_map(|frame| frame.files.iter().map(|(_, path)| path.clone())).collect();
    let counts = (job.outputs.frames.len(), job.outputs.skipped);
    let inputs = BTreeSet::from([PathBuf::from(&args.input)]);
    Ok(Report::new(inputs, outputs, counts, start.elapsed(), stages, job.warnings))
}

/// The picture of a file, in front of its background.
fn picture(job: &BuiltinJob, file: usize) -> Result<Image<Rgba>> {
    let background = job.light.background;
    assemble(&job.target.files[file], background, |index| {
        let mut image = job.world.picture(&job.target.views[index].view);
        image.pixels_mut().iter_mut().for_each(|pixel| *pixel = pixel.over(background));
        Ok(image)
    })
}
