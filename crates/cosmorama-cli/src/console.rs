//! Output of messages and reports. Files that stand for streams (standard input and output, pipes) get readable names
//! in it.

use std::borrow::Cow;
use std::collections::HashSet;
use std::fmt::Display;
use std::io::{ErrorKind, Write, stderr, stdout};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use anyhow::{Context, Result};
use cosmorama_convert::{Diagnostic, Message, Outcome, Setting, Severity};
use cosmorama_io::pending::Unfinished;

/// Streams of a run.
#[derive(Debug, Default)]
pub(crate) struct Console {
    /// Each file that stands for a stream, with its readable name.
    names: Vec<(String, String)>,
    /// Whether notes are printed, too.
    pub(crate) verbose: bool,
    /// Files that are being written; an interrupt removes them.
    pub(crate) unfinished: Unfinished,
    /// Diagnostics that were printed: none is twice.
    said: Mutex<HashSet<String>>,
}

impl Console {
    /// Sets the readable name under which messages show a file from now on.
    pub(crate) fn call(&mut self, file: &Path, name: &str) {
        self.names.push((file.to_string_lossy().into_owned(), name.to_owned()));
    }

    /// Returns a text in which files have their readable names.
    pub(crate) fn told(&self, text: &str) -> String {
        self.names.iter().fold(text.to_owned(), |text, (file, name)| text.replace(file, name))
    }

    /// Prints a diagnostic that does not stop the work. Notes are printed only on request.
    pub(crate) fn warn(&self, diagnostic: &Diagnostic) {
        if diagnostic.severity != Severity::Note || self.verbose {
            self.tell(diagnostic);
        }
    }

    /// Prints what a check found. If it failed, notes are printed, too: one may tell why.
    pub(crate) fn tell_all<T>(&self, outcome: &Outcome<T>) {
        let has_failed = outcome.result.is_err();
        let said = outcome.diagnostics.iter();
        said.for_each(|diagnostic| if has_failed { self.tell(diagnostic) } else { self.warn(diagnostic) });
    }

    fn tell(&self, diagnostic: &Diagnostic) {
        let kind = if diagnostic.severity == Severity::Note { "note" } else { "warning" };
        let line = format!("{kind}: {}", self.told(&in_options(&diagnostic.message)));
        if self.said.lock().unwrap_or_else(PoisonError::into_inner).insert(line.clone()) {
            say(line);
        }
    }

    /// Prints a requested text on standard output.
    pub(crate) fn print(&self, text: &str) -> Result<()> {
        let mut out = stdout().lock();
        match out.write_all(escaped(&self.told(text)).as_bytes()).and_then(|()| out.flush()) {
            // The reader of our output has closed it, and has seen enough.
            Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
            result => result.context("cannot write to standard output"),
        }
    }
}

/// Prints a line on standard error. If nobody reads it any more, since a pipe is closed or a disk is full, the work
/// goes on.
pub(crate) fn say(line: impl Display) {
    let _ = writeln!(stderr(), "{}", escaped(&line.to_string()));
}

/// Returns a text whose control characters, as names of files may hold them, are escaped as in JSON: a terminal obeys them. Ends of
/// lines and tabs stay.
fn escaped(text: &str) -> Cow<'_, str> {
    let is_harmful = |c: char| c.is_control() && !matches!(c, '\n' | '\t');
    if !text.contains(is_harmful) {
        return text.into();
    }
    let escape = |c: char| if is_harmful(c) { format!("\\u{:04x}", u32::from(c)) } else { c.to_string() };
    text.chars().map(escape).collect::<String>().into()
}

/// Returns a message in which settings are options of the command line.
pub(crate) fn in_options(message: &Message) -> String {
    message.render(|setting| match setting {
        Setting::Overwrite => "-y (--overwrite)".to_owned(),
        other => format!("--{}", other.name()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_commands_a_terminal() {
        assert_eq!(escaped("a\u{1b}[2J\r\u{7}\u{9b}b\u{7f}\n\tc"), "a\\u001b[2J\\u000d\\u0007\\u009bb\\u007f\n\tc");
        assert!(matches!(escaped("plain, ä"), Cow::Borrowed(_)));
    }
}
