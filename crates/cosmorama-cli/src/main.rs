//! The `cosmorama` program.
//!
//! Arguments are parsed and become settings of `cosmorama-convert` ([`args`]). Each verb runs ([`verbs`]) and prints
//! its messages ([`mod@console`]).

mod allocator;
mod args;
mod console;
mod diagram;
mod failure;
mod interrupt;
mod parse;
mod pipe;
mod progress;
mod report;
mod verbs;

use std::process::ExitCode;

use clap::Parser;

use crate::console::{Console, Log, VARIABLE, unknown_topic};

#[global_allocator]
static ALLOCATOR: allocator::Allocator = allocator::Allocator;

fn main() -> ExitCode {
    failure::report_panics();
    std::panic::catch_unwind(run).unwrap_or(ExitCode::FAILURE)
}

/// Runs the program as it was called.
fn run() -> ExitCode {
    allocator::give_back_pictures();
    allocator::end_where_memory_lacks();
    let args = match args::Args::try_parse() {
        Ok(args) => args,
        Err(error) => return failure::report_arguments(&error),
    };
    let mut console = console(&args);
    match verbs::run(args.verb, &mut console) {
        Ok(code) => code,
        Err(error) => failure::report(&error, &console),
    }
}

/// Returns the console with the log that is asked for. Without use for the environment's own wishes, it heeds the command line alone.
fn console(args: &args::Args) -> Console {
    let asked = std::env::var(VARIABLE).unwrap_or_default();
    let console = |asked: &str| Log::new(args.verbose, asked, args.log_format).map(Console::new);
    match console(&asked) {
        Ok(console) => {
            if let Some(told) = unknown_topic(&asked) {
                console.warning(format_args!("{VARIABLE}={asked}: {told}"));
            }
            console
        }
        Err(error) => {
            let console = console("").unwrap_or_else(|_| Console::new(Log::default()));
            console.warning(format_args!(
                "{VARIABLE}={asked} is ignored ({error}); expected levels by topic, as in {VARIABLE}=info or \
                 {VARIABLE}=cosmorama::memory=debug"
            ));
            console
        }
    }
}
