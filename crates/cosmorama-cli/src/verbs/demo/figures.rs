use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use anyhow::{Result, anyhow};
use cosmorama::camera::{CameraModel, CylinderCamera, CylinderKind, OmnimaxCamera, View};
use cosmorama::explain::Figures;
use cosmorama::filter::{CrossSection, FilterKind, FilterSettings};
use cosmorama::laboratory::{Crop, Row, figures, sheet};
use cosmorama::raster::{Channels, Depth, EncodedImage, Image, Rgba, Transfer};
use cosmorama::render::Resampler;
use cosmorama::sphere::{Angle, CubeFace, Direction, Orientation};
use cosmorama::world::{Light, World};
use cosmorama_builtin::BuiltinWorld;
use cosmorama_convert::{refuse_existing, threads};
use cosmorama_io::{Metadata, WriteOptions, write};

use super::{FACE, FACES, FRAME, PartialFace, face_file, face_view, needed_faces, render_face, tell, unfolded};
use crate::args::FiguresArgs;
use crate::console::Console;
use crate::verbs::{diagram, make_folder};

/// Drawings, and pictures of pixels.
const UNFOLDED: &str = "figure-3";
const OWNERSHIP: &str = "figure-4";
const FRAME_PICTURE: &str = "figure-5.png";
const ALIASING: &str = "figure-6.png";
const SCREEN: &str = "figure-7-screen";
const TEXTURE: &str = "figure-7-texture";
const PARABOLOID: &str = "figure-8";
const KERNEL: &str = "figure-9";
const CONE_IN_MERCATOR: &str = "world-projections-2-mercator";
const CONE_ON_CUBE: &str = "world-projections-2-cube";
const DRAWINGS: [&str; 8] =
    [UNFOLDED, OWNERSHIP, SCREEN, TEXTURE, PARABOLOID, KERNEL, CONE_IN_MERCATOR, CONE_ON_CUBE];

/// Places of the frame that show aliasing: beside the rim, where a pixel holds most texels.
const PLACES: [Crop; 4] = [(60, 560), (300, 260), (950, 20), (950, 700)];

/// Pixel whose paraboloid is drawn.
const PIXEL: (usize, usize) = (330, 560);

/// Remakes the figures of the papers.
pub(in crate::verbs) fn run(args: &FiguresArgs, console: &Console) -> Result<ExitCode> {
    let target = CameraModel::Omnimax(OmnimaxCamera::default()).view(FRAME.0, FRAME.1)?;
    let pool = threads(args.limits.threads)?;
    let faces = pool.install(|| needed_faces(&target))?;
    if !args.overwrite {
        refuse_existing(outputs(&args.dir, &faces).iter().map(PathBuf::as_path))?;
    }
    let _folders = make_folder(&args.dir.join(FACES), console)?;
    for partial in &faces {
        pool.install(|| render_face(partial, &args.dir.join(FACES), console))?;
    }
    pool.install(|| pictures(&args.dir, &target, console))?;
    pool.install(|| drawings(&args.dir, &faces, &target, console))?;
    Ok(ExitCode::SUCCESS)
}

/// Returns every file that is written.
fn outputs(folder: &Path, faces: &[PartialFace]) -> Vec<PathBuf> {
    let faces = faces.iter().map(|partial| face_file(&folder.join(FACES), partial.face));
    let pictures = [FRAME_PICTURE, ALIASING].map(|name| folder.join(name));
    faces.chain(pictures).chain(DRAWINGS.iter().flat_map(|name| diagram::files(folder, name))).collect()
}

/// Makes figures 5 and 6, which are pixels.
fn pictures(folder: &Path, target: &View, console: &Console) -> Result<()> {
    let start = Instant::now();
    let (world, light) = cube(BuiltinWorld::Demo)?;
    let frame = by(&world, target, FilterKind::Ewa, &light);
    save(&folder.join(FRAME_PICTURE), &frame, ("the Omnimax frame", start), console)?;
    let start = Instant::now();
    let (world, light) = cube(BuiltinWorld::Checker)?;
    let rows = [("point sampling", FilterKind::Point), ("filtering", FilterKind::Ewa)]
        .map(|(name, kind)| Row::new(vec![name.to_owned()], &by(&world, target, kind, &light), &PLACES));
    save(&folder.join(ALIASING), &sheet(&rows), ("checkerboard faces, point-sampled and filtered", start), console)
}

