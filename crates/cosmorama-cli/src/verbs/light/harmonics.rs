use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context, Result};
use cosmorama::lighting::{CodeLanguage, HarmonicKind, HarmonicPreset, SeriesAccuracy, StoredHarmonics};
use cosmorama_convert::{Conversion, WorldHarmonics, check_apart};
use cosmorama_io::pending::Pending;
use serde_json::{Value, json};

use super::add_figures;
use crate::args::HarmonicsArgs;
use crate::console::Console;
use crate::failure::usage;
use crate::pipe::KeptStreams;
use crate::verbs::prepare_output;

/// Sums the spherical harmonics of a world's light.
pub(super) fn run(mut args: HarmonicsArgs, console: &mut Console) -> Result<ExitCode> {
    let path = args.output.clone();
    let form = Form::of(&path)?;
    let kind = kind(&args)?;
    let mut kept = KeptStreams::default();
    args.input = kept.input(&args.input)?;
    let conversion: Conversion = args.clone().into();
    let checked = conversion.files(kept.files()).check_light();
    console.tell_all(&checked);
    let light = checked.result?;
    check_apart(&path, light.files())?;
    let _folders = prepare_output(&path, args.world.file, console)?;
    // Fails before the work, not after it, if the folder cannot be written to.
    let mut file = Pending::create(&path, &console.unfinished)?;
    let window = args.window.map(|window| window.window(args.order));
    let (found, diagnostics) = light.harmonics((args.order, args.basis.axes()), window)?;
    diagnostics.iter().for_each(|diagnostic| console.warn(diagnostic));
    let stored = match args.basis.preset() {
        Some(preset) => StoredHarmonics::of(preset, &found.harmonics, kind)?,
        None => StoredHarmonics::plain(&found.harmonics, kind),
    };
    let text = form.text(&stored, (args.basis.name(), kind))?;
    file.writer().write_all(text.as_bytes()).with_context(|| format!("cannot write {}", path.display()))?;
    file.finish()?;
    if args.world.json {
        console.print(&report(&args, &found, kind)?)?;
    } else {
        tell((&path, &found), (args.order, kind), console);
    }
    Ok(ExitCode::SUCCESS)
}

/// Returns the quantity to write, which the preset must take.
fn kind(args: &HarmonicsArgs) -> Result<HarmonicKind> {
    let usual = args.basis.preset().map_or(HarmonicKind::Radiance, HarmonicPreset::kind);
    let kind = args.kind.map_or(usual, HarmonicKind::from);
    if let Some(preset) = args.basis.preset() {
        let named = |error| {
            format!("--basis {}: {error}; leave --kind and --order out, or choose --basis zup", args.basis.name())
        };
        preset.check(kind, args.order).map_err(|error| usage(named(error)))?;
    }
    Ok(kind)
}

/// Form of the output.
#[derive(Clone, Copy)]
enum Form {
    Json,
    Csv,
    Code(CodeLanguage),
}

impl Form {
    /// Returns the form that a file's extension names.
    fn of(path: &Path) -> Result<Self> {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        Ok(match extension.as_str() {
            "json" => Self::Json,
            "csv" => Self::Csv,
            "glsl" => Self::Code(CodeLanguage::Glsl),
            "hlsl" => Self::Code(CodeLanguage::Hlsl),
            "rs" => Self::Code(CodeLanguage::Rust),
            "cpp" | "hpp" | "cc" | "cxx" | "h" => Self::Code(CodeLanguage::Cpp),
            _ => {
                return Err(usage(format!(
                    "{}: coefficients are written as JSON, CSV or code; name the output .json, .csv, .glsl, .hlsl, .rs, .cpp, .hpp or .h",
                    path.display()
                )));
            }
        })
    }

    fn text(self, stored: &StoredHarmonics, (basis, kind): (&str, HarmonicKind)) -> Result<String> {
        match self {
            Self::Json => as_json(stored, (basis, kind)),
            Self::Csv => csv(stored),
            Self::Code(language) => Ok(stored.code(language)),
        }
    }
}

/// Returns the coefficients as JSON.
pub(super) fn as_json(stored: &StoredHarmonics, (basis, kind): (&str, HarmonicKind)) -> Result<String> {
    let json = json!({
        "order": stored.order(),
        "basis": basis,
        "kind": name(kind),
        "coefficients": stored.numbers(),
    });
    Ok(serde_json::to_string_pretty(&json)? + "\n")
}

fn csv(stored: &StoredHarmonics) -> Result<String> {
    let mut text = "l,m,red,green,blue\n".to_owned();
    let numbers = (0..=stored.order()).flat_map(|l| (0..=2 * l).map(move |k| (l, k as i64 - l as i64)));
    for ((l, m), [red, green, blue]) in numbers.zip(stored.numbers()) {
        writeln!(text, "{l},{m},{red:?},{green:?},{blue:?}")?;
    }
    Ok(text)
}

fn name(kind: HarmonicKind) -> &'static str {
    match kind {
        HarmonicKind::Radiance => "radiance",
        HarmonicKind::Irradiance => "irradiance",
    }
}

/// Returns what a series misses, for programs.
pub(super) fn missed(SeriesAccuracy { rms_error, least, negative }: SeriesAccuracy) -> Value {
    json!({ "truncation_rms": rms_error, "least": least, "negative_share": negative })
}

/// Returns the report for programs.
fn report(args: &HarmonicsArgs, found: &WorldHarmonics, kind: HarmonicKind) -> Result<String> {
    let mut json = json!({
        "output": args.output.display().to_string(),
        "order": args.order,
        "basis": args.basis.name(),
        "kind": name(kind),
        "radiance": missed(found.accuracy.radiance),
        "irradiance": missed(found.accuracy.irradiance),
        "energy_out": found.mean,
    });
    add_figures(&mut json, found.light);
    Ok(serde_json::to_string_pretty(&json)? + "\n")
}

/// Prints for people what the coefficients miss.
fn tell((path, found): (&Path, &WorldHarmonics), (order, kind): (usize, HarmonicKind), console: &Console) {
    let (radiance, irradiance) = (found.accuracy.radiance, found.accuracy.irradiance);
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    console.report(format_args!(
        "{}: order {order} misses {} of the radiance and {} of the irradiance (rms)",
        path.display(),
        percent(radiance.rms_error),
        percent(irradiance.rms_error)
    ));
    let written = if kind == HarmonicKind::Radiance { radiance } else { irradiance };
    if written.negative > 0.0 {
        console.report(format_args!(
            "the {} is negative over {} of the sphere, down to {:.3}; --window hanning weakens that",
            name(kind),
            percent(written.negative),
            written.least
        ));
    }
}
