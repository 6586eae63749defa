use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use anyhow::{Context, Result};
use cosmorama::camera::{CameraModel, CylinderCamera, CylinderKind, OmnimaxCamera};
use cosmorama::explain;
use cosmorama::filter::{CrossSection, FilterKind, FilterSettings};
use cosmorama::laboratory::{Crop, Row, figures, sheet};
use cosmorama::raster::{Image, Rgba};
use cosmorama::render::Resampler;
use cosmorama::sphere::CubeFace;
use cosmorama::world::{Light, World};
use cosmorama_convert::{MemoryBudget, refuse_existing, threads};
use cosmorama_io::Format;

use super::{NOUN, reflection_cone};
use crate::args::{FiguresArgs, ProgressStyle};
use crate::console::Console;
use crate::diagram;
use crate::progress::Progress;
use crate::verbs::demo::command;
use crate::verbs::demo::faces::{FACE, Faces, whole_cube};
use crate::verbs::{make_folder, tell_made, write_picture};

/// Pictures that are not drawings: the frame, and one that shows aliasing.
const FRAME: &str = "figure-5.png";
const ALIASING: &str = "figure-6.png";

/// A drawing: its file, its content, and its maker.
type Drawing = (&'static str, &'static str, fn(&Originals) -> Result<String>);

/// All drawings.
const DRAWINGS: [Drawing; 8] = [
    ("figure-3", "the unfolded cube with the field of view", |of| of.faces.unfolded()),
    ("figure-4", "which face gives which pixel", |of| Ok(of.frame().ownership())),
    ("figure-7-screen", "round pixels on the screen", |of| Ok(figures::circles(&of.faces.target))),
    ("figure-7-texture", "their footprints on the faces", |of| Ok(of.frame().footprints())),
    ("figure-8", "contours of Q", Originals::paraboloid),
    ("figure-9", "the kernel", |_| {
        Ok(figures::kernel(CrossSection::Gaussian { alpha: 2.0, cutoff: 1.0 }, "exp(-2 r²)"))
    }),
    ("world-projections-2-mercator", "a reflection cone in Mercator's projection", |_| {
        let map = CameraModel::Cylinder(CylinderCamera::new(CylinderKind::Mercator)).view(960, 720)?;
        Ok(reflection_cone(&World::new([("Mercator".to_owned(), map)])?, TILTED_UP))
    }),
    ("world-projections-2-cube", "the same cone on a cube", |_| Ok(reflection_cone(&whole_cube()?, TILTED_UP))),
];

/// Size of the frame that shows aliasing: a third of the paper's, so that a pixel holds two texels to four.
const SMALL: (usize, usize) = (655, 478);

/// Side of a check, in texels.
const CHECK: usize = 4;

const WHITE: Rgba = Rgba::opaque(1.0, 1.0, 1.0);

/// Places of that frame, from the rim to the middle.
const PLACES: [Crop; 4] = [(24, 210), (110, 110), (300, 16), (300, 210)];

/// Pixel whose paraboloid is drawn.
const PIXEL: (usize, usize) = (330, 560);

/// Degrees to the right and up of the cone's axis, so high that the cone touches all faces but the lower one.
const TILTED_UP: (f64, f64) = (25.0, 65.0);

/// Texels that are held at once: all six faces with checks.
const HELD: (usize, usize) = (3 * FACE, 2 * FACE);

/// Worlds that the figures are drawn of.
struct Originals {
    faces: Faces,
    /// World of these faces.
    world: World,
}

/// Remakes the figures of the papers.
pub(in crate::verbs) fn run(FiguresArgs { paper }: &FiguresArgs, console: &Console) -> Result<ExitCode> {
    MemoryBudget::new(paper.limits.memory).check_picture(HELD)?;
    let pool = threads(paper.limits.threads)?;
    let faces = pool.install(|| Faces::needed(&paper.dir))?;
    if !paper.overwrite {
        refuse_existing(outputs(&paper.dir, &faces).iter().map(PathBuf::as_path))?;
    }
    let _folders = make_folder(&faces.folder(), console)?;
    let mut progress = Progress::of(NOUN, console.progress(paper.progress), faces.parts.len() + 2 + DRAWINGS.len());
    for part in &faces.parts {
        pool.install(|| faces.render(part, console))?;
        progress.frame_done(None);
    }
    let frame = paper.dir.join(FRAME);
    command::omnimax(&faces, (&frame, FilterKind::Ewa), (&paper.limits, ProgressStyle::None), console)?;
    progress.frame_done(None);
    pool.install(|| aliasing(&paper.dir.join(ALIASING), console))?;
    progress.frame_done(None);
    let originals = Originals { world: faces.world()?, faces };
    for drawing in DRAWINGS {
        pool.install(|| originals.draw(&paper.dir, drawing, console))?;
        progress.frame_done(None);
    }
    progress.finish();
    Ok(ExitCode::SUCCESS)
}

/// Returns every file that is written.
fn outputs(folder: &Path, faces: &Faces) -> Vec<PathBuf> {
    let pictures = [FRAME, ALIASING].map(|name| folder.join(name));
    let drawings = DRAWINGS.into_iter().flat_map(|(name, ..)| diagram::files(folder, name));
    faces.files().chain(pictures).chain(drawings).collect()
}

/// Makes figure 6: checkerboard faces, point-sampled and filtered.
fn aliasing(path: &Path, console: &Console) -> Result<()> {
    let start = Instant::now();
    let (world, target) = (whole_cube()?, CameraModel::Omnimax(OmnimaxCamera::default()).view(SMALL.0, SMALL.1)?);
    let check = |i: usize, j: usize| if (i / CHECK + j / CHECK).is_multiple_of(2) { Rgba::BLACK } else { WHITE };
    let light = Light::of_pictures(&world, CubeFace::ALL.map(|_| Image::from_fn(FACE, FACE, check)))?;
    let rows = [("point sampling", FilterKind::Point), ("filtering", FilterKind::Ewa)].map(|(name, kind)| {
        let filter = FilterSettings { kind, ..FilterSettings::DEFAULT };
        let picture = Resampler { world: &world, target: &target, filter }.render(light.texels());
        Row::new(vec![name.to_owned()], &picture, &PLACES)
    });
    write_picture((path, Format::Png), &sheet(&rows), console)?;
    tell_made(console, path, "checkerboard faces, point-sampled and filtered", start)
}

impl Originals {
    /// Returns figures of the frame.
    fn frame(&self) -> explain::Figures<'_> {
        explain::Figures { world: &self.world, target: &self.faces.target }
    }

    fn paraboloid(&self) -> Result<String> {
        let drawing = figures::paraboloid(&self.world, &self.faces.target, PIXEL);
        drawing.context("no face shows the pixel of figure 8")
    }

    /// Makes a drawing, and writes it.
    fn draw(&self, folder: &Path, (name, what, make): Drawing, console: &Console) -> Result<()> {
        let start = Instant::now();
        for file in diagram::save(folder, name, &make(self)?, &console.unfinished)? {
            tell_made(console, &file, what, start)?;
        }
        Ok(())
    }
}
