//! Completion scripts of shells.

use std::process::ExitCode;

use anyhow::Result;
use clap::{Command, CommandFactory};
use clap_complete::Shell;

use crate::args::{Args, CompletionsArgs};
use crate::console::Console;

/// Prints a completion script.
pub(in crate::verbs) fn completions(args: &CompletionsArgs, console: &Console) -> Result<ExitCode> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Args::command(), "cosmorama", &mut script);
    let mut script = String::from_utf8_lossy(&script).into_owned();
    if args.shell == Shell::Fish {
        script += &words_for_fish(&Args::command());
    }
    console.print(&script)?;
    Ok(ExitCode::SUCCESS)
}

/// Returns lines of fish's script for the words of arguments without an option, which `clap_complete` leaves out.
fn words_for_fish(command: &Command) -> String {
    let mut lines = String::new();
    for verb in command.get_subcommands() {
        for argument in verb.get_positionals() {
            let values = argument.get_possible_values();
            let words: Vec<&str> = values.iter().map(|value| value.get_name()).collect();
            if !words.is_empty() {
                let (verb, words) = (verb.get_name(), words.join(" "));
                lines += &format!(
                    "complete -c cosmorama -n \"__fish_cosmorama_using_subcommand {verb}\" -f -a \"{words}\"\n"
                );
            }
        }
    }
    lines
}
