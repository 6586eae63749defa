//! Pictures of worlds by formula, and maps of directions.

use std::path::Path;
use std::sync::Arc;

use cosmorama::camera::View;
use cosmorama::motion::LightSum;
use cosmorama::raster::{ColourMatrix, Depth, Image, Primaries, Rgba, Threads};
use cosmorama_builtin::{BuiltinWorld, DirectionMap, DirectionPixel};
use cosmorama_io::{WriteOptions, write_planes};

use crate::diagnostic::Result;
use crate::engine::unfiltered::OutputFile;
use crate::engine::{FrameWords, Levels, Stage, Writer, WriterOptions};

/// Makes a picture of a world by formula.
pub(crate) fn picture(output: &OutputFile, world: BuiltinWorld, options: &WriterOptions) -> Result<()> {
    let OutputFile { job, frame, place, stages, path, .. } = *output;
    let origin = job.origin_of(frame)?.map(Arc::from);
    let levels = stages.alone(Stage::Filter, || levels(output, world))?;
    stages.alone(Stage::Encode, || {
        let words = FrameWords { place, origin, ..FrameWords::default() };
        Writer::new(&job.light, &job.layers.picture, options.clone()).save(words, levels, path, Threads::All)
    })
}

/// Makes a map of directions.
pub(crate) fn directions(output: &OutputFile, map: DirectionMap) -> Result<()> {
    let OutputFile { job, stages, path, .. } = *output;
    let pixels = stages.alone(Stage::Filter, || pixels(output, map))?;
    let metadata = job.light.metadata.clone();
    let options = WriteOptions { unfinished: output.unfinished.clone(), ..WriteOptions::with_metadata(metadata) };
    stages.alone(Stage::Encode, || save_map(job.light.depth, map, &pixels, path, &options))
}

/// Renders a file's picture and its mip levels over their background.
fn levels(output: &OutputFile, world: BuiltinWorld) -> Result<Levels> {
    let OutputFile { job, exposure, index: file, .. } = *output;
    let background = job.light.background;
    let moment = |view: &View| {
        let mut image = light(world, view, &job.light.working.primaries);
        image.pixels_mut().iter_mut().for_each(|pixel| *pixel = pixel.over(background));
        image
    };
    let picture = |index: usize| match exposure {
        [(views, weight), rest @ ..] if !rest.is_empty() => {
            let mut sum = LightSum::new(moment(&views[index].view), *weight);
            rest.iter().for_each(|(views, weight)| sum.add(&moment(&views[index].view), *weight));
            Ok(sum.into_image())
        }
        _ => Ok(moment(&output.views[index].view)),
    };
    let levels = job.target.files[file].levels();
    Ok(Levels::Light(levels.map(|sheet| sheet.assemble(background, picture)).collect::<Result<_>>()?))
}

/// Computes the light of a world in a view, in some primaries.
pub(crate) fn light(world: BuiltinWorld, view: &View, primaries: &Primaries) -> Image<Rgba> {
    let mut image = world.picture(view);
    // Formulas have the primaries of Rec. 709.
    let matrix = ColourMatrix::between(&Primaries::REC709, primaries);
    if !matrix.is_identity() {
        matrix.convert(image.pixels_mut());
    }
    image
}

/// Computes the directions of a file's pixels.
fn pixels(output: &OutputFile, map: DirectionMap) -> Result<Image<DirectionPixel>> {
    output.job.target.files[output.index]
        .sheet
        .assemble(DirectionPixel::default(), |index| Ok(map.pixels(&output.views[index].view)))
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
