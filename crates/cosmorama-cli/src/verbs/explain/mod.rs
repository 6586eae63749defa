mod cost;
mod template;

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::Result;
use cosmorama::camera::PixelRect;
use cosmorama::explain::{Centre, FaceSize, Figures, Magnification, Report, ViewReport};
use cosmorama::render::Needs;
use cosmorama::world::World;
use cosmorama_convert::{Explanation, ExplanationSettings, PathExplanation, Picture, check_apart, refuse_existing};
use cosmorama_io::pending::Hidden;
use serde_json::{Value, json};

use super::convert::Watch;
use super::make_folder;
use crate::args::{ExplainArgs, ProgressStyle};
use crate::console::Console;
use crate::diagram;
use crate::failure::usage;
use crate::pipe::KeptStreams;

/// Tells what a conversion will do.
pub(super) fn run(mut args: ExplainArgs, console: &mut Console) -> Result<ExitCode> {
    if let Some(idle) = args.camera.idle(&args.geometry, None).or_else(|| args.shutter.idle()) {
        return Err(usage(idle));
    }
    let mut kept = KeptStreams::default();
    args.input = args.input.map(|input| kept.input(&input)).transpose()?;
    let (output, overwrite, as_json, has_input) = (args.output.take(), args.overwrite, args.json, args.input.is_some());
    let (template, distances) = (args.template.take(), args.travel.zip(args.nearest));
    if let Some(folder) = &template {
        let files = template::write(folder, &args.geometry.clone().into(), overwrite, console)?;
        let mut told = files.iter().filter(|_| !as_json);
        told.try_for_each(|file| console.print(&format!("wrote    {}\n", file.display())))?;
        if !has_input && args.geometry.from.is_none() {
            return Ok(ExitCode::SUCCESS);
        }
    }
    let checked = ExplanationSettings { files: kept.files(), ..args.into() }.check();
    console.tell_all(&checked);
    let explanation = checked.result?;
    if let Some(folder) = &output {
        check_folder(folder)?;
        check_diagrams(folder, &explanation, overwrite)?;
    }
    let worlds = explanation.worlds()?;
    let _folders = output.as_deref().map(|folder| make_folder(folder, console)).transpose()?;
    let mut watch = Watch::new(console, ProgressStyle::Auto);
    let path = explanation.path(&worlds, &mut watch)?;
    watch.finish();
    let (mut text, mut reports, mut drawn, mut found) = (String::new(), Vec::new(), Vec::new(), Vec::new());
    let mut needed = HashSet::new();
    for picture in explanation.pictures() {
        let report = explanation.report(&worlds, picture);
        if let Some(label) = picture.label() {
            text += &format!("{label}:\n");
        }
        text += &format!("{report}");
        needed.extend(report.views.iter().filter(|view| view.need.seen.is_some()).map(|view| view.need.name.clone()));
        let files = match &output {
            Some(folder) => {
                drawn.extend(draw(folder, picture, &worlds[picture.world(worlds.len())], &needs(&report), console)?);
                diagrams(folder, picture)
            }
            None => Vec::new(),
        };
        for file in &files {
            text += &format!("wrote    {}\n", file.display());
        }
        reports.push(to_json(&report, &explanation, &files));
        found.push(report);
    }
    let costs = explanation.costs(&worlds, &found);
    text += &cost::text(&costs, explanation.frames());
    if let Some(first) = reports.first_mut() {
        first["cost"] = cost::json(&costs, explanation.frames());
    }
    if let Some(path) = &path {
        text += &path_text(path, has_input);
        let files = output.as_deref().map_or_else(Vec::new, |folder| diagram::files(folder, PATH_DIAGRAM));
        if let Some(folder) = &output {
            let svg = Figures::path(&worlds[0], &path.views);
            drawn.extend(diagram::draw(folder, PATH_DIAGRAM, &svg, &console.unfinished)?);
        }
        files.iter().for_each(|file| text += &format!("wrote    {}\n", file.display()));
        if let Some(first) = reports.first_mut() {
            first["path"] = path_json(path, has_input, &files);
        }
    }
    if let Some((travel, nearest)) = distances {
        let parallax = explanation.parallax(path.as_ref(), travel, nearest)?;
        text += &format!("{parallax}");
        if let Some(first) = reports.first_mut() {
            first["parallax"] = json!({
                "travel": travel, "nearest": nearest, "degrees": parallax.degrees, "pixels": parallax.pixels,
                "unseen_from": parallax.unseen_from,
            });
        }
    }
    // All diagrams, or none.
    Hidden::appear_all(drawn)?;
    if has_input {
        for view in explanation.views_without_files().filter(|view| needed.contains(&view.name)) {
            let folder = if view.files.is_folder() { ", but a folder of this name" } else { "" };
            text += &format!("missing  {}: no {}{folder}\n", view.name, view.files.path(None).display());
        }
    }
    if as_json {
        console.print(&(serde_json::to_string_pretty(&reports)? + "\n"))?;
    } else {
        console.print(&text)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Name of the diagram of a path.
const PATH_DIAGRAM: &str = "path";

/// Tells of a moving camera's path.
fn path_text(path: &PathExplanation, has_input: bool) -> String {
    let mut text = format!("\nframes   {}; the figures above are of the first\n{}", path.frames, path.report);
    if path.gaps.is_empty() && has_input {
        text += "inside   all of it is in the input, frame by frame\n";
    }
    path.gaps.iter().for_each(|gap| text += &format!("outside  {gap}\n"));
    text
}

fn path_json(path: &PathExplanation, has_input: bool, files: &[PathBuf]) -> Value {
    let report = &path.report;
    let advised = |(name, size): &(String, FaceSize)| json!({ "view": name, "parity": [size.parity.0, size.parity.1] });
    json!({
        "frames": path.frames.to_string(),
        "count": report.frames,
        "seen": report.seen,
        "seen_at_once": report.at_once,
        "advised_size": report.advised.iter().map(advised).collect::<Vec<_>>(),
        "inside": has_input.then_some(path.gaps.is_empty()),
        "gaps": path.gaps,
        "diagrams": files.iter().map(|file| file.display().to_string()).collect::<Vec<_>>(),
    })
}

/// Refuses a folder that has the name of a drawing: one file was meant.
fn check_folder(folder: &Path) -> Result<()> {
    let extension =
        folder.extension().and_then(|extension| extension.to_str()).unwrap_or_default().to_ascii_lowercase();
    if !["svg", "png", "pdf", "jpg"].contains(&extension.as_str()) || folder.exists() {
        return Ok(());
    }
    let folder = folder.display();
    Err(usage(format!(
        "{folder}: diagrams are several files, so that --output takes a folder; name one, as in --output diagrams"
    )))
}

/// Checks that diagrams replace no input, nor any other file unless asked to.
fn check_diagrams(folder: &Path, explanation: &Explanation, overwrite: bool) -> Result<()> {
    let mut files: Vec<PathBuf> = explanation.pictures().iter().flat_map(|picture| diagrams(folder, picture)).collect();
    if explanation.moves() {
        files.extend(diagram::files(folder, PATH_DIAGRAM));
    }
    files.iter().try_for_each(|path| check_apart(path, explanation.files()))?;
    if !overwrite {
        refuse_existing(files.iter().map(PathBuf::as_path))?;
    }
    Ok(())
}

/// Returns the needs that the report has already found.
fn needs(report: &Report) -> Needs {
    Needs { views: report.views.iter().map(|view| view.need.clone()).collect(), uncovered: report.uncovered }
}

fn draw(folder: &Path, picture: &Picture, world: &World, needs: &Needs, console: &Console) -> Result<Vec<Hidden>> {
    let figures = Figures { world, target: &picture.view };
    let drawings = [figures.unfolded(needs, &[]), figures.ownership(), figures.footprints()];
    let mut files = Vec::new();
    for (name, svg) in diagram_names(picture).iter().zip(&drawings) {
        files.extend(diagram::draw(folder, name, svg, &console.unfinished)?);
    }
    Ok(files)
}

fn diagram_names(picture: &Picture) -> [String; 3] {
    let suffix = picture.label().map_or_else(String::new, |label| format!("-{label}"));
    ["unfolded", "ownership", "footprints"].map(|name| format!("{name}{suffix}"))
}

/// Returns the files that the diagrams of a picture go to.
fn diagrams(folder: &Path, picture: &Picture) -> Vec<PathBuf> {
    diagram_names(picture).iter().flat_map(|name| diagram::files(folder, name)).collect()
}

fn to_json(report: &Report, explanation: &Explanation, files: &[PathBuf]) -> Value {
    let views: Vec<Value> = report.views.iter().map(view_json).collect();
    let missing: Vec<&str> = explanation.views_without_files().map(|view| view.name.as_str()).collect();
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
    let texels = centre.view.map(|(_, found)| range_json(found));
    json!({ "yaw": yaw.degrees(), "pitch": pitch.degrees(), "view": view, "texels_a_pixel": texels })
}

/// Returns the least and the greatest number of texels a pixel; null where these are any number.
fn range_json(found: Magnification) -> Value {
    json!([found.least, Some(found.greatest).filter(|greatest| *greatest <= Magnification::MANY)])
}

fn view_json(view: &ViewReport) -> Value {
    let rect = |rect: PixelRect| rect.to_string();
    json!({
        "name": view.need.name,
        "width": view.size.0,
        "height": view.size.1,
        "needed": view.need.seen.map(rect),
        "read": view.need.read.map(rect),
        "texels_used": view.used,
        "share_of_picture": view.share,
        "texels_a_pixel": view.magnification.map(range_json),
        "advised_size": view.advised.map(|advised| [advised.parity.0, advised.parity.1]),
    })
}
