//! Reports on a conversion that is done.

use std::borrow::Cow;
use std::path::PathBuf;

use anyhow::Result;
use cosmorama_convert::{CpuSeconds, InterpolationReport, LightReport, Remade, Report, Severity};
use serde::Serialize;
use serde_json::Value;

use crate::console::{Console, in_options};

/// JSON that `--json` prints after a conversion.
#[derive(Serialize)]
struct JsonReport<'a> {
    inputs: Vec<Cow<'a, str>>,
    outputs: Vec<Cow<'a, str>>,
    frames: usize,
    skipped: usize,
    remade: Vec<JsonRemade<'a>>,
    wall_seconds: f64,
    cpu_seconds: JsonCpuSeconds,
    peak_memory_bytes: Option<u64>,
    estimated_memory_bytes: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    codec_memory_bytes: Option<u64>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    light: Vec<JsonLight>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    interpolated: Vec<JsonInterpolated>,
    warnings: Vec<String>,
    notes: Vec<String>,
}

#[derive(Serialize)]
struct JsonRemade<'a> {
    output: Cow<'a, str>,
    reason: &'a str,
}

#[derive(Serialize)]
struct JsonCpuSeconds {
    decode: f64,
    plan: f64,
    filter: f64,
    encode: f64,
}

/// Difference of an interpolated map from what it would be if it were computed.
#[derive(Serialize)]
struct JsonInterpolated {
    frame: Option<u64>,
    rms: f64,
    largest: f64,
}

impl JsonInterpolated {
    fn of(report: &InterpolationReport) -> Self {
        Self { frame: report.frame, rms: report.difference.rms, largest: report.difference.largest }
    }
}

/// Light that went into a map, and light that came out.
#[derive(Serialize)]
struct JsonLight {
    frame: Option<u64>,
    level: usize,
    /// Roughness, 0 for a mirror; null for lobes without one.
    alpha: Option<f64>,
    /// Mean radiance over the sphere.
    energy_in: [f64; 3],
    /// Mean radiance of the map over the sphere; null where it does not show all of the sphere.
    energy_out: Option<[f64; 3]>,
    /// Part of the light from texels over a hundred times as bright as the mean.
    brightest_texels_share: f64,
    shown: f64,
    peak_in: f32,
    peak_out: f32,
    /// Factor by which the light is written.
    scale: f64,
    overflowed_samples: usize,
}

impl JsonLight {
    fn of(report: &LightReport) -> Self {
        let (input, output) = (&report.input, &report.output);
        Self {
            frame: report.frame,
            level: report.level,
            alpha: report.alpha,
            energy_in: input.mean,
            energy_out: ((output.shown - 1.0).abs() < 0.01).then_some(output.mean),
            brightest_texels_share: input.suns,
            shown: input.shown,
            peak_in: input.peak,
            peak_out: output.peak,
            scale: report.scale,
            overflowed_samples: report.overflowed,
        }
    }
}

/// Returns the figures of maps of light, for programs.
pub(crate) fn light(report: &Report) -> Result<Value> {
    Ok(serde_json::to_value(report.light.iter().map(JsonLight::of).collect::<Vec<_>>())?)
}

/// Returns the report for programs.
pub(crate) fn to_json(report: &Report) -> Result<String> {
    let CpuSeconds { decode, plan, filter, encode } = report.cpu_seconds;
    let json = JsonReport {
        inputs: names(&report.inputs),
        outputs: names(&report.outputs),
        frames: report.frames,
        skipped: report.skipped,
        remade: report
            .remade
            .iter()
            .map(|Remade { output, reason }| JsonRemade { output: output.to_string_lossy(), reason })
            .collect(),
        wall_seconds: report.wall.as_secs_f64(),
        cpu_seconds: JsonCpuSeconds { decode, plan, filter, encode },
        peak_memory_bytes: report.peak_memory_bytes,
        estimated_memory_bytes: report.estimated_memory_bytes,
        codec_memory_bytes: Some(report.codec_memory_bytes).filter(|bytes| *bytes > 0),
        light: report.light.iter().map(JsonLight::of).collect(),
        interpolated: report.interpolated.iter().map(JsonInterpolated::of).collect(),
        warnings: told(report, |severity| severity != Severity::Note),
        notes: told(report, |severity| severity == Severity::Note),
    };
    Ok(serde_json::to_string_pretty(&json)? + "\n")
}

/// Returns paths as text: bytes that are none have a sign in their place.
fn names(paths: &[PathBuf]) -> Vec<Cow<'_, str>> {
    paths.iter().map(|path| path.to_string_lossy()).collect()
}

fn told(report: &Report, chosen: impl Fn(Severity) -> bool) -> Vec<String> {
    let diagnostics = report.diagnostics.iter().filter(|diagnostic| chosen(diagnostic.severity));
    diagnostics.map(|diagnostic| in_options(&diagnostic.message)).collect()
}

/// Prints the report for people on standard error.
pub(crate) fn tell(report: &Report, console: &Console) {
    let what = match (&report.outputs[..], report.frames) {
        ([], _) => "nothing to do".to_owned(),
        ([one], _) => console.told(&one.to_string_lossy()),
        (many, 1) => format!("{} files", many.len()),
        (many, frames) => format!("{} files of {frames} frames", many.len()),
    };
    let skipped = if report.skipped == 0 { String::new() } else { format!(", {} kept", report.skipped) };
    let CpuSeconds { decode, plan, filter, encode } = report.cpu_seconds;
    console.report(format_args!(
        "{what}{skipped} in {:.2} s (CPU: decode {decode:.2} s, plan {plan:.2} s, filter {filter:.2} s, encode {encode:.2} s)",
        report.wall.as_secs_f64()
    ));
    if !report.interpolated.is_empty() {
        let worst = report.interpolated.iter().map(|report| report.difference.rms).fold(0.0, f64::max);
        console.report(format_args!(
            "interpolated frames differ from computed ones by {:.3} % at most (rms)",
            100.0 * worst
        ));
    }
}
