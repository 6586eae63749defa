//! The `cosmorama` program.
//!
//! Arguments are parsed and become settings of `cosmorama-convert` ([`args`]). Each verb runs ([`verbs`]) and prints
//! its messages ([`console`]).

mod args;
mod console;
mod diagram;
mod failure;
mod interrupt;
mod large_pages;
mod parse;
mod pipe;
mod progress;
mod report;
mod verbs;

use std::process::ExitCode;

use clap::Parser;

#[global_allocator]
static ALLOCATOR: large_pages::LargePages = large_pages::LargePages;

fn main() -> ExitCode {
    failure::report_panics();
    std::panic::catch_unwind(run).unwrap_or(ExitCode::FAILURE)
}

/// Runs the program as it was called.
fn run() -> ExitCode {
    large_pages::give_back_pictures();
    let args = match args::Args::try_parse() {
        Ok(args) => args,
        Err(error) => return failure::report_arguments(&error),
    };
    let mut console = console::Console::default();
    console.verbose = args.verbose;
    match verbs::run(args.verb, &mut console) {
        Ok(code) => code,
        Err(error) => failure::report(&error, &console),
    }
}
