use std::fmt::Write as _;
use std::path::Path;
use std::process::ExitCode;

use anyhow::Result;
use cosmorama::laboratory::CROP;
use cosmorama_convert::{Code, Diagnostic, FilterReport, FilterTrial, check_apart, refuse_existing};
use cosmorama_io::Format;
use serde_json::{Value, json};

use super::compare::decibels;
use super::convert::Watch;
use super::{make_folder, write_picture};
use crate::args::FiltersArgs;
use crate::console::Console;
use crate::pipe::KeptStreams;

/// Name of the sheet of crops.
const CROPS: &str = "crops.png";

/// Compares filters on one conversion.
pub(super) fn run(mut args: FiltersArgs, console: &mut Console) -> Result<ExitCode> {
    let mut kept = KeptStreams::default();
    args.input = kept.input(&args.input)?;
    let crops = args.output.as_deref().map(|folder| folder.join(CROPS));
    let checked = args.conversion().files(kept.files()).check_filters();
    console.tell_all(&checked);
    let trials = checked.result?;
    if let Some(crops) = &crops {
        check_apart(crops, trials.files())?;
        if !args.overwrite {
            refuse_existing([crops.as_path()].into_iter())?;
        }
    }
    let _folders = args.output.as_deref().map(|folder| make_folder(folder, console)).transpose()?;
    let mut watch = Watch::new(console, args.progress);
    let report = trials.run(&args.filters(), args.truth.as_deref(), &mut watch)?;
    watch.finish();
    report.diagnostics.iter().for_each(|diagnostic| console.warn(diagnostic));
    if crops.is_some() && report.sheet.is_none() {
        let message =
            format!("there are no crops: no place of the picture has {CROP}x{CROP} whole pixels; make it larger");
        console.warn(&Diagnostic::warning(Code::NoEffect, message));
    }
    let crops = crops.filter(|_| report.sheet.is_some());
    if let (Some(crops), Some(sheet)) = (&crops, &report.sheet) {
        write_picture((crops, Format::Png), sheet, console)?;
    }
    let text = match (args.json, args.csv) {
        (true, _) => json_text(&args, &report, crops.as_deref())?,
        (_, true) => csv_text(&report.trials),
        _ => {
            table(&report.trials) + &crops.iter().map(|file| format!("wrote {}\n", file.display())).collect::<String>()
        }
    };
    console.print(&text)?;
    Ok(ExitCode::SUCCESS)
}

/// A column of the table: its head, and the words of a trial.
type Column = (&'static str, fn(&FilterTrial) -> String);

/// Memory of the preparation: for people, and for programs.
const SETUP_MIB: Column = ("setup MiB", |trial| format!("{:.1}", trial.setup.bytes as f64 / f64::from(1 << 20)));
const SETUP_BYTES: Column = ("setup bytes", |trial| trial.setup.bytes.to_string());

/// Number of columns.
const WIDTH: usize = 9;

/// Returns the columns, with one for the memory of the preparation.
fn columns(setup: Column) -> [Column; WIDTH] {
    [
        ("filter", |trial| trial.filter.to_string()),
        ("reference dB", |trial| format!("{:.2}", trial.to_reference)),
        ("direct dB", |trial| optional(trial.to_truth, 2)),
        ("aliasing dB", |trial| optional(trial.response.aliasing, 1)),
        ("edge px", |trial| optional(trial.response.edge_width, 2)),
        ("CPU s", |trial| format!("{:.3}", trial.cpu_seconds)),
        ("setup s", |trial| format!("{:.3}", trial.setup_seconds)),
        setup,
        ("texels a pixel", |trial| format!("{:.1}", trial.reads)),
    ]
}

fn optional(value: Option<f64>, decimals: usize) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.decimals$}"))
}

/// Returns the table for people, with columns aligned.
fn table(trials: &[FilterTrial]) -> String {
    let columns = columns(SETUP_MIB);
    let head = columns.map(|(name, _)| name.to_owned());
    let rows: Vec<[String; WIDTH]> =
        std::iter::once(head).chain(trials.iter().map(|trial| columns.map(|(_, words)| words(trial)))).collect();
    let width = |column: usize| rows.iter().map(|row| row[column].len()).max().unwrap_or_default();
    let widths: [usize; WIDTH] = std::array::from_fn(width);
    let mut text = String::new();
    for row in &rows {
        let name = format!("{:<width$}", row[0], width = widths[0]);
        let rest = (1..WIDTH).map(|column| format!("{:>width$}", row[column], width = widths[column]));
        let line: Vec<String> = std::iter::once(name).chain(rest).collect();
        let _ = writeln!(text, "{}", line.join("  "));
    }
    text
}

/// Returns the table as comma-separated values; what was not measured is empty.
fn csv_text(trials: &[FilterTrial]) -> String {
    let columns = columns(SETUP_BYTES);
    let line = |cells: [String; WIDTH]| cells.map(|cell| if cell == "-" { String::new() } else { cell }).join(",");
    let head = line(columns.map(|(name, _)| name.replace(' ', "_")));
    let rows = trials.iter().map(|trial| line(columns.map(|(_, words)| words(trial))));
    std::iter::once(head).chain(rows).map(|line| line + "\n").collect()
}

fn json_text(args: &FiltersArgs, report: &FilterReport, crops: Option<&Path>) -> Result<String> {
    let report = json!({
        "input": &*args.input,
        "kernel": args.kernel.to_string(),
        "filters": report.trials.iter().map(trial_json).collect::<Vec<_>>(),
        "crops": crops.map(|file| file.display().to_string()),
    });
    Ok(serde_json::to_string_pretty(&report)? + "\n")
}

fn trial_json(trial: &FilterTrial) -> Value {
    json!({
        "filter": trial.filter.to_string(),
        "psnr_to_reference": decibels(trial.to_reference),
        "psnr_to_truth": trial.to_truth.map(decibels),
        "aliasing_db": trial.response.aliasing,
        "edge_width_px": trial.response.edge_width,
        "cpu_seconds": trial.cpu_seconds,
        "setup": {
            "cpu_seconds": trial.setup_seconds, "texels": trial.setup.texels, "bytes": trial.setup.bytes,
        },
        "texels_a_pixel": trial.reads,
    })
}
