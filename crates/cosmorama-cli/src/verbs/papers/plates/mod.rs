//! The seven plates and two figures of N. Greene, *Applications of world projections* (Graphics Interface '86), made
//! anew of worlds and a model by formula.

mod figure;
mod studio;
mod things;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use anyhow::Result;
use cosmorama::raster::{Channels, Depth, EncodedImage, Image, Rgba, Transfer};
use cosmorama::sphere::CubeFace;
use cosmorama_convert::{MemoryBudget, refuse_existing, threads};
use cosmorama_io::{Metadata, WriteOptions, write};

use self::studio::Studio;
use crate::args::PlatesArgs;
use crate::console::Console;
use crate::progress::Progress;
use crate::verbs::demo::tell;
use crate::verbs::{diagram, make_folder};

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

/// Pictures that plates are made of, and that lie under the drawings.
const SKY: &str = "world/sky.png";
const MERCATOR: &str = "world/mercator.png";

/// Drawings: one reflection cone in two projections.
const DRAWINGS: [&str; 2] = ["figure2-mercator", "figure2-cube"];

/// Columns of the cross of an unfolded cube, and its rows, in faces.
const CROSS: (usize, usize) = (4, 3);

/// Makes all plates and figures.
pub(in crate::verbs) fn run(args: &PlatesArgs, console: &Console) -> Result<ExitCode> {
    let start = Instant::now();
    MemoryBudget::new(args.limits.memory).check_picture((CROSS.0 * args.size, CROSS.1 * args.size))?;
    if !args.overwrite {
        refuse_existing(outputs(&args.dir).iter().map(PathBuf::as_path))?;
    }
    let _folders = [make_folder(&args.dir, console)?, make_folder(&args.dir.join("world"), console)?];
    let pool = threads(args.limits.threads)?;
    let mut progress = Progress::new(args.progress, 1 + PLATES.len() + DRAWINGS.len());
    let studio = pool.install(|| world(args, console))?;
    progress.frame_done(None);
    for (name, what, make) in PLATES {
        let start = Instant::now();
        let path = args.dir.join(name);
        pool.install(|| save(&path, &make(&studio)?, console))?;
        tell(console, &path, what, start)?;
        progress.frame_done(None);
    }
    for (name, drawing) in DRAWINGS.into_iter().zip([figure::on_mercator, figure::on_cube]) {
        let start = Instant::now();
        for file in pool.install(|| diagram::draw(&args.dir, name, &drawing(&studio)?, &console.unfinished))? {
            file.appear()?;
        }
        tell(console, &diagram::files(&args.dir, name)[0], "a reflection cone on that map, also as PNG", start)?;
        progress.frame_done(None);
    }
    progress.finish();
    console.print(&format!("all of it in {:.2} s\n", start.elapsed().as_secs_f64()))?;
    Ok(ExitCode::SUCCESS)
}

/// Makes the worlds that the plates show, and writes them.
fn world(args: &PlatesArgs, console: &Console) -> Result<Studio> {
    let start = Instant::now();
    let studio = Studio::new(args.size)?;
    save(&args.dir.join(SKY), studio.sky(), console)?;
    save(&args.dir.join(MERCATOR), &studio.mercator()?, console)?;
    for (face, picture) in studio.faces() {
        save(&args.dir.join(file_of(face)), picture, console)?;
    }
    tell(console, &args.dir.join("world/{face}.png"), "the environment, sky first", start)?;
    Ok(studio)
}

/// Returns every file that is written.
fn outputs(folder: &Path) -> Vec<PathBuf> {
    let pictures = PLATES.into_iter().map(|(name, ..)| folder.join(name));
    let worlds = CubeFace::ALL.map(file_of).into_iter().chain([SKY, MERCATOR].map(str::to_owned));
    let drawings = DRAWINGS.into_iter().flat_map(|name| diagram::files(folder, name));
    pictures.chain(worlds.map(|name| folder.join(name))).chain(drawings).collect()
}

/// Returns the file of a face of the environment.
fn file_of(face: CubeFace) -> String {
    format!("world/{}.png", face.name())
}

fn save(path: &Path, light: &Image<Rgba>, console: &Console) -> Result<()> {
    let is_opaque = light.pixels().iter().all(|pixel| pixel.alpha() >= 1.0);
    let channels = if is_opaque { Channels::Rgb } else { Channels::Rgba };
    let encoded = EncodedImage::encode(light, channels, Depth::Eight, &Transfer::Srgb);
    let metadata = Metadata { transfer: Some(Transfer::Srgb), ..Metadata::default() };
    let options = WriteOptions { unfinished: console.unfinished.clone(), ..WriteOptions::with_metadata(metadata) };
    Ok(write(path, &encoded, &options)?)
}
