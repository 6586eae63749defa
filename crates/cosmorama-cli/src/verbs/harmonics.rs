use std::io::Write;
use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context, Result};
use cosmorama::lighting::Harmonics;
use cosmorama_convert::{Conversion, WorldLight, check_apart, refuse_existing};
use cosmorama_io::pending::Pending;
use serde_json::json;

use super::make_folder;
use crate::args::{HarmonicsArgs, Kind};
use crate::console::Console;
use crate::failure::usage;
use crate::pipe::KeptStreams;

/// Sums the spherical harmonics of a world's light.
pub(super) fn run(mut args: HarmonicsArgs, console: &mut Console) -> Result<ExitCode> {
    let path = args.output.clone();
    if path.extension().is_none_or(|extension| !extension.eq_ignore_ascii_case("json")) {
        return Err(usage(format!("{}: coefficients are written as JSON; name the output .json", path.display())));
    }
    let mut kept = KeptStreams::default();
    args.input = kept.input(&args.input)?;
    let conversion: Conversion = args.clone().into();
    let checked = conversion.files(kept.files()).check_light();
    console.tell_all(&checked);
    let light = checked.result?;
    check_output(&path, &light, args.overwrite)?;
    let folder = path.parent().filter(|folder| !args.no_mkdir && !folder.as_os_str().is_empty());
    let _folders = folder.map(|folder| make_folder(folder, console)).transpose()?;
    // Fails before the work, not after it, if the folder cannot be written to.
    let mut file = Pending::create(&path, &console.unfinished)?;
    let harmonics = harmonics(&args, &light, console)?;
    let text = to_json(&args, &harmonics)?;
    file.writer().write_all(text.as_bytes()).with_context(|| format!("cannot write {}", path.display()))?;
    file.finish()?;
    Ok(ExitCode::SUCCESS)
}

/// Refuses to replace an input, or any existing file unless `overwrite` is set.
fn check_output(path: &Path, light: &WorldLight, overwrite: bool) -> Result<()> {
    check_apart(path, light.files())?;
    if !overwrite {
        refuse_existing([path].into_iter())?;
    }
    Ok(())
}

fn harmonics(args: &HarmonicsArgs, light: &WorldLight, console: &Console) -> Result<Harmonics> {
    let (radiance, diagnostics) = light.harmonics(args.order, args.basis.into())?;
    diagnostics.iter().for_each(|diagnostic| console.warn(diagnostic));
    let harmonics = match args.kind {
        Kind::Radiance => radiance,
        Kind::Irradiance => radiance.irradiance(),
    };
    Ok(match args.window {
        Some(window) => harmonics.windowed(window.window(args.order)),
        None => harmonics,
    })
}

fn to_json(args: &HarmonicsArgs, harmonics: &Harmonics) -> Result<String> {
    let json = json!({
        "order": harmonics.order(),
        "basis": args.basis.name(),
        "kind": args.kind.name(),
        "coefficients": harmonics.coefficients(),
    });
    Ok(serde_json::to_string_pretty(&json)? + "\n")
}
