use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;
use std::process::{self, Command, ExitStatus, Stdio};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use cosmorama_io::pending::{Elsewhere, Unfinished};

use crate::VideoError;

/// Time between the first two looks at a program that is waited for. Each further look comes after twice the time of the one before.
const FIRST_LOOK: Duration = Duration::from_micros(50);

/// Longest time between two looks.
const LOOK: Duration = Duration::from_millis(5);

/// Longest message that is kept of a program.
const LONGEST_LINE: u64 = 1 << 16;

/// A running program. Dropped, it is ended and waited for, so that none stays behind; when this process is interrupted, too.
#[derive(Debug)]
pub(crate) struct Child {
    program: Arc<Program>,
    unfinished: Unfinished,
}

/// Program that an interrupt ends. Nobody holds it for long.
#[derive(Debug)]
struct Program(Mutex<process::Child>);

impl Program {
    fn locked(&self) -> MutexGuard<'_, process::Child> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Elsewhere for Program {
    fn end(&self) {
        let mut program = self.locked();
        // A program that has ended and was waited for is not ended twice: `kill` says so, and nothing is lost.
        let _ = program.kill();
        let _ = program.wait();
    }
}

impl Child {
    /// Starts a program in a group of its own: an interrupt at the terminal reaches this process alone, which then ends the other.
    pub(crate) fn start(mut command: Command, program: &str, unfinished: &Unfinished) -> Result<Self, VideoError> {
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let started = unfinished.begin(|| command.spawn().map(|child| Program(Mutex::new(child))));
        let program = started.map_err(|source| VideoError::Run { program: program.to_owned(), source })?;
        Ok(Self { program, unfinished: unfinished.clone() })
    }

    fn program(&self) -> MutexGuard<'_, process::Child> {
        self.program.locked()
    }

    pub(crate) fn stdin(&mut self) -> Option<process::ChildStdin> {
        self.program().stdin.take()
    }

    pub(crate) fn stdout(&mut self) -> Option<process::ChildStdout> {
        self.program().stdout.take()
    }

    pub(crate) fn stderr(&mut self) -> Option<process::ChildStderr> {
        self.program().stderr.take()
    }

    /// Waits until the program has ended.
    pub(crate) fn wait(&mut self) -> io::Result<ExitStatus> {
        let mut pause = FIRST_LOOK;
        loop {
            if let Some(status) = self.ended()? {
                return Ok(status);
            }
            thread::sleep(pause);
            pause = LOOK.min(2 * pause);
        }
    }

    /// Waits until the program has ended, `patience` at most.
    fn wait_for(&mut self, patience: Duration) -> io::Result<Option<ExitStatus>> {
        let (begin, mut pause) = (Instant::now(), FIRST_LOOK);
        loop {
            let status = self.ended()?;
            if status.is_some() || begin.elapsed() > patience {
                return Ok(status);
            }
            thread::sleep(pause);
            pause = LOOK.min(2 * pause);
        }
    }

    /// Looks whether the program has ended.
    fn ended(&self) -> io::Result<Option<ExitStatus>> {
        let status = self.program().try_wait()?;
        if status.is_some() {
            self.unfinished.go_on();
        }
        Ok(status)
    }
}

impl Drop for Child {
    fn drop(&mut self) {
        self.program.end();
        self.unfinished.go_on();
    }
}

/// Output of a program that has ended.
#[derive(Debug)]
pub(crate) struct Said {
    pub(crate) is_success: bool,
    pub(crate) stdout: Vec<u8>,
    pub(crate) stderr: String,
}

impl Said {
    /// Returns the last words that the program has written.
    pub(crate) fn last_words(&self) -> String {
        last_line(&self.stderr)
    }
}

/// Returns the last line with words, or that there is none.
fn last_line(text: &str) -> String {
    let line = text.lines().rev().map(str::trim).find(|line| !line.is_empty());
    line.map_or_else(|| "it says nothing".to_owned(), str::to_owned)
}

