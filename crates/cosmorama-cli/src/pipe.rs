//! Streams as files. A picture that comes in is held in memory. A stream of many is read as it comes, or, where its frames are not asked
//! for in their order, from a temporary file without a name. A picture that goes out is made in a temporary folder, and passed on when it is whole;
//! a stream of many, picture by picture.

use std::env::temp_dir;
use std::fs::File;
use std::io::{self, BufReader, Cursor, ErrorKind, IsTerminal, Read, Write, copy, stdin, stdout};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use anyhow::{Context, Error, Result, anyhow};
use cosmorama_convert::{Conversion, Files, InMemory, Name, PictureSink, is_video};
use cosmorama_io::Format;
use cosmorama_io::pending::{Scratch, nameless};

use crate::args::ConvertArgs;
use crate::console::{Console, say};
use crate::failure::usage;

/// Name of a standard stream on the command line.
const STREAM: &str = "-";

/// Formats of streams of raw pictures.
const STREAMS: [&str; 3] = ["y4m", "pam", "pfm"];

/// Name of standard input where pictures have names.
const STDIN: &str = "standard input";

/// Name of standard output there.
const STDOUT: &str = "standard output";

/// Input that has come in through streams.
#[derive(Default)]
pub(crate) struct KeptStreams {
    files: InMemory,
    /// Whether standard input is held.
    has_stdin: bool,
    /// Whether streams of many pictures are read as they come.
    in_order: bool,
    /// Whether streams of many pictures are kept on disk; otherwise they are in memory, too.
    is_on_disk: bool,
}

/// Bytes by which streams of many pictures are known.
const BEGIN: u64 = 16;

impl KeptStreams {
    /// Returns the name of an input that can be read repeatedly. It is the input's own, or that under which a stream is
    /// held in memory.
    pub(crate) fn input(&mut self, name: &Name) -> Result<Name> {
        if **name == *STREAM {
            if self.has_stdin {
                return Err(usage("- is given twice, but standard input can be read only once; name a file"));
            }
            if stdin().is_terminal() {
                return Err(usage("standard input is a terminal; pipe a picture into it, or name a file"));
            }
            self.has_stdin = true;
            return self.keep(stdin(), &STDIN.into());
        }
        if is_pipe(Path::new(name)) {
            let pipe = told_if_late(name, || File::open(name.path())).with_context(|| format!("cannot open {name}"))?;
            return self.keep(pipe, name);
        }
        Ok(name.clone())
    }

    /// Returns a source of inputs that has the bytes of the streams, and all other files from disk.
    pub(crate) fn files(&self) -> Arc<dyn Files> {
        Arc::new(self.files.clone())
    }

    /// Holds the bytes of a stream, and returns the name under which it does.
    fn keep(&mut self, mut source: impl Read + Send + 'static, name: &Name) -> Result<Name> {
        let unread = || format!("cannot read {name}");
        let mut begin = Vec::new();
        (&mut source).take(BEGIN).read_to_end(&mut begin).with_context(unread)?;
        // Streams of many pictures are known by their names.
        let kind = stream_kind(&begin).filter(|kind| is_video(Path::new(&format!("stream.{kind}"))));
        let mut source = Cursor::new(begin).chain(source);
        let held = kind.map_or_else(|| name.clone(), |kind| named(name, kind));
        match kind {
            Some(_) if self.is_on_disk && self.in_order => self.files.insert_live(&held, BufReader::new(source)),
            Some(_) if self.is_on_disk => {
                let mut file = nameless().map_err(|error| no_place("file", &error))?;
                let kept = copy(&mut source, &mut file);
                kept.with_context(|| format!("cannot copy {name} to {}, which may be full", temp_dir().display()))?;
                self.files.insert_kept(&held, file);
            }
            _ => {
                let mut bytes = Vec::new();
                source.read_to_end(&mut bytes).with_context(unread)?;
                self.files.insert(&held, bytes);
            }
        }
        Ok(held)
    }
}

/// Returns the name of a stream of some kind.
fn named(name: &Name, kind: &str) -> Name {
    let mut named = name.path().as_os_str().to_owned();
    named.push(format!(".{kind}"));
    named.into()
}

/// Returns the extension of a stream of raw pictures, by its first bytes; `None` for other files.
fn stream_kind(bytes: &[u8]) -> Option<&'static str> {
    match bytes {
        _ if bytes.starts_with(b"YUV4MPEG2 ") => Some("y4m"),
        [b'P', b'5' | b'6' | b'7', b' ' | b'\t' | b'\r' | b'\n', ..] => Some("pam"),
        [b'P', b'F' | b'f', b' ' | b'\t' | b'\r' | b'\n', ..] => Some("pfm"),
        _ => None,
    }
}

/// Time for which nothing is said about a pipe into which nobody writes.
const PATIENCE: Duration = Duration::from_secs(5);

/// Opens a pipe, which takes until somebody opens it for writing. If that takes long, it is said.
fn told_if_late<T>(name: &str, open: impl FnOnce() -> T) -> T {
    let (opened, wait) = channel::<()>();
    std::thread::scope(|scope| {
        scope.spawn(move || {
            if wait.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                say(format_args!("waiting for {name}: a pipe into which nothing writes yet"));
            }
        });
        let pipe = open();
        drop(opened);
        pipe
    })
}

