//! Running jobs.

mod balance;
mod builtin;
mod compare;
mod convert;
mod demo;
mod diagram;
mod engine;
mod explain;
mod frame_files;
mod frame_light;
mod geometry;
mod info;
mod info_faces;
mod info_world;
mod interrupt;
mod pipe;
mod progress;
mod report;
mod sequence;
mod shell;
mod st_map;
mod stages;
mod suns;
mod thin_alpha;
mod writer;

use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context, Result, anyhow};

use crate::args::Verb;
use crate::failure::usage;
use crate::stream;

/// Does what was asked for.
pub(crate) fn run(verb: Verb) -> Result<ExitCode> {
    interrupt::install()?;
    match verb {
        Verb::Demo(args) => demo::run(&args),
        Verb::Convert(args) => convert::run(&args),
        Verb::Info(args) => info::run(&args),
        Verb::Explain(args) => explain::run(&args),
        Verb::Compare(args) => compare::run(&args),
        Verb::Completions(args) => shell::completions(&args),
        Verb::Man => shell::man(),
    }
}

/// The threads that everything runs on.
fn use_threads(count: Option<usize>) -> Result<()> {
    let builder = rayon::ThreadPoolBuilder::new().num_threads(count.unwrap_or(0));
    builder.build_global().context("cannot start threads")
}

/// A folder that is there from now on, with those above it.
fn make_folder(folder: &Path) -> Result<()> {
    if folder.is_file() {
        return Err(usage(format!("{} is a file, where a folder was expected; name another", folder.display())));
    }
    std::fs::create_dir_all(folder).map_err(|error| {
        anyhow!("the folder {} cannot be made ({error}); choose another, where you may write", folder.display())
    })
}

/// Prints what was asked for on standard output.
fn print(text: &str) -> Result<()> {
    use std::io::Write;
    let mut out = std::io::stdout().lock();
    match out.write_all(stream::told(text).as_bytes()).and_then(|()| out.flush()) {
        // Whoever read our output has seen enough.
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(()),
        result => result.context("cannot write to standard output"),
    }
}
