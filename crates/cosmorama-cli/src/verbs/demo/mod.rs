mod animation;
pub(super) mod figures;
pub(super) mod plates;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use anyhow::Result;
use cosmorama::camera::{CameraModel, Canvas, OmnimaxCamera, PixelRect, View};
use cosmorama::explain::{Figures, Underlay};
use cosmorama::filter::{FilterKind, FilterSettings};
use cosmorama::raster::{Channels, Depth, EncodedImage, Transfer};
use cosmorama::render::{Accuracy, Needs};
use cosmorama::sphere::{CubeFace, Orientation};
use cosmorama::world::World;
use cosmorama_builtin::{DemoWorld, picture};
use cosmorama_convert::{Conversion, Existing, face_placement, refuse_existing, threads};
use cosmorama_io::{FacePlacement, Metadata, WriteOptions, write};
use cosmorama_spec::{Cube, FilterName, Size};

use super::{convert, diagram, make_folder};
use crate::args::convert::LimitArgs;
use crate::args::{DemoArgs, ProgressStyle};
use crate::console::Console;
use crate::failure::usage;

/// Edge of a whole face, in pixels. The frame has the paper's size.
const FACE: usize = 1024;
const FRAME: (usize, usize) = (1966, 1436);

/// Folder of the faces, the frames with the filter of each, and the drawing.
const FACES: &str = "faces";
const FRAMES: [(&str, FilterKind); 2] = [("omnimax.png", FilterKind::Ewa), ("omnimax-point.png", FilterKind::Point)];
const UNFOLDED: &str = "unfolded";

/// Folder of the animation.
const ANIMATION: &str = "animation";

/// A face of which only the part that the frame needs is rendered.
struct PartialFace {
    face: CubeFace,
    window: PixelRect,
    view: View,
}

/// Renders the demo world and makes an Omnimax frame of it.
pub(super) fn run(args: &DemoArgs, console: &Console) -> Result<ExitCode> {
    if args.dir.to_str().is_none() {
        return Err(usage(format!(
            "{}: the folder's name is no text in UTF-8, as the commands that the demo prints must be; name another one",
            args.dir.display()
        )));
    }
    let start = Instant::now();
    let target = CameraModel::Omnimax(OmnimaxCamera::default()).view(FRAME.0, FRAME.1)?;
    let pool = threads(args.limits.threads)?;
    let faces = pool.install(|| needed_faces(&target))?;
    if !args.may_replace() {
        refuse_existing(outputs(&args.dir, &faces).iter().map(PathBuf::as_path))?;
    }
    let folder = args.dir.join(FACES);
    let _folders = make_folder(&folder, console)?;
    for partial in &faces {
        pool.install(|| render_face(partial, &folder, console))?;
    }
    let source = folder.join("{face}.png");
    for (name, filter) in FRAMES {
        repeatable_conversion(&args.limits, &source, &args.dir.join(name), &from(&faces), filter, console)?;
    }
    pool.install(|| draw_unfolded(&args.dir, &faces, &target, console))?;
    if let Some(frames) = args.animation {
        animation::run(args, frames, &args.dir.join(ANIMATION), console)?;
    }
    console.print(&format!("all of it in {:.2} s\n", start.elapsed().as_secs_f64()))?;
    Ok(ExitCode::SUCCESS)
}

/// Returns every file that is written.
fn outputs(folder: &Path, faces: &[PartialFace]) -> Vec<PathBuf> {
    let faces = faces.iter().map(|partial| face_file(&folder.join(FACES), partial.face));
    let frames = FRAMES.iter().map(|(name, _)| folder.join(name));
    faces.chain(frames).chain(diagram::files(folder, UNFOLDED)).collect()
}

fn face_file(folder: &Path, face: CubeFace) -> PathBuf {
    folder.join(face.name()).with_extension("png")
}

/// Returns the faces that the frame needs, each with the window that the filter reads.
fn needed_faces(target: &View) -> Result<Vec<PartialFace>> {
    let whole = |face: CubeFace| face_view(face, None, FACE, FACE);
    let views: Result<Vec<_>> = CubeFace::ALL.iter().map(|&face| Ok((face.name().to_owned(), whole(face)?))).collect();
    let needs =
        Needs::of(&World::new(views?)?, std::slice::from_ref(target), &FilterSettings::DEFAULT, Accuracy::Exact);
    let mut faces = Vec::new();
    for (face, need) in CubeFace::ALL.into_iter().zip(&needs.views) {
        let Some(window) = need.seen.and(need.read) else { continue };
        let canvas = Canvas { width: FACE, height: FACE, left: window.left as i64, top: window.top as i64 };
        let view = face_view(face, Some(canvas), window.width(), window.height())?;
        faces.push(PartialFace { face, window, view });
    }
    Ok(faces)
}

