//! The demo's animation: a camera that turns in its world, seen through an eyepiece.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use anyhow::{Context, Result, bail};
use cosmorama::camera::{CameraModel, CubeFaceCamera, View};
use cosmorama::motion::{Shutter, ShutterCurve, Smoothness};
use cosmorama::sphere::CubeFace;
use cosmorama_builtin::{DemoWorld, Eyepiece, picture};
use cosmorama_convert::{
    Backdrop, BlurMethod, CameraMovement, Conversion, Existing, MotionBlur, PoseFile, refuse_existing, threads,
};
use cosmorama_io::FrameList;
use cosmorama_spec::Size;

use super::command::quoted;
use crate::args::{DemoArgs, ProgressStyle};
use crate::console::Console;
use crate::verbs::{convert, make_folder, save_png, tell_made};

/// Edge of the world's faces, size of the frames, and frames in a second.
const FACE: usize = 768;
const FRAME: (usize, usize) = (640, 360);
const RATE: u64 = 24;

/// Camera and plate.
const PERSPECTIVE: &str = "perspective:fov=70";

/// Degrees to the right in each frame, and the poses between which the camera nods and rolls, so many frames apart.
const TURN: u64 = 3;
const APART: u64 = 12;
const NODS: [(i64, i64); 4] = [(0, 0), (7, -6), (2, 5), (-4, 0)];

/// Files in the animation's folder.
const WORLD: &str = "world/{face}.png";
const PLATE: &str = "eyepiece.png";
const PATH: &str = "path.csv";
const FRAMES: &str = "frame_####.png";
const VIDEO: &str = "animation.mp4";

/// Makes the frames of the animation in a folder, and a video of them where ffmpeg is installed.
pub(super) fn run(args: &DemoArgs, frames: u64, folder: &Path, console: &Console) -> Result<()> {
    if !args.may_replace() {
        refuse_existing(outputs(folder, frames).iter().map(PathBuf::as_path))?;
    }
    let start = Instant::now();
    let _folders = [make_folder(folder, console)?, make_folder(&folder.join("world"), console)?];
    threads(args.limits.threads)?.install(|| render(folder, console))?;
    std::fs::write(folder.join(PATH), poses(frames))
        .with_context(|| format!("cannot write {}", folder.join(PATH).display()))?;
    tell_made(console, &folder.join(WORLD), "the world's faces", start)?;
    let start = Instant::now();
    convert::convert(conversion(args, frames, folder)?, ProgressStyle::Auto, console)?;
    tell_made(console, &folder.join(FRAMES), "the frames", start)?;
    console.print(&format!("  {}\n", command(folder)))?;
    video(folder, console)
}

/// Returns every file that is written.
fn outputs(folder: &Path, frames: u64) -> Vec<PathBuf> {
    let faces = CubeFace::ALL.map(|face| folder.join(WORLD.replace("{face}", face.name())));
    let frames = (1..=frames).map(|frame| folder.join(FRAMES.replace("####", &format!("{frame:04}"))));
    faces.into_iter().chain([PLATE, PATH, VIDEO].map(|name| folder.join(name))).chain(frames).collect()
}

/// Renders the world and the eyepiece.
fn render(folder: &Path, console: &Console) -> Result<()> {
    let view = CameraModel::CubeFace(CubeFaceCamera).view(FACE, FACE)?;
    for face in CubeFace::ALL {
        let light = picture(&DemoWorld, &View { orientation: face.orientation(), ..view.clone() });
        save_png(&folder.join(WORLD.replace("{face}", face.name())), &light, console)?;
    }
    save_png(&folder.join(PLATE), &Eyepiece.picture(FRAME.0, FRAME.1), console)
}

/// Returns the camera's path as a table.
fn poses(frames: u64) -> String {
    let last = frames.next_multiple_of(APART);
    let keys = (0..=last).step_by(APART as usize).zip(NODS.iter().cycle());
    let row = |(frame, (pitch, roll)): (u64, &(i64, i64))| format!("{frame},{},{pitch},{roll}\n", TURN * frame);
    format!("frame,yaw,pitch,roll\n{}", keys.map(row).collect::<String>())
}

/// Returns the conversion that makes the frames: the eyepiece goes with the camera, and the world stands behind it.
fn conversion(args: &DemoArgs, frames: u64, folder: &Path) -> Result<Conversion> {
    let name = |file: &str| folder.join(file).display().to_string();
    let path = PoseFile { file: name(PATH), fps: None, smoothness: Smoothness::Smooth };
    let shutter = Shutter { fraction: 0.5, phase: 0.5, curve: ShutterCurve::Box };
    let mut conversion = Conversion::new(name(PLATE), name(FRAMES))
        .from(PERSPECTIVE.parse()?)
        .to(PERSPECTIVE.parse()?)
        .size(Size { width: FRAME.0, height: Some(FRAME.1) })
        .moved(CameraMovement::Path(path.clone()))
        .frames(FrameList::new(1..=frames))
        .over(Backdrop::new(name(WORLD)))
        .existing(Existing::Replace);
    conversion.geometry.in_path = Some(path);
    conversion.geometry.blur = Some(MotionBlur { shutter, method: BlurMethod::Swept });
    conversion.limits = args.limits.clone().into();
    Ok(conversion)
}

/// Returns the command that makes the frames.
fn command(folder: &Path) -> String {
    let name = |file: &str| quoted(&folder.join(file).display().to_string());
    format!(
        "cosmorama convert {} {} --from {PERSPECTIVE} --in-path {path} --backdrop {} --to {PERSPECTIVE} --size {}x{} --path {path} \
         --path-curve smooth --shutter 0.5 -y",
        name(PLATE),
        name(FRAMES),
        name(WORLD),
        FRAME.0,
        FRAME.1,
        path = name(PATH)
    )
}

/// Makes a video by ffmpeg, or says how where that is not installed.
fn video(folder: &Path, console: &Console) -> Result<()> {
    let start = Instant::now();
    let (frames, video) = (folder.join(FRAMES.replace("####", "%04d")), folder.join(VIDEO));
    let mut ffmpeg = Command::new("ffmpeg");
    ffmpeg.args(["-y", "-loglevel", "error", "-framerate", &RATE.to_string(), "-i"]).arg(&frames);
    ffmpeg.args(["-pix_fmt", "yuv420p", "-movflags", "+faststart"]).arg(&video).stdin(Stdio::null());
    match ffmpeg.output() {
        Ok(made) if made.status.success() => tell_made(console, &video, "the video, by ffmpeg,", start),
        Ok(made) => bail!("ffmpeg could not make {}: {}", video.display(), String::from_utf8_lossy(&made.stderr).trim()),
        Err(error) if error.kind() == ErrorKind::NotFound => console.print(&format!(
            "ffmpeg is not installed; where it is, this makes a video:\n  ffmpeg -framerate {RATE} -i {} -pix_fmt yuv420p {}\n",
            quoted(&frames.display().to_string()),
            quoted(&video.display().to_string())
        )),
        Err(error) => Err(error).context("ffmpeg cannot be started"),
    }
}
