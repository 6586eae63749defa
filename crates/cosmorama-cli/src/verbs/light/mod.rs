//! Verbs of `light`, a file for each kind of light.

mod brdf;
mod deploy;
mod harmonics;
mod maps;
mod sun;
mod table;

use std::process::ExitCode;

use anyhow::Result;
use cosmorama::lighting::LightFigures;
use serde_json::{Value, json};

use crate::args::{LightArgs, LightVerb};
use crate::console::Console;

/// Adds figures of a world's light to a report for programs.
fn add_figures(report: &mut Value, LightFigures { mean, peak, suns, shown }: LightFigures) {
    let energy = [("energy_in", json!(mean)), ("peak_in", json!(peak))];
    let shares = [("brightest_texels_share", json!(suns)), ("shown", json!(shown))];
    energy.into_iter().chain(shares).for_each(|(name, figure)| report[name] = figure);
}

/// Makes light of a world.
pub(super) fn run(args: LightArgs, console: &mut Console) -> Result<ExitCode> {
    match args.verb {
        LightVerb::Diffuse(args) => maps::diffuse(*args, console),
        LightVerb::Specular(args) => maps::specular(*args, console),
        LightVerb::Harmonics(args) => harmonics::run(*args, console),
        LightVerb::Table(args) => table::run(*args, console),
        LightVerb::Sun(args) => sun::run(*args, console),
        LightVerb::Brdf(args) => brdf::run(&args, console),
        LightVerb::Deploy(args) => deploy::run(*args, console),
    }
}
