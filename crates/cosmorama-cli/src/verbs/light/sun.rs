use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

use anyhow::Result;
use cosmorama::lighting::Sun;
use cosmorama_convert::{Conversion, Files, WorldSuns, check_apart, refuse_existing};
use cosmorama_io::{FrameList, FramePattern, Frames};
use serde_json::{Value, json};

use super::add_figures;
use crate::args::SunArgs;
use crate::console::Console;
use crate::failure::usage;
use crate::pipe::KeptStreams;
use crate::verbs::prepare_output;

/// Suns that are listed for people at most.
const LISTED: usize = 12;

/// Suns of a frame.
struct Found {
    frame: Option<u64>,
    output: Option<PathBuf>,
    suns: WorldSuns,
}

/// Finds the suns and lamps of a world, or of each frame that is written without them.
pub(super) fn run(mut args: SunArgs, console: &mut Console) -> Result<ExitCode> {
    let mut kept = KeptStreams::default();
    args.input = kept.input(&args.input)?;
    let files = kept.files();
    let frames = frames(&args)?;
    if let (Some(path), Some(_)) = (&args.remove, frames[0]) {
        let outputs: Vec<PathBuf> = frames.iter().map(|frame| output(path, *frame)).collect();
        if !args.world.file.overwrite {
            refuse_existing(outputs.iter().map(PathBuf::as_path))?;
        }
    }
    let find = |frame: &Option<u64>| find(&args, *frame, &files, console);
    let found: Vec<Found> = frames.iter().map(find).collect::<Result<_>>()?;
    console.print(&if args.world.json { to_json(&found)? } else { told(&found)? })?;
    Ok(ExitCode::SUCCESS)
}

/// Returns the frames whose suns are taken out; one without a number where the output has no place for numbers.
fn frames(args: &SunArgs) -> Result<Vec<Option<u64>>> {
    let numbered = |text: &str| FramePattern::parse(text);
    let Some(path) = args.remove.as_ref().filter(|path| numbered(&path.to_string_lossy()).is_some()) else {
        return Ok(vec![None]);
    };
    let Some(pattern) = numbered(&args.input) else {
        return Err(usage(format!(
            "{} has a frame marker, but the input {} has none; give both one, or neither",
            path.display(),
            args.input
        )));
    };
    let frames = Frames::find(pattern, args.world.frames.as_ref())?;
    Ok(frames.list().frames().iter().copied().map(Some).collect())
}

/// Returns the output of a frame.
fn output(path: &Path, frame: Option<u64>) -> PathBuf {
    let pattern = frame.and_then(|frame| Some((FramePattern::parse(&path.to_string_lossy())?, frame)));
    pattern.map_or_else(|| path.to_owned(), |(pattern, frame)| pattern.path(frame))
}

/// Finds the suns of a frame, and writes it without them if that is asked for.
fn find(args: &SunArgs, frame: Option<u64>, files: &Arc<dyn Files>, console: &Console) -> Result<Found> {
    let mut conversion: Conversion = args.clone().into();
    conversion.unfinished = console.unfinished.clone();
    if let Some(frame) = frame {
        conversion.frames = Some(FrameList::new([frame]));
    }
    let checked = conversion.files(Arc::clone(files)).check_light();
    console.tell_all(&checked);
    let light = checked.result?;
    let output = args.remove.as_deref().map(|path| output(path, frame));
    if let Some(path) = &output {
        light.check_picture(path)?;
        check_apart(path, light.files())?;
    }
    let _folders = output.as_deref().map(|path| prepare_output(path, args.world.file, console)).transpose()?;
    let (suns, diagnostics) = light.suns(output.as_deref())?;
    diagnostics.iter().for_each(|diagnostic| console.warn(diagnostic));
    Ok(Found { frame, output, suns })
}

/// Returns the report for people.
fn told(found: &[Found]) -> Result<String> {
    let frame = |found: &Found| {
        let number = found.frame.map_or_else(String::new, |frame| format!("frame {frame}:\n"));
        Ok(number + &told_of(&found.suns)?)
    };
    found.iter().map(frame).collect()
}

fn told_of(found: &WorldSuns) -> Result<String> {
    let suns = found.suns.all();
    if suns.is_empty() {
        return Ok("no suns or lamps: nothing is over 100 times as bright as the mean\n".to_owned());
    }
    let mut text = String::new();
    for (number, sun) in (1..).zip(&suns[..suns.len().min(LISTED)]) {
        let (yaw, pitch) = sun.direction.longitude_latitude();
        let [red, green, blue] = sun.irradiance;
        writeln!(
            text,
            "{number}: yaw {:.2}°, pitch {:.2}°, {:.2}° across, {:.2} % of the light; irradiance {red:.4}, {green:.4}, {blue:.4}",
            yaw.degrees(),
            pitch.degrees(),
            2.0 * sun.radius().degrees(),
            100.0 * sun.share
        )?;
    }
    if suns.len() > LISTED {
        writeln!(text, "and {} more; --json lists all", suns.len() - LISTED)?;
    }
    Ok(text)
}

/// Returns the report for programs: one, or one for each frame under `frames`.
fn to_json(found: &[Found]) -> Result<String> {
    let json = match found {
        [one] if one.frame.is_none() => of_frame(one),
        frames => json!({ "frames": frames.iter().map(of_frame).collect::<Vec<_>>() }),
    };
    Ok(serde_json::to_string_pretty(&json)? + "\n")
}

fn of_frame(Found { frame, output, suns: found }: &Found) -> Value {
    let sun = |sun: &Sun| -> Value {
        let (yaw, pitch) = sun.direction.longitude_latitude();
        json!({
            "yaw": yaw.degrees(),
            "pitch": pitch.degrees(),
            "direction": sun.direction.vector().to_array(),
            "solid_angle": sun.solid_angle,
            "diameter_degrees": 2.0 * sun.radius().degrees(),
            "radiance": sun.radiance(),
            "irradiance": sun.irradiance,
            "share": sun.share,
            "peak": sun.peak,
        })
    };
    let mut json = json!({
        "output": output.as_ref().map(|output| output.display().to_string()),
        "suns": found.suns.all().iter().map(sun).collect::<Vec<_>>(),
        "energy_out": found.left.mean,
        "peak_out": found.left.peak,
        "overflowed_samples": found.overflowed,
    });
    add_figures(&mut json, found.light);
    if let Some(frame) = frame {
        json["frame"] = json!(frame);
    }
    json
}