/// Runs a program about a file, and returns what it prints.
pub(super) fn output(
    command: Command,
    (program, unfinished): (&'static str, &Unfinished),
    path: &Path,
    limit: usize,
    patience: Duration,
) -> Result<Said, VideoError> {
    let failed = |source| VideoError::Run { program: program.to_owned(), source };
    let mut child = piped(command, program, unfinished)?;
    let stdout = drain(child.stdout(), limit);
    let stderr = drain(child.stderr(), limit);
    let status = child.wait_for(patience).map_err(failed)?;
    // It is ended if it has not.
    drop(child);
    let Some(status) = status else {
        // Its pipes may be open still, in programs that it has started.
        return Err(VideoError::TooSlow { path: path.to_owned(), program, seconds: patience.as_secs() });
    };
    let stdout = joined(stdout).map_err(failed)?;
    let stderr = String::from_utf8_lossy(&joined(stderr).map_err(failed)?).into_owned();
    Ok(Said { is_success: status.success(), stdout, stderr })
}

/// Runs a program about a file, and gives each line that it prints to `each`.
pub(super) fn lines(
    command: Command,
    (program, unfinished): (&'static str, &Unfinished),
    path: &Path,
    each: impl FnMut(&str) -> Result<(), VideoError>,
) -> Result<(), VideoError> {
    let failed = |source| VideoError::Run { program: program.to_owned(), source };
    let mut child = piped(command, program, unfinished)?;
    let stderr = drain(child.stderr(), LONGEST_LINE as usize);
    let stdout = child.stdout().ok_or_else(|| failed(io::ErrorKind::BrokenPipe.into()))?;
    lines_of(BufReader::new(stdout), failed, each)?;
    let status = child.wait().map_err(failed)?;
    if !status.success() {
        let words = String::from_utf8_lossy(&joined(stderr).map_err(failed)?).into_owned();
        return Err(VideoError::Decode { path: path.to_owned(), reason: last_line(&words) });
    }
    Ok(())
}

/// Gives each line of a text to `each`.
pub(super) fn lines_of(
    mut text: impl BufRead,
    failed: impl Fn(io::Error) -> VideoError,
    mut each: impl FnMut(&str) -> Result<(), VideoError>,
) -> Result<(), VideoError> {
    let mut line = String::new();
    while text.by_ref().take(LONGEST_LINE).read_line(&mut line).map_err(&failed)? > 0 {
        each(line.trim_end())?;
        line.clear();
    }
    Ok(())
}

fn piped(mut command: Command, program: &str, unfinished: &Unfinished) -> Result<Child, VideoError> {
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    Child::start(command, program, unfinished)
}

type Drained = JoinHandle<io::Result<Vec<u8>>>;

/// Starts a thread that reads a pipe to its end, so that the program never waits for a reader, and keeps its first `limit` bytes.
fn drain(pipe: Option<impl Read + Send + 'static>, limit: usize) -> Drained {
    thread::spawn(move || {
        let Some(mut pipe) = pipe else { return Ok(Vec::new()) };
        let mut kept = Vec::new();
        pipe.by_ref().take(limit as u64).read_to_end(&mut kept)?;
        io::copy(&mut pipe, &mut io::sink())?;
        Ok(kept)
    })
}

fn joined(thread: Drained) -> io::Result<Vec<u8>> {
    thread.join().unwrap_or_else(|_| Err(io::Error::other("the thread that reads it has panicked")))
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    fn shell(script: &str) -> Command {
        let mut command = Command::new("sh");
        command.args(["-c", script]);
        command
    }

    #[test]
    fn a_program_that_does_not_end_is_ended() {
        let begin = Instant::now();
        let program = ("ffprobe", &Unfinished::default());
        let error = output(shell("sleep 60"), program, Path::new("a"), 9, Duration::from_millis(50)).unwrap_err();
        assert!(matches!(error, VideoError::TooSlow { .. }), "{error}");
        assert!(begin.elapsed() < Duration::from_secs(20));
    }

    // Whoever waits for a program is not told that it has failed: the process ends next.
    #[test]
    fn an_interrupt_ends_programs_and_nobody_is_told() {
        let (unfinished, begin) = (Unfinished::default(), Instant::now());
        let (told, ear) = std::sync::mpsc::channel();
        let waiting = unfinished.clone();
        let program = Child::start(shell("echo; exec sleep 60"), "sleep", &waiting).unwrap();
        let place = format!("/proc/{}", program.program().id());
        thread::spawn(move || {
            let mut program = program;
            told.send(program.wait().is_ok())
        });
        thread::sleep(Duration::from_millis(50));
        unfinished.remove_all();
        assert!(begin.elapsed() < Duration::from_secs(2));
        assert!(!cfg!(target_os = "linux") || !Path::new(&place).exists(), "it was not waited for");
        assert!(ear.recv_timeout(Duration::from_millis(200)).is_err());
    }

    #[test]
    fn full_pipes_do_not_stop_a_program() {
        let much = "yes out | head -c 1000000; yes err | head -c 1000000 >&2; exit 3";
        let program = ("ffprobe", &Unfinished::default());
        let said = output(shell(much), program, Path::new("a"), 10, Duration::from_secs(60)).unwrap();
        assert_eq!(
            (said.is_success, said.stdout.as_slice(), said.stderr.as_str()),
            (false, &b"out\nout\nou"[..], "err\nerr\ner")
        );
    }
}
