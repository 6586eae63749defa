//! Pictures of worlds by formula, and maps of directions.

use std::path::Path;

use cosmorama::raster::{ColourMatrix, Depth, Image, Primaries, Threads};
use cosmorama_builtin::{BuiltinWorld, DirectionMap, DirectionPixel};
use cosmorama_io::{WriteOptions, write_planes};

use crate::diagnostic::Result;
use crate::engine::unfiltered::OutputFile;
use crate::engine::{Levels, Stage, Writer, assemble};
use crate::job::ConvertJob;

/// Makes a picture of a world by formula.
pub(crate) fn picture(output: &OutputFile, world: BuiltinWorld, options: &WriteOptions) -> Result<()> {
    let OutputFile { job, stages, index, path, .. } = *output;
    let levels = stages.alone(Stage::Filter, || levels(job, world, index))?;
    stages.alone(Stage::Encode, || {
        Writer::new(&job.light, &job.layers.picture, options.clone()).save(levels, path, Threads::All)
    })
}

/// Makes a map of directions.
pub(crate) fn directions(output: &OutputFile, map: DirectionMap) -> Result<()> {
    let OutputFile { job, stages, index, path, .. } = *output;
    let pixels = stages.alone(Stage::Filter, || pixels(job, map, index))?;
    let metadata = job.light.metadata.clone();
    let options = WriteOptions { unfinished: output.unfinished.clone(), ..WriteOptions::with_metadata(metadata) };
    stages.alone(Stage::Encode, || save_map(job.light.depth, map, &pixels, path, &options))
}

/// Renders a file's picture and its mip levels over their background.
fn levels(job: &ConvertJob, world: BuiltinWorld, file: usize) -> Result<Levels> {
    let background = job.light.background;
    let picture = |index: usize| {
        let mut image = world.picture(&job.target.views[index].view);
        // Formulas have the primaries of Rec. 709.
        let matrix = ColourMatrix::between(&Primaries::REC709, &job.light.working.primaries);
        if !matrix.is_identity() {
            matrix.convert(image.pixels_mut());
        }
        image.pixels_mut().iter_mut().for_each(|pixel| *pixel = pixel.over(background));
        Ok(image)
    };
    let levels = job.target.files[file].levels();
    Ok(Levels::Light(levels.map(|sheet| assemble(sheet, background, picture)).collect::<Result<_>>()?))
}

/// Computes the directions of a file's pixels.
fn pixels(job: &ConvertJob, map: DirectionMap, file: usize) -> Result<Image<DirectionPixel>> {
    assemble(&job.target.files[file].sheet, DirectionPixel::default(), |index| {
        Ok(map.pixels(&job.target.views[index].view))
    })
}

/// Writes a map of directions, with a plane for each value of its pixels.
fn save_map(
    depth: Depth,
    map: DirectionMap,
    pixels: &Image<DirectionPixel>,
    path: &Path,
    options: &WriteOptions,
) -> Result<()> {
    let plane = |number: usize| pixels.pixels().iter().map(|pixel| pixel[number]).collect();
    let planes = map.channels().iter().enumerate().map(|(number, name)| (*name, plane(number))).collect();
    write_planes(path, (pixels.width(), pixels.height()), planes, depth, options)?;
    Ok(())
}