/// Renders a world by formula on whole faces.
fn cube(formula: BuiltinWorld) -> Result<(World, Light)> {
    let views: Vec<(String, View)> =
        CubeFace::ALL.iter().map(|&face| Ok((face.name().to_owned(), face_view(face, None, FACE, FACE)?))).collect::<Result<_>>()?;
    let pictures: Vec<Image<Rgba>> = views.iter().map(|(_, view)| formula.picture(view)).collect();
    let world = World::new(views)?;
    let light = Light::of_pictures(&world, pictures)?;
    Ok((world, light))
}

fn by(world: &World, target: &View, kind: FilterKind, light: &Light) -> Image<Rgba> {
    Resampler { world, target, filter: FilterSettings { kind, ..FilterSettings::DEFAULT } }
        .render_over(light.texels(), Rgba::BLACK)
}

fn save(path: &Path, picture: &Image<Rgba>, (what, start): (&str, Instant), console: &Console) -> Result<()> {
    let encoded = EncodedImage::encode(picture, Channels::Rgb, Depth::Eight, &Transfer::Srgb);
    let metadata = Metadata { transfer: Some(Transfer::Srgb), ..Metadata::default() };
    let options = WriteOptions { unfinished: console.unfinished.clone(), ..WriteOptions::with_metadata(metadata) };
    write(path, &encoded, &options)?;
    tell(console, path, what, start)
}

/// Draws the other figures.
fn drawings(folder: &Path, faces: &[PartialFace], target: &View, console: &Console) -> Result<()> {
    let four = World::new(faces.iter().map(|partial| (partial.face.name().to_owned(), partial.view.clone())))?;
    let of_frame = Figures { world: &four, target };
    let gaussian = CrossSection::Gaussian { alpha: 2.0, cutoff: 1.0 };
    let no_pixel = || anyhow!("no face shows the pixel of figure 8");
    // A cone that rises from the horizon towards one of the upper edges.
    let (axis, half_angle) = (tilted_up(), Angle::from_degrees(75.522));
    let sky = CameraModel::Cylinder(CylinderCamera::new(CylinderKind::Mercator)).view(960, 720)?;
    let mercator = World::new([("Mercator".to_owned(), sky)])?;
    let (cube, _) = cube(BuiltinWorld::Directions)?;
    let drawings = [
        (UNFOLDED, unfolded(faces, target)?, "the unfolded cube with the field of view"),
        (OWNERSHIP, of_frame.ownership(), "which face gives which pixel"),
        (SCREEN, figures::circles(target), "round pixels on the screen"),
        (TEXTURE, of_frame.footprints(), "their footprints on the faces"),
        (PARABOLOID, figures::paraboloid(&four, target, PIXEL).ok_or_else(no_pixel)?, "contours of Q"),
        (KERNEL, figures::kernel(gaussian, "exp(-2 r²)"), "the kernel"),
        (CONE_IN_MERCATOR, figures::cone(&mercator, axis, half_angle).0, "a reflection cone in Mercator's projection"),
        (CONE_ON_CUBE, figures::cone(&cube, axis, half_angle).0, "the same cone on a cube"),
    ];
    for (name, svg, what) in drawings {
        let start = Instant::now();
        for file in diagram::draw(folder, name, &svg, &console.unfinished)? {
            file.appear()?;
        }
        for file in diagram::files(folder, name) {
            tell(console, &file, what, start)?;
        }
    }
    Ok(())
}

/// Returns the axis of the reflection cone: so high that the cone touches all faces but the lower one.
fn tilted_up() -> Direction {
    let degrees = Angle::from_degrees;
    Orientation::from_yaw_pitch_roll(degrees(25.0), degrees(65.0), degrees(0.0)).to_world(Direction::FRONT)
}
