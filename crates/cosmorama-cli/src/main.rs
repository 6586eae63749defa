//! The `cosmorama` program.
//!
//! Arguments are parsed as typed ([`args`]), resolved into a job in which everything is checked ([`job`]), and run
//! ([`run`]).

mod args;
mod failure;
mod job;
mod large_pages;
mod run;
mod spare_memory;
mod stream;

use std::process::ExitCode;

use clap::Parser;

#[global_allocator]
static ALLOCATOR: large_pages::LargePages = large_pages::LargePages;

fn main() -> ExitCode {
    let args = match args::Args::try_parse() {
        Ok(args) => args,
        Err(error) => return failure::report_arguments(error),
    };
    match run::run(args.verb) {
        Ok(code) => code,
        Err(error) => failure::report(&error),
    }
}
