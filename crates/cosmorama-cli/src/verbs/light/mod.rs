//! Verbs of `light`, a file for each kind of light.

mod brdf;
mod deploy;
mod harmonics;
mod maps;
mod sun;
mod table;

use std::process::ExitCode;

use anyhow::Result;

use crate::args::{LightArgs, LightVerb};
use crate::console::Console;

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
