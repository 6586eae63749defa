//! The seven plates and two figures of N. Greene, *Applications of world projections* (Graphics Interface '86), made
//! anew of worlds and a model by formula.

mod studio;
mod things;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use anyhow::Result;
use cosmorama::raster::{Image, Rgba};
use cosmorama::sphere::CubeFace;
use cosmorama::world::World;
use cosmorama_convert::{MemoryBudget, refuse_existing, threads};

use self::studio::Studio;
use super::{NOUN, reflection_cone};
use crate::args::PlatesArgs;
use crate::console::Console;
use crate::diagram;
use crate::progress::Progress;
use crate::verbs::{make_folder, save_png, tell_made};

/// A picture: its file, its content, and its maker.
type Plate = (&'static str, &'static str, fn(&Studio) -> Result<Image<Rgba>>);

/// All pictures that are not drawings.
const PLATES: [Plate; 8] = [
    ("plate1.png", "a lizard that reflects its environment", things::lizard),
    ("plate2.png", "the environment on an unfolded cube", Studio::unfolded_cube),
    ("plate3.png", "its diffuse illumination map, in Mercator's projection", Studio::diffuse_map),
    ("plate4.png", "spheres that reflect it: matt, mixed, mirror", things::spheres),
    ("plate5.png", "a frame with a painted sky on half a cube", Studio::painted_frame),
    ("plate6.png", "a sky on half a cube, from a fisheye picture", Studio::half_cube),
    ("plate7.png", "the environment in Omnimax's projection", Studio::omnimax),
    ("figure1.png", "the rays of a pixel, and their reflection cone", things::reflection_cone),
];

/// Pictures of the worlds that the plates show.
const SKY: &str = "world/sky.png";
const MERCATOR: &str = "world/mercator.png";

/// A drawing: its file and its maker.
type Drawing = (&'static str, fn(&Studio) -> Result<String>);

/// Both drawings: one reflection cone in two projections.
const DRAWINGS: [Drawing; 2] = [
    ("figure2-mercator", |studio| Ok(reflection_cone(&World::new([("Mercator".to_owned(), studio.map(MAP)?)])?, AXIS))),
    ("figure2-cube", |studio| Ok(reflection_cone(studio.environment().world, AXIS))),
];

/// Width of the map under the cone, in pixels where an edge has 768.
const MAP: usize = 768;

/// Degrees to the right and up of the cone's axis. The cone touches all faces but the one behind.
const AXIS: (f64, f64) = (28.0, 24.0);

/// Pixels that are held at once, in faces: the photograph of the sky and the copy that is looked up, half a cube, six faces and
/// their light, and the largest plate.
const HELD: (usize, usize) = (6, 4);

/// Makes all plates and figures.
pub(in crate::verbs) fn run(PlatesArgs { size, paper }: &PlatesArgs, console: &Console) -> Result<ExitCode> {
    let start = Instant::now();
    MemoryBudget::new(paper.limits.memory).check_picture((HELD.0 * size, HELD.1 * size))?;
    if !paper.overwrite {
        refuse_existing(outputs(&paper.dir).iter().map(PathBuf::as_path))?;
    }
    let _folders = [make_folder(&paper.dir, console)?, make_folder(&paper.dir.join("world"), console)?];
    let pool = threads(paper.limits.threads)?;
    let mut progress = Progress::of(NOUN, paper.progress, 1 + PLATES.len() + DRAWINGS.len());
    let studio = pool.install(|| world(*size, &paper.dir, console))?;
    progress.frame_done(None);
    for (name, what, make) in PLATES {
        let start = Instant::now();
        let path = paper.dir.join(name);
        pool.install(|| save_png(&path, &make(&studio)?, console))?;
        tell_made(console, &path, what, start)?;
        progress.frame_done(None);
    }
    for (name, make) in DRAWINGS {
        let start = Instant::now();
        let [vector, _] = pool.install(|| diagram::save(&paper.dir, name, &make(&studio)?, &console.unfinished))?;
        tell_made(console, &vector, "a reflection cone on that map, also as PNG", start)?;
        progress.frame_done(None);
    }
    progress.finish();
    console.print(&format!("all of it in {:.2} s\n", start.elapsed().as_secs_f64()))?;
    Ok(ExitCode::SUCCESS)
}

/// Makes the worlds that the plates show, and writes them.
fn world(size: usize, folder: &Path, console: &Console) -> Result<Studio> {
    let start = Instant::now();
    let studio = Studio::new(size)?;
    save_png(&folder.join(SKY), studio.sky(), console)?;
    save_png(&folder.join(MERCATOR), &studio.mercator()?, console)?;
    for (face, picture) in studio.faces() {
        save_png(&folder.join(file_of(face)), picture, console)?;
    }
    tell_made(console, &folder.join("world/{face}.png"), "the environment, sky first", start)?;
    Ok(studio)
}

/// Returns every file that is written.
fn outputs(folder: &Path) -> Vec<PathBuf> {
    let pictures = PLATES.into_iter().map(|(name, ..)| folder.join(name));
    let worlds = CubeFace::ALL.map(file_of).into_iter().chain([SKY, MERCATOR].map(str::to_owned));
    let drawings = DRAWINGS.into_iter().flat_map(|(name, _)| diagram::files(folder, name));
    pictures.chain(worlds.map(|name| folder.join(name))).chain(drawings).collect()
}

/// Returns the file of a face of the environment.
fn file_of(face: CubeFace) -> String {
    format!("world/{}.png", face.name())
}
