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
use cosmorama_convert::{refuse_existing, threads};
use cosmorama_io::{Metadata, WriteOptions, write};

use super::{
    FACE, FACES, FRAME, PartialFace, face_file, face_view, from, needed_faces, render_face, repeatable_conversion,
    tell, unfolded,
};
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
const DRAWINGS: [&str; 8] = [UNFOLDED, OWNERSHIP, SCREEN, TEXTURE, PARABOLOID, KERNEL, CONE_IN_MERCATOR, CONE_ON_CUBE];

/// Size of the frame that shows aliasing: a third of the paper's, so that a pixel holds two texels to four.
const SMALL: (usize, usize) = (655, 478);

/// Side of a check, in texels.
const CHECK: usize = 4;

const WHITE: Rgba = Rgba::opaque(1.0, 1.0, 1.0);

/// Places of that frame, from the rim to the middle.
const PLACES: [Crop; 4] = [(24, 210), (110, 110), (300, 16), (300, 210)];

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
    let (source, frame) = (args.dir.join(FACES).join("{face}.png"), args.dir.join(FRAME_PICTURE));
    repeatable_conversion(&args.limits, &source, &frame, &from(&faces), FilterKind::Ewa, console)?;
    pool.install(|| aliasing(&args.dir.join(ALIASING), console))?;
    pool.install(|| drawings(&args.dir, &faces, &target, console))?;
    Ok(ExitCode::SUCCESS)
}

/// Returns every file that is written.
fn outputs(folder: &Path, faces: &[PartialFace]) -> Vec<PathBuf> {
    let faces = faces.iter().map(|partial| face_file(&folder.join(FACES), partial.face));
    let pictures = [FRAME_PICTURE, ALIASING].map(|name| folder.join(name));
    faces.chain(pictures).chain(DRAWINGS.iter().flat_map(|name| diagram::files(folder, name))).collect()
}

/// Makes figure 6: checkerboard faces, point-sampled and filtered.
fn aliasing(path: &Path, console: &Console) -> Result<()> {
    let start = Instant::now();
    let (world, target) = (cube()?, CameraModel::Omnimax(OmnimaxCamera::default()).view(SMALL.0, SMALL.1)?);
    let check = |i: usize, j: usize| if (i / CHECK + j / CHECK).is_multiple_of(2) { Rgba::BLACK } else { WHITE };
    let light = Light::of_pictures(&world, CubeFace::ALL.map(|_| Image::from_fn(FACE, FACE, check)))?;
    let rows = [("point sampling", FilterKind::Point), ("filtering", FilterKind::Ewa)].map(|(name, kind)| {
        let filter = FilterSettings { kind, ..FilterSettings::DEFAULT };
        let picture = Resampler { world: &world, target: &target, filter }.render(light.texels());
        Row::new(vec![name.to_owned()], &picture, &PLACES)
    });
    let encoded = EncodedImage::encode(&sheet(&rows), Channels::Rgb, Depth::Eight, &Transfer::Srgb);
    let metadata = Metadata { transfer: Some(Transfer::Srgb), ..Metadata::default() };
    let options = WriteOptions { unfinished: console.unfinished.clone(), ..WriteOptions::with_metadata(metadata) };
    write(path, &encoded, &options)?;
    tell(console, path, "checkerboard faces, point-sampled and filtered", start)
}

/// Returns all six faces, whole.
fn cube() -> Result<World> {
    let view = |face: &CubeFace| Ok((face.name().to_owned(), face_view(*face, None, FACE, FACE)?));
    Ok(World::new(CubeFace::ALL.iter().map(view).collect::<Result<Vec<_>>>()?)?)
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
    let cube = cube()?;
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
