mod animation;
pub(super) mod command;
pub(super) mod faces;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use anyhow::Result;
use cosmorama::filter::FilterKind;
use cosmorama_convert::{refuse_existing, threads};

use self::faces::Faces;
use super::{make_folder, tell_made};
use crate::args::{DemoArgs, ProgressStyle};
use crate::console::Console;
use crate::diagram;
use crate::failure::usage;

/// Frames, with the filter of each.
const FRAMES: [(&str, FilterKind); 2] = [("omnimax.png", FilterKind::Ewa), ("omnimax-point.png", FilterKind::Point)];

/// Drawing.
const UNFOLDED: &str = "unfolded";

/// Folder of the animation.
const ANIMATION: &str = "animation";

/// Renders the demo world and makes an Omnimax frame of it.
pub(super) fn run(args: &DemoArgs, console: &Console) -> Result<ExitCode> {
    if args.dir.to_str().is_none() {
        return Err(usage(format!(
            "{}: the folder's name is no text in UTF-8, as the commands that the demo prints must be; name another one",
            args.dir.display()
        )));
    }
    let start = Instant::now();
    let pool = threads(args.limits.threads)?;
    let faces = pool.install(|| Faces::needed(&args.dir))?;
    if !args.may_replace() {
        refuse_existing(outputs(&args.dir, &faces).iter().map(PathBuf::as_path))?;
    }
    let _folders = make_folder(&faces.folder(), console)?;
    for part in &faces.parts {
        pool.install(|| faces.render(part, console))?;
    }
    for (name, filter) in FRAMES {
        command::omnimax(&faces, (&args.dir.join(name), filter), (&args.limits, ProgressStyle::Auto), console)?;
    }
    pool.install(|| draw_unfolded(&args.dir, &faces, console))?;
    if let Some(frames) = args.animation {
        animation::run(args, frames, &args.dir.join(ANIMATION), console)?;
    }
    console.print(&format!("all of it in {:.2} s\n", start.elapsed().as_secs_f64()))?;
    Ok(ExitCode::SUCCESS)
}

/// Returns every file that is written.
fn outputs(folder: &Path, faces: &Faces) -> Vec<PathBuf> {
    let frames = FRAMES.iter().map(|(name, _)| folder.join(name));
    faces.files().chain(frames).chain(diagram::files(folder, UNFOLDED)).collect()
}

fn draw_unfolded(folder: &Path, faces: &Faces, console: &Console) -> Result<()> {
    let start = Instant::now();
    let drawn = diagram::save(folder, UNFOLDED, &faces.unfolded()?, &console.unfinished)?;
    let about = ["the unfolded cube with the frame's field of view", "the same as pixels"];
    drawn.iter().zip(about).try_for_each(|(file, about)| tell_made(console, file, about, start))
}
