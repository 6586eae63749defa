//! Help, manual pages and completions.

mod completions;
mod manual;
mod topics;

use std::process::ExitCode;

use anyhow::Result;
use clap::{Command, CommandFactory};
use cosmorama_spec::SpecKind;

use crate::args::{Args, HelpArgs, SPEC_TOPIC};
use crate::console::Console;
use crate::failure::usage;

pub(super) use completions::completions;
pub(super) use manual::man;

/// Prints the help of a verb, or on another topic.
pub(super) fn help(args: &HelpArgs, console: &Console) -> Result<ExitCode> {
    let mut command = built();
    let text = match (args.topic.as_deref(), args.projection.as_deref()) {
        (None, _) => command.render_long_help().to_string(),
        (Some(SPEC_TOPIC), None) => cosmorama_spec::help(),
        (Some(SPEC_TOPIC), Some(spec)) => match SpecKind::of(spec) {
            Some(kind) => topics::of_projection(kind),
            None => return Err(usage(topics::unknown(spec))),
        },
        (Some(topic), second) => match command.find_subcommand_mut(topic) {
            Some(verb) => of_verb(verb, second)?,
            None => topics::text(topic).ok_or_else(|| usage(topics::unknown(topic)))?,
        },
    };
    console.print(&(text.trim_end().to_owned() + "\n"))?;
    Ok(ExitCode::SUCCESS)
}

/// Returns the help of a verb, or of a second verb under it: `help light diffuse`.
fn of_verb(verb: &mut Command, second: Option<&str>) -> Result<String> {
    let Some(second) = second else { return Ok(verb.render_long_help().to_string()) };
    match verb.find_subcommand_mut(second) {
        Some(part) => Ok(part.render_long_help().to_string()),
        None => Err(usage(format!("unexpected argument '{second}'; only 'help spec' takes a projection"))),
    }
}

/// Returns the definition of the command line, in which verbs have inherited their options.
fn built() -> Command {
    let mut command = Args::command();
    command.build();
    command
}
