use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::Result;
use cosmorama::camera::PixelRect;
use cosmorama::explain::{Centre, Figures, Magnification, Report, ViewReport};
use cosmorama::render::Needs;
use cosmorama::world::World;
use cosmorama_io::pending::Hidden;
use serde_json::{Value, json};

use super::pipe::KeptStreams;
use super::{diagram, make_folder, print, use_threads};
use crate::args::ExplainArgs;
use crate::failure::{usage, warn};
use crate::job::{
    Builtin, Input, MemoryBudget, Picture, check_apart, files_read, filter, nominal_worlds, refuse_existing, settled,
};

/// Tells what a conversion will do.
pub(super) fn run(args: &ExplainArgs) -> Result<ExitCode> {
    use_threads(args.limits.threads)?;
    let (mut kept, mut args) = (KeptStreams::default(), args.clone());
    args.input = args.input.map(|input| kept.input(&input)).transpose()?;
    let args = &args;
    let mut warnings = Vec::new();
    let (mut input, pictures) = resolve(args, &mut warnings)?;
    warnings.extend(input.turned());
    input.fit_eyes(pictures.iter().any(|picture| picture.eye.is_some()), &mut warnings);
    let filter = filter(&args.geometry, &mut warnings);
    warnings.iter().for_each(|warning| warn(warning));
    if let Some(folder) = &args.output {
        check_diagrams(folder, &pictures, &input, args)?;
    }
    let memory = MemoryBudget::new(args.limits.memory);
    memory.check_sizes(pictures.iter().map(|picture| (picture.view.width(), picture.view.height())))?;
    let worlds = nominal_worlds(&input, memory)?;
    let (mut text, mut reports, mut drawn) = (String::new(), Vec::new(), Vec::new());
    for picture in &pictures {
        let world = &worlds[picture.world(worlds.len())];
        let report = Report::of(world, &picture.view, &filter);
        if let Some(label) = picture.label() {
            text += &format!("{label}:\n");
        }
        text += &format!("{report}");
        let files = match &args.output {
            Some(folder) => {
                drawn.extend(draw(folder, picture, world, &needs(&report))?);
                diagrams(folder, picture)
            }
            None => Vec::new(),
        };
        for file in &files {
            text += &format!("wrote    {}\n", file.display());
        }
        reports.push(to_json(&report, &input, &files));
    }
    // All diagrams, or none.
    drawn.into_iter().try_for_each(Hidden::appear)?;
    if args.input.is_some() {
        for view in input.views().filter(|view| view.window.is_none()) {
            let folder = if view.files.is_folder() { ", but a folder of this name" } else { "" };
            text += &format!("missing  {}: no {}{folder}\n", view.name, view.files.path(None).display());
        }
    }
    if args.json {
        print(&(serde_json::to_string_pretty(&reports)? + "\n"))?
    } else {
        print(&text)?
    }
    Ok(ExitCode::SUCCESS)
}

/// An input on disk decides how large the output is; one that does not exist yet follows the output.
fn resolve(args: &ExplainArgs, warnings: &mut Vec<String>) -> Result<(Input, Vec<Picture>)> {
    let memory = MemoryBudget::new(args.limits.memory);
    let geometry = &settled(&args.geometry, args.input.as_deref(), memory, warnings)?;
    if geometry.to.is_none() {
        return Err(usage("--to is missing: say which projection the output is to have, as in --to omnimax"));
    }
    match (&args.input, &geometry.from) {
        (Some(pattern), _) if Builtin::named(pattern)?.is_some() => Err(usage(format!(
            "{pattern} is a formula: nothing is resampled, so there is nothing to explain; for its picture in a projection, \
             explain --from SPEC"
        ))),
        (Some(pattern), from) => {
            let input = Input::find(pattern, from.as_ref(), None, memory, warnings)?;
            let pictures = Picture::all(geometry, None, Some(input.pixels_per_radian()))?;
            Ok((input, pictures))
        }
        (None, Some(from)) => {
            let own = match args.input_size {
                Some(_) => Some(Input::nominal(from, args.input_size, 0.0)?.pixels_per_radian()),
                None => None,
            };
            let pictures = Picture::all(geometry, None, own)?;
            let centre = pictures.first().map_or(1.0, |picture| picture.view.pixels_per_radian());
            Ok((Input::nominal(from, args.input_size, centre)?, pictures))
        }
        (None, None) => Err(usage("give an input, or --from for one that does not exist yet")),
    }
}

