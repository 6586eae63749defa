use std::path::Path;
use std::process::ExitCode;

use anyhow::Result;
use cosmorama::circle::{Circle, Found};
use cosmorama::raster::Transfer;
use cosmorama_convert::{
    Builtin, Files, ThinAlpha, ViewFiles, damage_of, existing_frames, is_one_file, light_of, likely, probe,
};
use cosmorama_io::{EnvMap, FacePattern, FaceSet, Header, ProfileFault};
use serde_json::{Value, json};

use super::info_faces::{of_files, of_image};
use super::info_world;
use crate::args::InfoArgs;
use crate::console::Console;
use crate::pipe::KeptStreams;

/// Tells what a file or a face set is.
pub(super) fn run(args: &InfoArgs, console: &mut Console) -> Result<ExitCode> {
    let mut kept = KeptStreams::default();
    let input = &kept.input(&args.input)?;
    let files = &*kept.files();
    let report = if let Some(builtin) = Builtin::named(input)? {
        json!({ "input": input, "projection": "any (a formula)", "shows": builtin.about() })
    } else if FacePattern::parse(input).is_some() {
        faces(files, input, args.check)?
    } else if let Some(world) = info_world::report(files, input, console)? {
        world
    } else {
        single(files, input, args.check)?
    };
    if args.json {
        console.print(&(serde_json::to_string_pretty(&report)? + "\n"))?;
    } else {
        console.print(&lines(&report, 0))?;
    }
    // What is damaged is told, and no success.
    Ok(if is_damaged(&report) { ExitCode::FAILURE } else { ExitCode::SUCCESS })
}

fn is_damaged(report: &Value) -> bool {
    let Value::Object(fields) = report else { return false };
    fields.iter().any(|(key, value)| key == "damaged" || is_damaged(value))
}

fn single(inputs: &dyn Files, pattern: &str, check: bool) -> Result<Value> {
    let files = ViewFiles::new(Path::new(pattern));
    let frames = existing_frames(&files)?;
    let path = files.path(frames.first().copied());
    is_one_file(inputs, pattern, &path)?;
    let header = probe(inputs, &path)?;
    let mut report = json!({ "input": pattern });
    add_frames(&mut report, &frames);
    merge(&mut report, header_report(&header));
    let likely = likely(inputs, &path, &header);
    report["projection"] = json!(likely.projection);
    if let Some(damage) = &likely.damage {
        report["damaged"] = json!(damage);
    } else if check && frames.len() > 1 {
        add_damaged_frames(&mut report, inputs, &files, &frames);
    }
    let picture = if header.channels.has_alpha() { light_of(inputs, &path) } else { None };
    if let Some(told) = picture.and_then(|light| ThinAlpha::of(light.pixels().iter().copied())?.told()) {
        report["alpha"] = json!(told);
    }
    if let Some(found) = likely.circle {
        let Circle { centre: (x, y), radius } = found.circle();
        report["circle"] = json!({ "x": x, "y": y, "radius": radius, "measured": matches!(found, Found::Measured(_)) });
    }
    if let Some(continuity) = of_image(inputs, &path, &likely, header.metadata.envmap) {
        if let (true, Value::String(spec)) = (continuity["fits"] == true, &continuity["spec"]) {
            report["projection"] = json!(format!("{spec} (by its shape, and because the borders of its faces meet)"));
        }
        report["arrangement"] = continuity;
    }
    Ok(report)
}

/// Decodes every frame, and reports those that are damaged.
fn add_damaged_frames(report: &mut Value, inputs: &dyn Files, files: &ViewFiles, frames: &[u64]) {
    let damage = |frame: &u64| damage_of(inputs, &files.path(Some(*frame)));
    let damaged: Vec<String> = frames.iter().filter_map(damage).collect();
    if !damaged.is_empty() {
        report["damaged"] = json!(damaged);
    }
}

fn faces(inputs: &dyn Files, pattern: &str, check: bool) -> Result<Value> {
    let set = FaceSet::find(pattern, None)?;
    let mut report = json!({ "input": pattern, "projection": "cube", "naming": set.naming().name });
    let mut faces = serde_json::Map::new();
    for file in set.faces() {
        let mut face = json!({ "file": file.path.display().to_string(), "present": file.present });
        if file.placement != cosmorama_io::FacePlacement::UPRIGHT {
            face["lies"] = json!(format!(
                "turned clockwise by {} degrees{}",
                90 * u32::from(file.placement.quarter_turns),
                if file.placement.mirrored { ", mirrored" } else { "" }
            ));
        }
        if file.present {
            let files = ViewFiles::new(&file.path);
            let frames = existing_frames(&files)?;
            add_frames(&mut face, &frames);
            if check {
                add_damaged_frames(&mut face, inputs, &files, &frames);
            }
            merge(&mut face, header_report(&probe(inputs, &files.path(frames.first().copied()))?));
        }
        faces.insert(file.face.name().to_owned(), face);
    }
    report["faces"] = Value::Object(faces);
    match of_files(inputs, &set)? {
        Some(continuity) => report["arrangement"] = continuity,
        // Something may be the matter with a file.
        None => add_damage(&mut report, inputs, &set)?,
    }
    Ok(report)
}

