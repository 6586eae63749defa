//! Pictures of worlds by formula, and maps of directions.

use std::ops::Range;
use std::sync::Arc;

use cosmorama::camera::View;
use cosmorama::motion::LightSum;
use cosmorama::raster::{ColourMatrix, Image, Primaries, Rgba, Threads};
use cosmorama_builtin::{BuiltinWorld, DirectionMap, DirectionPixel};
use cosmorama_io::pending::Hidden;

use crate::diagnostic::Result;
use crate::engine::unfiltered::{Numbers, OutputFile};
use crate::engine::{FrameWords, Levels, Stage, Writer, WriterOptions};
use crate::job::{ConvertJob, STRIP};
use crate::target::{Sheet, Strip, TargetView};

/// Makes a picture of a world by formula.
pub(crate) fn picture(output: &OutputFile, world: BuiltinWorld, options: &WriterOptions) -> Result<()> {
    let OutputFile { job, frame, place, stages, path, .. } = *output;
    let origin = job.origin_of(frame)?.map(Arc::from);
    let words = FrameWords { place, origin, ..FrameWords::default() };
    let writer = Writer::new(&job.light, &job.layers.picture, options.clone());
    if job.is_by_strips() {
        return Ok(stages.alone(Stage::Filter, || by_strips(output, world, &writer, words))?.appear()?);
    }
    let levels = stages.alone(Stage::Filter, || levels(output, world))?;
    stages.alone(Stage::Encode, || writer.save(words, levels, path, Threads::All))
}

/// Makes a picture strip by strip and writes it, but for its name.
fn by_strips(output: &OutputFile, world: BuiltinWorld, writer: &Writer, words: FrameWords) -> Result<Hidden> {
    let OutputFile { job, views, exposure, index, path, .. } = *output;
    let (size, mut failed) = (job.target.files[index].sheet.size, None);
    let mut make = |rows: Range<usize>| {
        let strip = Strip::of(&job.target, index, rows);
        let exposed = |(views, weight): &(Vec<TargetView>, f32)| (strip.views(views), *weight);
        let exposure: Vec<(Vec<TargetView>, f32)> = exposure.iter().map(exposed).collect();
        let image = sheet(job, world, (&strip.sheet, &strip.views(views)), &exposure);
        image.map_err(|error| failed = Some(error)).ok().map(|image| writer.encode(image, Threads::All))
    };
    let written = writer.save_rows(words, path, (size, STRIP), &mut make);
    failed.map_or(written, Err)
}

/// Makes a map of directions.
pub(crate) fn directions(output: &OutputFile, map: DirectionMap) -> Result<()> {
    let metadata = output.job.light.metadata.clone();
    let numbers = Numbers { names: map.channels(), nowhere: DirectionPixel::default(), metadata };
    output.write_numbers(numbers, |target| Ok(map.pixels(&target.view)))
}

/// Renders a file's picture and its mip levels over their background.
fn levels(output: &OutputFile, world: BuiltinWorld) -> Result<Levels> {
    let OutputFile { job, views, exposure, index: file, .. } = *output;
    let levels = job.target.files[file].levels();
    Ok(Levels::Light(levels.map(|level| sheet(job, world, (level, views), exposure)).collect::<Result<_>>()?))
}

/// Renders a sheet of views over its background, at one time or through an exposure.
fn sheet(
    job: &ConvertJob,
    world: BuiltinWorld,
    (sheet, views): (&Sheet, &[TargetView]),
    exposure: &[(Vec<TargetView>, f32)],
) -> Result<Image<Rgba>> {
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
        _ => Ok(moment(&views[index].view)),
    };
    sheet.assemble(background, picture)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::{Conversion, Existing};

    #[test]
    fn strips_of_a_formula_are_its_picture() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["grid", "checker", "directions", "zone-plate", "demo"] {
            for to in ["fulldome:tilt=20,yaw=10", "cube:layout=cross-h,yaw=13,pitch=7"] {
                let output = folder.path().join("picture.exr").display().to_string();
                let conversion = Conversion::new(format!("builtin:{name}"), output).to(to.parse().unwrap());
                let conversion = conversion.size("120".parse().unwrap()).existing(Existing::Replace);
                let checked = conversion.check().result.unwrap_or_else(|error| panic!("{name}: {error}"));
                let (job, world) = (&checked.job, checked.job.formula().unwrap());
                let (whole, views) = (&job.target.files[0].sheet, &job.target.views[..]);
                let picture = sheet(job, world, (whole, views), &[]).unwrap();
                let (mut others, mut farthest) = (0, 0.0f32);
                for top in (0..picture.height()).step_by(50) {
                    let rows = top..picture.height().min(top + 50);
                    let strip = Strip::of(&job.target, 0, rows.clone());
                    let made = sheet(job, world, (&strip.sheet, &strip.views(views)), &[]).unwrap();
                    assert_eq!((made.width(), made.height()), (picture.width(), rows.len()));
                    let part = &picture.pixels()[rows.start * picture.width()..rows.end * picture.width()];
                    let distance = |(a, b): (&Rgba, &Rgba)| (0..4).map(|k| (a.0[k] - b.0[k]).abs()).fold(0.0, f32::max);
                    for distance in made.pixels().iter().zip(part).map(distance) {
                        others += usize::from(distance > 4e-6);
                        farthest = farthest.max(distance);
                    }
                }
                // Where a sample lies on an edge, its last digit decides; a pixel there has hundreds of samples.
                let most = picture.pixels().len() / 1000;
                assert!(others <= most && farthest < 0.02, "{name} as {to}: {others} pixels, up to {farthest}");
            }
        }
    }
}
