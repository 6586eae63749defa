//! Report of `info` on a file, a face set or a world.

mod carried;
mod faces;
mod layers;
mod video;
mod world;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::Result;
use cosmorama::circle::{Circle, Found};
use cosmorama::raster::Transfer;
use cosmorama_convert::{
    Builtin, Files, MemoryBudget, Name, ThinAlpha, ViewFiles, damage_of, existing_frames, face_set, is_one_file,
    light_of, likely, probe, with_videos,
};
use cosmorama_io::{Choice, EnvMap, FacePattern, Header, ProfileFault, probe_chosen};
use serde_json::{Value, json};

use self::faces::{of_files, report as of_borders};
use self::layers::add_layers;
use crate::args::InfoArgs;
use crate::console::Console;
use crate::pipe::KeptStreams;

/// Reports what a file or a face set is.
pub(super) fn run(args: &InfoArgs, console: &mut Console) -> Result<ExitCode> {
    let mut kept = KeptStreams::default();
    let input = &kept.input(&args.input)?;
    let files = &*with_videos(kept.files());
    let report = if let Some(builtin) = Builtin::named(input)? {
        json!({ "input": &**input, "projection": "any (a formula)", "shows": builtin.about() })
    } else if input.path().to_str().is_some() && FacePattern::parse(input).is_some() {
        faces_report(files, input, args.check)?
    } else if let Some(world) = world::report(files, (input, args.check), console)? {
        world
    } else {
        single(files, input, args.check)?
    };
    if args.json {
        console.print(&(serde_json::to_string_pretty(&report)? + "\n"))?;
    } else {
        console.print(&lines(&report, 0))?;
    }
    // Damage, of a profile as well, is reported and makes the program fail.
    Ok(if is_damaged(&report) { ExitCode::FAILURE } else { ExitCode::SUCCESS })
}

/// Key of the reason why an ICC profile cannot be read.
const DAMAGED_PROFILE: &str = "icc_profile_damaged";

fn is_damaged(report: &Value) -> bool {
    match report {
        Value::Object(fields) => {
            fields.iter().any(|(key, value)| key == "damaged" || key == DAMAGED_PROFILE || is_damaged(value))
        }
        Value::Array(items) => items.iter().any(is_damaged),
        _ => false,
    }
}

fn single(inputs: &dyn Files, pattern: &Name, check: bool) -> Result<Value> {
    let files = ViewFiles::new(Path::new(pattern));
    if let Some(video) = files.video() {
        is_one_file(inputs, pattern, video)?;
    }
    let frames = existing_frames(&files, inputs)?;
    let path = files.path(frames.first().copied());
    if files.video().is_none() {
        is_one_file(inputs, pattern, &path)?;
    }
    let header = probe_any(inputs, &files, frames.first().copied())?;
    if header.metadata.layers.no_picture.is_some() {
        let mut report = json!({ "input": &**pattern });
        if check || frames.is_empty() {
            add_damage(&mut report, damages(inputs, &files, &frames));
        }
        add_frames(&mut report, &frames, check);
        merge(&mut report, header_report(&header));
        return Ok(report);
    }
    let reads_all = check || frames.is_empty();
    let likely = likely(inputs, &path, &header, reads_all);
    let mut report = json!({ "input": &**pattern });
    if !check && frames.is_empty() && !likely.is_read {
        report["read"] = json!("its header alone; --check decodes it");
    }
    let damaged = if check { damages(inputs, &files, &frames) } else { likely.damage.into_iter().collect() };
    add_damage(&mut report, damaged);
    if let Some(ProfileFault::Damaged(reason)) = &header.metadata.profile_fault {
        report[DAMAGED_PROFILE] = json!(reason);
    }
    add_frames(&mut report, &frames, check);
    merge(&mut report, header_report(&header));
    report["projection"] = json!(likely.projection);
    video::add(&mut report, inputs, &files)?;
    let picture = if reads_all && header.channels.has_alpha() { light_of(inputs, &path) } else { None };
    if let Some(told) = picture.and_then(|light| ThinAlpha::of(light.pixels().iter().copied())?.told()) {
        report["alpha"] = json!(told);
    }
    if let Some(found) = likely.circle {
        let Circle { centre: (x, y), radius } = found.circle();
        report["circle"] = json!({ "x": x, "y": y, "radius": radius, "measured": matches!(found, Found::Measured(_)) });
    }
    if let Some(arrangement) = &likely.arrangement {
        report["arrangement"] = of_borders(arrangement);
    }
    Ok(report)
}

