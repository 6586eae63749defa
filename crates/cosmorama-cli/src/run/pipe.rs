//! Standard input and output as files: what comes in is kept in a folder that goes away, what goes out is made there and
//! passed on when it is whole.

use std::fs::File;
use std::io::{ErrorKind, IsTerminal, Write, copy, stdin, stdout};

use anyhow::{Context, Result};
use cosmorama_io::pending::Scratch;

use crate::args::ConvertArgs;
use crate::failure::usage;

/// What a standard stream is called.
const STREAM: &str = "-";

/// A conversion between files, some of which stand for standard streams.
pub(super) struct Piped {
    /// The same with the names of files.
    pub(super) args: ConvertArgs,
    /// Where those lie.
    _folder: Option<Scratch>,
    /// Whether the output goes on to standard output.
    to_stdout: bool,
}

impl Piped {
    /// Takes in standard input, if it is the input, and finds a place for what goes to standard output.
    pub(super) fn open(args: &ConvertArgs) -> Result<Self> {
        let (from_stdin, to_stdout) = (args.input == STREAM, args.output == STREAM);
        check(args, to_stdout)?;
        let mut piped = Self { args: args.clone(), _folder: None, to_stdout };
        if !(from_stdin || to_stdout) {
            return Ok(piped);
        }
        let folder = Scratch::create().context("cannot make a folder for what is piped")?;
        let path = |name: String| folder.path().join(name).display().to_string();
        if from_stdin {
            piped.args.input = path("standard-input".to_owned());
            let mut file = File::create(&piped.args.input).context("cannot keep standard input")?;
            copy(&mut stdin().lock(), &mut file).context("cannot read standard input")?;
        }
        if let Some(format) = &args.format {
            piped.args.output = path(format!("standard-output.{}", format.trim_start_matches('.')));
        }
        piped._folder = Some(folder);
        Ok(piped)
    }

    /// Passes on what was made.
    pub(super) fn finish(self) -> Result<()> {
        if self.to_stdout {
            let mut file = File::open(&self.args.output).context("nothing was made for standard output")?;
            let mut out = stdout().lock();
            match copy(&mut file, &mut out).and_then(|_| out.flush()) {
                // Whoever read our output has seen enough.
                Err(error) if error.kind() == ErrorKind::BrokenPipe => {}
                result => result.context("cannot write to standard output")?,
            }
        }
        Ok(())
    }
}

fn check(args: &ConvertArgs, to_stdout: bool) -> Result<()> {
    match (to_stdout, &args.format) {
        (false, Some(_)) => Err(usage(format!(
            "--format is for standard output, but the extension of {} chooses the format; leave --format out",
            args.output
        ))),
        (true, None) => {
            Err(usage("the output is standard output, whose name says no format; give --format, as in --format png"))
        }
        (true, Some(_)) if args.json => Err(usage(
            "--json would print its report into the picture on standard output; leave it out, or name an output file",
        )),
        (true, Some(_)) if stdout().is_terminal() => {
            Err(usage("standard output is a terminal, which shows no pictures; redirect it, or name an output file"))
        }
        _ => Ok(()),
    }
}
