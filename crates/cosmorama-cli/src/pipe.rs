//! Streams as files: what comes in is kept in a folder that goes away, what goes out is made there and passed on when it
//! is whole.

use std::fs::File;
use std::io::{ErrorKind, IsTerminal, Read, Write, copy, stdin, stdout};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow};
use cosmorama_io::Format;
use cosmorama_io::pending::Scratch;

use crate::args::ConvertArgs;
use crate::console::Console;
use crate::failure::usage;

/// What a standard stream is called.
const STREAM: &str = "-";

/// Files that stand for streams, as long as this lives.
#[derive(Default)]
pub(crate) struct KeptStreams {
    folder: Option<Scratch>,
    /// Inputs so far.
    inputs: usize,
    /// Whether standard input is one of them.
    has_stdin: bool,
}

impl KeptStreams {
    /// The name of an input that can be read as often as wanted: its own, or that of a file that keeps what comes through
    /// standard input or a pipe.
    pub(crate) fn input(&mut self, name: &str, console: &mut Console) -> Result<String> {
        if name == STREAM {
            if self.has_stdin {
                return Err(usage("- is given twice, but standard input can be read only once; name a file"));
            }
            if stdin().is_terminal() {
                return Err(usage("standard input is a terminal; pipe a picture into it, or name a file"));
            }
            self.has_stdin = true;
            return self.keep(&mut stdin().lock(), ("standard input", "standard input"), console);
        }
        if !is_pipe(Path::new(name)) {
            return Ok(name.to_owned());
        }
        let file_name = Path::new(name).file_name().map_or_else(|| "pipe".into(), |name| name.to_string_lossy());
        let mut pipe = File::open(name).with_context(|| format!("cannot open {name}"))?;
        self.keep(&mut pipe, (name, &file_name), console)
    }

    fn keep(
        &mut self,
        source: &mut dyn Read,
        (name, file_name): (&str, &str),
        console: &mut Console,
    ) -> Result<String> {
        self.inputs += 1;
        let folder = self.folder(console)?.join(format!("input-{}", self.inputs));
        std::fs::create_dir(&folder).with_context(|| format!("cannot keep {name}"))?;
        let path = folder.join(file_name);
        console.call(&path, name);
        let mut file = File::create(&path).with_context(|| format!("cannot keep {name}"))?;
        copy(source, &mut file).with_context(|| format!("cannot read {name}"))?;
        Ok(path.display().to_string())
    }

    fn folder(&mut self, console: &Console) -> Result<PathBuf> {
        if let Some(folder) = &self.folder {
            return Ok(folder.path().to_owned());
        }
        let folder = Scratch::create(&console.unfinished).map_err(|error| {
            let place = std::env::temp_dir();
            anyhow!(
                "no folder for what is piped can be made in {} ({}); name one where you may write, as in TMPDIR=/var/tmp",
                place.display(),
                error.kind()
            )
        })?;
        Ok(self.folder.insert(folder).path().to_owned())
    }
}

/// Whether a file is a pipe, as the shell's `<(command)` is: its bytes come once.
#[cfg(unix)]
fn is_pipe(path: &Path) -> bool {
    use std::os::unix::fs::FileTypeExt;
    std::fs::metadata(path).is_ok_and(|found| found.file_type().is_fifo())
}

#[cfg(not(unix))]
fn is_pipe(_: &Path) -> bool {
    false
}

/// A conversion between files, some of which stand for streams.
pub(crate) struct Piped {
    /// Arguments with names of files in place of streams.
    pub(crate) args: ConvertArgs,
    /// Where those lie.
    _kept: KeptStreams,
    /// Whether the output goes on to standard output.
    to_stdout: bool,
}

impl Piped {
    /// Takes in what is piped, and finds a place for what goes to standard output.
    pub(crate) fn open(mut args: ConvertArgs, console: &mut Console) -> Result<Self> {
        let to_stdout = args.output == STREAM;
        check(&args, to_stdout)?;
        let mut kept = KeptStreams::default();
        args.input = kept.input(&args.input, console)?;
        if let Some(format) = &args.format {
            let path = kept.folder(console)?.join(format!("standard output.{}", format.trim_start_matches('.')));
            console.call(&path, "standard output");
            args.output = path.display().to_string();
        }
        Ok(Self { args, _kept: kept, to_stdout })
    }

    /// Passes on what was made.
    pub(crate) fn finish(self) -> Result<()> {
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
        (false, Some(_)) if Path::new(&args.output).extension().is_none() => Err(usage(format!(
            "--format is for standard output, which is called -, but the output is {}; name one or the other, a file with the \
             extension of its format",
            args.output
        ))),
        (false, Some(_)) => Err(usage(format!(
            "--format is for standard output, but the extension of {} chooses the format; leave --format out",
            args.output
        ))),
        (true, _) if args.resume => {
            Err(usage("--resume skips files that are there, but the output is standard output; leave --resume out"))
        }
        (true, None) => {
            Err(usage("the output is standard output, whose name says no format; give --format, as in --format png"))
        }
        (true, Some(format)) if !is_format(format) => Err(usage(format!(
            "--format {format}: no format of this name can be written; use one of {}",
            Format::extensions()
        ))),
        (true, Some(_)) if args.json => Err(usage(
            "--json would print its report into the picture on standard output; leave it out, or name an output file",
        )),
        (true, Some(_)) if stdout().is_terminal() => {
            Err(usage("standard output is a terminal, which shows no pictures; redirect it, or name an output file"))
        }
        _ => Ok(()),
    }
}

/// Whether a format is one that can be written, by its extension.
fn is_format(extension: &str) -> bool {
    Format::from_extension(Path::new(&format!("picture.{}", extension.trim_start_matches('.')))).is_ok()
}