/// Returns whether a file is a pipe, as the shell's `<(command)` is: its bytes come once.
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
    /// Source of the bytes of inputs.
    pub(crate) files: Arc<dyn Files>,
    /// Goal of pictures that go to standard output as they are made.
    pub(crate) sink: Option<PictureSink>,
    /// Whether nobody reads standard output any more.
    is_closed: Arc<AtomicBool>,
    /// Folder of the output that goes on to standard output when it is whole.
    scratch: Option<Scratch>,
    /// Inputs that are streams, kept as long as the conversion lasts.
    _kept: KeptStreams,
}

impl Piped {
    /// Reads the inputs that are streams, and makes a folder for an output that goes to standard output.
    pub(crate) fn open(mut args: ConvertArgs, console: &mut Console) -> Result<Self> {
        check(&args, *args.output == *STREAM)?;
        let (mut sink, mut scratch, is_closed) = (None, None, Arc::default());
        if let Some(format) = &args.format {
            let mut path = PathBuf::from(format!("{STDOUT}.{}", format.trim_start_matches('.')));
            if is_stream(format) {
                sink = Some(PictureSink::new(StandardOutput { is_closed: Arc::clone(&is_closed) }));
            } else {
                let folder = Scratch::create(&console.unfinished).map_err(|error| no_place("folder", &error))?;
                path = scratch.insert(folder).path().join(path);
            }
            console.call(&path, STDOUT);
            args.output = path.into();
        }
        let settings: Conversion = args.clone().into();
        let in_order = settings.reads_in_order();
        let mut kept = KeptStreams { in_order, is_on_disk: true, ..KeptStreams::default() };
        args.input = kept.input(&args.input)?;
        args.backdrop = args.backdrop.map(|backdrop| kept.input(&backdrop)).transpose()?;
        for kind in STREAMS {
            console.call(named(&STDIN.into(), kind).path(), STDIN);
        }
        Ok(Self { args, files: kept.files(), sink, is_closed, scratch, _kept: kept })
    }

    /// Returns whether whoever read standard output has closed it, and has seen enough.
    pub(crate) fn is_closed(&self) -> bool {
        self.is_closed.load(Ordering::Relaxed)
    }

    /// Copies the output to standard output.
    pub(crate) fn finish(self) -> Result<()> {
        if self.scratch.is_some() {
            let mut file = File::open(self.args.output.path()).context("nothing was made for standard output")?;
            let mut out = stdout().lock();
            match copy(&mut file, &mut out).and_then(|_| out.flush()) {
                // The reader of our output has closed it, and has seen enough.
                Err(error) if error.kind() == ErrorKind::BrokenPipe => {}
                result => result.context("cannot write to standard output")?,
            }
        }
        Ok(())
    }
}

/// Standard output that notes when nobody reads it any more.
struct StandardOutput {
    is_closed: Arc<AtomicBool>,
}

impl StandardOutput {
    fn noting<T>(&self, done: io::Result<T>) -> io::Result<T> {
        done.inspect_err(|error| {
            if error.kind() == ErrorKind::BrokenPipe {
                self.is_closed.store(true, Ordering::Relaxed);
            }
        })
    }
}

impl Write for StandardOutput {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.noting(stdout().write(bytes))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.noting(stdout().flush())
    }
}

/// Returns the error for a folder or file that cannot be made among the system's temporary files.
fn no_place(what: &str, error: &io::Error) -> Error {
    anyhow!(
        "no {what} for what is piped can be made in {} ({}); name a folder where you may write, as in TMPDIR=/var/tmp",
        temp_dir().display(),
        error.kind()
    )
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
        (true, _) if args.files.resume => {
            Err(usage("--resume skips files that are there, but the output is standard output; leave --resume out"))
        }
        (true, None) => {
            Err(usage("the output is standard output, whose name says no format; give --format, as in --format png"))
        }
        (true, Some(format)) if !is_format(format) => Err(usage(format!(
            "--format {format}: no format of this name can be written there; use one of {}, y4m, pam, pfm",
            Format::extensions()
        ))),
        (true, Some(_)) if args.run.json => Err(usage(
            "--json would print its report into the picture on standard output; leave it out, or name an output file",
        )),
        (true, Some(_)) if stdout().is_terminal() => {
            Err(usage("standard output is a terminal, which shows no pictures; redirect it, or name an output file"))
        }
        _ => Ok(()),
    }
}

/// Returns whether an extension is that of a stream of raw pictures.
fn is_stream(extension: &str) -> bool {
    let extension = extension.trim_start_matches('.');
    STREAMS.contains(&extension) && is_video(Path::new(&format!("stream.{extension}")))
}

/// Returns whether a format, given by its extension, can be written.
fn is_format(extension: &str) -> bool {
    let extension = extension.trim_start_matches('.');
    is_stream(extension) || Format::from_extension(Path::new(&format!("picture.{extension}"))).is_ok()
}