/// Reports faces whose pixels cannot be read.
fn add_damage(report: &mut Value, inputs: &dyn Files, set: &FaceSet) -> Result<()> {
    for file in set.present() {
        let files = ViewFiles::new(&file.path);
        if let Some(damage) = damage_of(inputs, &files.path(existing_frames(&files)?.first().copied())) {
            report["faces"][file.face.name()]["damaged"] = json!(damage);
        }
    }
    Ok(())
}

fn header_report(header: &Header) -> Value {
    let metadata = &header.metadata;
    let mut report = json!({
        "format": header.format.to_string(),
        "width": header.width,
        "height": header.height,
        "channels": header.channels.to_string(),
        "depth": header.depth.to_string(),
        "transfer": transfer(header),
    });
    if let Some(window) = header.window {
        report["canvas"] = json!(format!("{}x{}+{}+{}", window.canvas_width, window.canvas_height, window.x, window.y));
    }
    if let Some(icc) = &metadata.icc {
        report["icc_profile_bytes"] = json!(icc.len());
    }
    if let Some(primaries) = metadata.primaries {
        report["primaries"] = json!(primaries.to_string());
    }
    if let Some(space) = metadata.colour_space() {
        report["colour_space"] = json!(space);
    }
    if let Some(white) = metadata.white_luminance {
        report["white"] = json!(format!("{white} cd/m²"));
    }
    match &metadata.profile_fault {
        Some(ProfileFault::Damaged(reason)) => report["icc_profile_damaged"] = json!(reason),
        Some(ProfileFault::Tables) => report["icc_profile_holds"] = json!("tables of colours, which are not followed"),
        None => {}
    }
    if let Some(envmap) = metadata.envmap {
        report["envmap"] = json!(match envmap {
            EnvMap::LatLong => "latlong",
            EnvMap::Cube | EnvMap::GlCube => "cube",
        });
    }
    if let Some(window) = metadata.panorama {
        let (width, height) = (window.canvas_width, window.canvas_height);
        report["gpano"] = json!(format!("equirectangular, {width}x{height}+{}+{}", window.x, window.y));
    }
    if !metadata.complaints.is_empty() {
        report["complaints"] = json!(metadata.complaints);
    }
    if !metadata.notes.is_empty() {
        report["notes"] = json!(metadata.notes);
    }
    if !metadata.other_channels.is_empty() {
        report["other_channels"] = json!(metadata.other_channels);
    }
    if let Some(orientation) = metadata.orientation {
        report["orientation"] = json!(format!("{orientation} (not followed: pixels are taken as they are stored)"));
    }
    if let Some(software) = &metadata.software {
        report["software"] = json!(software);
    }
    report
}

fn transfer(header: &Header) -> String {
    match &header.metadata.transfer {
        None if header.depth.is_float() => "linear (float files are)".to_owned(),
        None => "not said (taken for srgb)".to_owned(),
        Some(transfer) => match transfer {
            Transfer::Srgb => "srgb".to_owned(),
            Transfer::Linear => "linear".to_owned(),
            Transfer::Gamma(gamma) => format!("gamma:{gamma:.4}"),
            Transfer::Bt1886 => "bt1886".to_owned(),
            Transfer::Pq => "pq".to_owned(),
            Transfer::Hlg => "hlg".to_owned(),
            Transfer::Curve(_) => "icc".to_owned(),
        },
    }
}

fn add_frames(report: &mut Value, frames: &[u64]) {
    if !frames.is_empty() {
        report["frames"] = json!(cosmorama_io::FrameList::new(frames.iter().copied()).to_string());
    }
}

fn merge(into: &mut Value, from: Value) {
    if let (Value::Object(into), Value::Object(from)) = (into, from) {
        into.extend(from);
    }
}

/// Returns the report as indented lines.
fn lines(report: &Value, indent: usize) -> String {
    let Value::Object(fields) = report else { return String::new() };
    let pad = " ".repeat(indent);
    let line = |(key, value): (&String, &Value)| match value {
        Value::Object(face) if face.get("present") == Some(&Value::Bool(false)) => {
            format!("{pad}{key}: missing ({})\n", plain(&face["file"]))
        }
        Value::Object(arrangement) if arrangement.contains_key("told") => {
            format!("{pad}{key}: {}\n", plain(&arrangement["told"]))
        }
        Value::Object(_) => format!("{pad}{key}:\n{}", lines(value, indent + 2)),
        Value::Array(items) if items.iter().all(Value::is_object) => {
            items.iter().map(|item| format!("{pad}{key}:\n{}", lines(item, indent + 2))).collect()
        }
        Value::Array(items) => format!("{pad}{key}: {}\n", items.iter().map(plain).collect::<Vec<_>>().join(", ")),
        _ if key == "present" => String::new(),
        value => format!("{pad}{key}: {}\n", plain(value)),
    };
    fields.iter().map(line).collect()
}

fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}