/// Diagrams replace no input, nor anything else unasked.
fn check_diagrams(folder: &Path, pictures: &[Picture], input: &Input, args: &ExplainArgs) -> Result<()> {
    let inputs = files_read(input, &args.geometry);
    let files: Vec<PathBuf> = pictures.iter().flat_map(|picture| diagrams(folder, picture)).collect();
    files.iter().try_for_each(|path| check_apart(path, &inputs))?;
    if args.overwrite { Ok(()) } else { refuse_existing(files.iter().map(PathBuf::as_path), "") }
}

/// What the report has found out already.
fn needs(report: &Report) -> Needs {
    Needs { views: report.views.iter().map(|view| view.need.clone()).collect(), uncovered: report.uncovered }
}

fn draw(folder: &Path, picture: &Picture, world: &World, needs: &Needs) -> Result<Vec<Hidden>> {
    make_folder(folder)?;
    let figures = Figures { world, target: &picture.view };
    let drawings = [figures.unfolded(needs, &[]), figures.ownership(), figures.footprints()];
    let mut files = Vec::new();
    for (name, svg) in diagram_names(picture).iter().zip(&drawings) {
        files.extend(diagram::draw(folder, name, svg)?);
    }
    Ok(files)
}

fn diagram_names(picture: &Picture) -> [String; 3] {
    let suffix = picture.label().map_or_else(String::new, |label| format!("-{label}"));
    ["unfolded", "ownership", "footprints"].map(|name| format!("{name}{suffix}"))
}

/// The files that the diagrams of a picture go to.
fn diagrams(folder: &Path, picture: &Picture) -> Vec<PathBuf> {
    diagram_names(picture).iter().flat_map(|name| diagram::files(folder, name)).collect()
}

fn to_json(report: &Report, input: &Input, files: &[PathBuf]) -> Value {
    let views: Vec<Value> = report.views.iter().map(view_json).collect();
    let missing: Vec<&str> =
        input.views().filter(|view| view.window.is_none()).map(|view| view.name.as_str()).collect();
    json!({
        "width": report.size.0,
        "height": report.size.1,
        "shown": report.shown,
        "centre": report.centre.map(|centre| centre_json(&centre, report)),
        "texels_used": report.used(),
        "texels_a_pixel": { "mean": report.gathered.mean, "most": report.gathered.most },
        "memory_bytes": {
            "texels": report.memory.texels, "pixels": report.memory.pixels, "levels": report.memory.levels,
            "plan": report.memory.plan, "plan_8_bits": report.memory.fixed_plan,
        },
        "uncovered_pixels": report.uncovered.map_or(0, |uncovered| uncovered.pixels),
        "views": views,
        "views_without_files": missing,
        "diagrams": files.iter().map(|file| file.display().to_string()).collect::<Vec<_>>(),
    })
}

fn centre_json(centre: &Centre, report: &Report) -> Value {
    let (yaw, pitch) = centre.direction.longitude_latitude();
    let view = centre.view.map(|(index, _)| report.views[index].need.name.as_str());
    let texels = centre.view.map(|(_, found)| [found.least, found.greatest]);
    json!({ "yaw": yaw.degrees(), "pitch": pitch.degrees(), "view": view, "texels_a_pixel": texels })
}

fn view_json(view: &ViewReport) -> Value {
    let rect = |rect: PixelRect| rect.to_string();
    let range = |found: Magnification| json!([found.least, found.greatest]);
    json!({
        "name": view.need.name,
        "width": view.size.0,
        "height": view.size.1,
        "needed": view.need.seen.map(rect),
        "read": view.need.read.map(rect),
        "texels_used": view.used,
        "share_of_picture": view.share,
        "texels_a_pixel": view.magnification.map(range),
        "advised_size": view.advised.map(|advised| [advised.parity.0, advised.parity.1]),
    })
}