fn face_view(face: CubeFace, canvas: Option<Canvas>, width: usize, height: usize) -> Result<View> {
    let upright = FacePlacement::UPRIGHT;
    Ok(face_placement(&Cube::default(), face, upright, canvas, Orientation::IDENTITY).view(width, height)?)
}

fn render_face(partial: &PartialFace, folder: &Path, console: &Console) -> Result<()> {
    let start = Instant::now();
    let PartialFace { face, window, view } = partial;
    let light = picture(&DemoWorld, view);
    let encoded = EncodedImage::encode(&light, Channels::Rgb, Depth::Eight, &Transfer::Srgb);
    let metadata = Metadata { transfer: Some(Transfer::Srgb), ..Metadata::default() };
    let path = face_file(folder, *face);
    let options = WriteOptions { unfinished: console.unfinished.clone(), ..WriteOptions::with_metadata(metadata) };
    write(&path, &encoded, &options)?;
    tell(console, &path, &format!("the {face} face, {window} of {FACE}x{FACE}, rendered"), start)
}

/// Returns the SPEC that declares the windows.
fn from(faces: &[PartialFace]) -> String {
    let cropped = faces.iter().filter(|partial| (partial.window.width(), partial.window.height()) != (FACE, FACE));
    let canvas = |partial: &PartialFace| {
        let PixelRect { left, top, .. } = partial.window;
        format!("canvas.{}={FACE}x{FACE}+{left}+{top}", partial.face)
    };
    let canvases: Vec<String> = cropped.map(canvas).collect();
    if canvases.is_empty() { "cube".to_owned() } else { format!("cube:{}", canvases.join(",")) }
}

/// Converts as the printed command does.
fn repeatable_conversion(
    limits: &LimitArgs,
    input: &Path,
    output: &Path,
    from: &str,
    filter: FilterKind,
    console: &Console,
) -> Result<()> {
    let start = Instant::now();
    let (input, output_name) = (input.display().to_string(), output.display().to_string());
    let mut conversion = Conversion::new(&input, &output_name)
        .from(from.parse()?)
        .to("omnimax".parse()?)
        .size(Size { width: FRAME.0, height: Some(FRAME.1) })
        .filter(FilterName(filter))
        .existing(Existing::Replace);
    conversion.limits = limits.clone().into();
    convert::convert(conversion, ProgressStyle::Auto, console)?;
    tell(console, output, "the Omnimax frame", start)?;
    let size = format!("{}x{}", FRAME.0, FRAME.1);
    let mut words =
        vec!["cosmorama", "convert", &input, &output_name, "--from", from, "--to", "omnimax", "--size", &size];
    if filter == FilterKind::Point {
        words.extend(["--filter", "point"]);
    }
    words.push("-y");
    console.print(&format!("  {}\n", words.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" ")))
}

/// Quotes a word for a shell.
fn quoted(word: &str) -> String {
    let plain = |letter: char| letter.is_ascii_alphanumeric() || "-_./:=,+".contains(letter);
    if word.chars().all(plain) { word.to_owned() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}

fn draw_unfolded(folder: &Path, faces: &[PartialFace], target: &View, console: &Console) -> Result<()> {
    let start = Instant::now();
    for file in diagram::draw(folder, UNFOLDED, &unfolded(faces, target)?, &console.unfinished)? {
        file.appear()?;
    }
    let [vector, raster] = diagram::files(folder, UNFOLDED);
    tell(console, &vector, "the unfolded cube with the frame's field of view", start)?;
    tell(console, &raster, "the same as pixels", start)
}

/// Draws the unfolded cube with the faces' pictures.
fn unfolded(faces: &[PartialFace], target: &View) -> Result<String> {
    let world = World::new(faces.iter().map(|partial| (partial.face.name().to_owned(), partial.view.clone())))?;
    let needs = Needs::of(&world, std::slice::from_ref(target), &FilterSettings::DEFAULT, Accuracy::Exact);
    let underlay =
        |(view, partial): (usize, &PartialFace)| Underlay { view, href: format!("{FACES}/{}.png", partial.face) };
    let underlays: Vec<Underlay> = faces.iter().enumerate().map(underlay).collect();
    Ok(Figures { world: &world, target }.unfolded(&needs, &underlays))
}

fn tell(console: &Console, path: &Path, what: &str, start: Instant) -> Result<()> {
    console.print(&format!("{:<40} {what} in {:.2} s\n", path.display().to_string(), start.elapsed().as_secs_f64()))
}
