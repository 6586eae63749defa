use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::Result;
use cosmorama::raster::Image;
use cosmorama_builtin::{BuiltinWorld, DirectionMap, DirectionPixel};
use cosmorama_io::{WriteOptions, write_planes};

use super::engine::assemble;
use super::progress::Progress;
use super::report::Report;
use super::stages::{Stage, Stages};
use super::writer::{Levels, Writer};
use crate::args::ConvertArgs;
use crate::job::{Builtin, BuiltinJob, FrameOutputs, Light, write_options};

/// Makes pictures of a built-in world, or maps of directions.
pub(super) fn convert(builtin: Builtin, args: &ConvertArgs) -> Result<Report> {
    let start = Instant::now();
    let stages = Stages::default();
    let job = stages.alone(Stage::Plan, || BuiltinJob::resolve(builtin, args))?;
    let writer = Writer::new(&job.light, write_options(args, job.target.format, &job.outputs, &job.light));
    let mut progress = Progress::new(args.progress, job.outputs.frames.len());
    for FrameOutputs { frame, files } in &job.outputs.frames {
        for (index, path) in files {
            match job.builtin {
                Builtin::World(world) => {
                    let levels = stages.alone(Stage::Filter, || pictures(&job, world, *index))?;
                    stages.alone(Stage::Encode, || writer.save(levels, path))?;
                }
                Builtin::DirectionMap(map) => {
                    let pixels = stages.alone(Stage::Filter, || directions(&job, map, *index))?;
                    stages.alone(Stage::Encode, || save_map(&job.light, map, &pixels, path))?;
                }
            }
        }
        progress.frame_done(*frame);
    }
    progress.finish();
    let inputs = BTreeSet::from([PathBuf::from(&args.input)]);
    Ok(Report::new(inputs, &job.outputs, start.elapsed(), &stages, job.warnings))
}

/// The picture of a file and its smaller copies, in front of their background.
fn pictures(job: &BuiltinJob, world: BuiltinWorld, file: usize) -> Result<Levels> {
    let background = job.light.background;
    let picture = |index: usize| {
        let mut image = world.picture(&job.target.views[index].view);
        image.pixels_mut().iter_mut().for_each(|pixel| *pixel = pixel.over(background));
        Ok(image)
    };
    let levels = job.target.files[file].levels();
    Ok(Levels::Light(levels.map(|sheet| assemble(sheet, background, picture)).collect::<Result<_>>()?))
}

/// The directions of a file's pixels.
fn directions(job: &BuiltinJob, map: DirectionMap, file: usize) -> Result<Image<DirectionPixel>> {
    assemble(&job.target.files[file].sheet, DirectionPixel::default(), |index| {
        Ok(map.pixels(&job.target.views[index].view))
    })
}

/// Writes a map of directions, a plane for each number of its pixels.
fn save_map(light: &Light, map: DirectionMap, pixels: &Image<DirectionPixel>, path: &Path) -> Result<()> {
    let plane = |number: usize| pixels.pixels().iter().map(|pixel| pixel[number]).collect();
    let planes = map.channels().iter().enumerate().map(|(number, name)| (*name, plane(number))).collect();
    let options = WriteOptions::with_metadata(light.metadata.clone());
    write_planes(path, (pixels.width(), pixels.height()), planes, light.depth, &options)?;
    Ok(())
}
