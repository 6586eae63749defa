use std::fmt::Write;
use std::process::ExitCode;

use anyhow::Result;
use cosmorama::lighting::Sun;
use cosmorama_convert::{Conversion, WorldSuns, check_apart};
use serde_json::{Value, json};

use crate::args::SunArgs;
use crate::console::Console;
use crate::pipe::KeptStreams;
use crate::verbs::prepare_output;

/// Suns that are listed for people at most.
const LISTED: usize = 12;

/// Finds the suns and lamps of a world.
pub(super) fn run(mut args: SunArgs, console: &mut Console) -> Result<ExitCode> {
    let mut kept = KeptStreams::default();
    args.input = kept.input(&args.input)?;
    let conversion: Conversion = args.clone().into();
    let conversion = Conversion { unfinished: console.unfinished.clone(), ..conversion };
    let checked = conversion.files(kept.files()).check_light();
    console.tell_all(&checked);
    let light = checked.result?;
    if let Some(path) = &args.remove {
        light.check_picture(path)?;
        check_apart(path, light.files())?;
    }
    let _folders = args.remove.as_deref().map(|path| prepare_output(path, args.file, console)).transpose()?;
    let (found, diagnostics) = light.suns(args.remove.as_deref())?;
    diagnostics.iter().for_each(|diagnostic| console.warn(diagnostic));
    console.print(&if args.json { to_json(&args, &found)? } else { told(&found)? })?;
    Ok(ExitCode::SUCCESS)
}

/// Returns the report for people.
fn told(found: &WorldSuns) -> Result<String> {
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

/// Returns the report for programs.
fn to_json(args: &SunArgs, found: &WorldSuns) -> Result<String> {
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
    let json = json!({
        "output": args.remove,
        "suns": found.suns.all().iter().map(sun).collect::<Vec<_>>(),
        "energy_in": found.light.mean,
        "energy_out": found.left.mean,
        "peak_in": found.light.peak,
        "peak_out": found.left.peak,
        "brightest_texels_share": found.light.suns,
        "shown": found.light.shown,
    });
    Ok(serde_json::to_string_pretty(&json)? + "\n")
}
