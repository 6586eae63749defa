use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use anyhow::Result;
use cosmorama::sphere::CubeFace;
use cosmorama::world::World;
use cosmorama_convert::{MemoryBudget, refuse_existing, threads};
use cosmorama_scene::{Plate, Plates};

use super::{NOUN, reflection_cone};
use crate::args::PlatesArgs;
use crate::console::Console;
use crate::diagram;
use crate::progress::Progress;
use crate::verbs::{make_folder, save_png, tell_made};

/// Pictures of the worlds that the plates show.
const SKY: &str = "world/sky.png";
const MERCATOR: &str = "world/mercator.png";

/// A drawing: its file and its maker.
type Drawing = (&'static str, fn(&Plates) -> Result<String>);

/// Both drawings: one reflection cone in two projections.
const DRAWINGS: [Drawing; 2] = [
    ("figure2-mercator", |plates| Ok(reflection_cone(&World::new([("Mercator".to_owned(), plates.map(MAP)?)])?, AXIS))),
    ("figure2-cube", |plates| Ok(reflection_cone(plates.environment().world, AXIS))),
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
    let mut progress = Progress::of(NOUN, console.progress(paper.progress), 1 + Plates::ALL.len() + DRAWINGS.len());
    let plates = pool.install(|| world(*size, &paper.dir, console))?;
    progress.frame_done(None);
    for plate in Plates::ALL {
        let start = Instant::now();
        let path = file_of(&paper.dir, &plate);
        pool.install(|| save_png(&path, &plates.picture(&plate)?, console))?;
        tell_made(console, &path, plate.about, start)?;
        progress.frame_done(None);
    }
    for (name, make) in DRAWINGS {
        let start = Instant::now();
        for file in pool.install(|| diagram::save(&paper.dir, name, &make(&plates)?, &console.unfinished))? {
            tell_made(console, &file, "a reflection cone on that map", start)?;
        }
        progress.frame_done(None);
    }
    progress.finish();
    console.print(&format!("all of it in {:.2} s\n", start.elapsed().as_secs_f64()))?;
    Ok(ExitCode::SUCCESS)
}

/// Makes the worlds that the plates show, and writes them.
fn world(size: usize, folder: &Path, console: &Console) -> Result<Plates> {
    let start = Instant::now();
    let plates = Plates::new(size)?;
    save_png(&folder.join(SKY), plates.sky(), console)?;
    save_png(&folder.join(MERCATOR), &plates.mercator()?, console)?;
    for (face, picture) in plates.faces() {
        save_png(&folder.join(face_file(face)), picture, console)?;
    }
    tell_made(console, &folder.join("world/{face}.png"), "the environment, sky first", start)?;
    Ok(plates)
}

/// Returns every file that is written.
fn outputs(folder: &Path) -> Vec<PathBuf> {
    let plates = Plates::ALL.iter().map(|plate| file_of(folder, plate));
    let worlds = CubeFace::ALL.map(face_file).into_iter().chain([SKY, MERCATOR].map(str::to_owned));
    let drawings = DRAWINGS.into_iter().flat_map(|(name, _)| diagram::files(folder, name));
    plates.chain(worlds.map(|name| folder.join(name))).chain(drawings).collect()
}

/// Returns the file of a plate.
fn file_of(folder: &Path, plate: &Plate) -> PathBuf {
    folder.join(plate.name).with_extension("png")
}

/// Returns the file of a face of the environment.
fn face_file(face: CubeFace) -> String {
    format!("world/{}.png", face.name())
}