fn faces_report(inputs: &dyn Files, pattern: &str, check: bool) -> Result<Value> {
    let set = face_set(pattern, None)?;
    let mut report = json!({ "input": pattern, "projection": "cube", "naming": set.naming().name });
    let is_sequence = set.present().any(|file| !matches!(ViewFiles::new(&file.path), ViewFiles::One(_)));
    let reads_all = check || !is_sequence;
    let arrangement = if reads_all { of_files(inputs, &set)? } else { None };
    // Pictures that were compared are known to be whole, except in later frames.
    let seeks_damage = reads_all && (is_sequence || arrangement.is_none());
    let mut faces = serde_json::Map::new();
    for file in set.faces() {
        let mut face = json!({ "file": file.path.display().to_string(), "present": file.present });
        let files = ViewFiles::new(&file.path);
        let frames = if file.present { existing_frames(&files, inputs)? } else { Vec::new() };
        if file.present && seeks_damage {
            add_damage(&mut face, damages(inputs, &files, &frames));
        }
        if file.placement != cosmorama_io::FacePlacement::UPRIGHT {
            face["lies"] = json!(format!(
                "turned clockwise by {} degrees{}",
                90 * u32::from(file.placement.quarter_turns),
                if file.placement.mirrored { ", mirrored" } else { "" }
            ));
        }
        if file.present {
            add_frames(&mut face, &frames, check);
            merge(&mut face, header_report(&probe_any(inputs, &files, frames.first().copied())?));
        }
        faces.insert(file.face.name().to_owned(), face);
    }
    report["faces"] = Value::Object(faces);
    if let Some(arrangement) = arrangement {
        report["arrangement"] = arrangement;
    }
    Ok(report)
}

/// Decodes a file, or each of its frames, and describes what is wrong with those that are damaged.
pub(super) fn damages(inputs: &dyn Files, files: &ViewFiles, frames: &[u64]) -> Vec<String> {
    let paths: Vec<PathBuf> = match frames {
        [] => vec![files.path(None)],
        frames => frames.iter().map(|frame| files.path(Some(*frame))).collect(),
    };
    let memory = MemoryBudget::new(None);
    let mut found: Vec<String> = paths.iter().filter_map(|path| damage_of(inputs, path, memory)).collect();
    // A video that has failed tells the same of each frame behind.
    found.dedup();
    found
}

pub(super) fn add_damage(report: &mut Value, damaged: Vec<String>) {
    match &damaged[..] {
        [] => {}
        [one] => report["damaged"] = json!(one),
        several => report["damaged"] = json!(several),
    }
}

/// Reads the header of a frame, even if its channels form no picture.
fn probe_any(inputs: &dyn Files, files: &ViewFiles, frame: Option<u64>) -> Result<Header> {
    let path = &files.path(frame);
    if files.video().is_some() {
        return Ok(probe(inputs, path)?);
    }
    let choice = Choice { without_picture: true, ..Choice::default() };
    Ok(probe_chosen(inputs.open(path)?, path, &choice)?)
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
        Some(ProfileFault::Damaged(reason)) => report[DAMAGED_PROFILE] = json!(reason),
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
    add_layers(&mut report, header);
    if let Some(orientation) = metadata.orientation {
        report["orientation"] =
            json!(format!("{orientation} (followed: width and height are those of the upright picture)"));
    }
    if let Some(pose) = metadata.pose {
        report["pose"] = json!(format!("{pose} (followed with --from equirect:pose=yes)"));
    }
    if let Some(software) = &metadata.software {
        report["software"] = json!(software);
    }
    carried::add(&mut report, &metadata.carried);
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

fn add_frames(report: &mut Value, frames: &[u64], check: bool) {
    if !frames.is_empty() {
        report["frames"] = json!(cosmorama_io::FrameList::new(frames.iter().copied()).to_string());
        report["read"] =
            json!(if check { "every frame" } else { "the first frame alone; --check decodes every frame" });
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
        Value::Object(channel) if channel.contains_key("holds") => {
            format!("{pad}{key}: {}, {}\n", plain(&channel["type"]), plain(&channel["holds"]))
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

/// Returns a value in one line: what a file tells of itself begins no line of ours.
fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), |text| text.replace('\n', "\\n"))
}
