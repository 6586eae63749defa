//! Output of messages and reports. Files that stand for streams (standard input and output, pipes) get readable names
//! in it.

mod log;

use std::borrow::Cow;
use std::collections::HashSet;
use std::fmt::Display;
use std::io::{ErrorKind, Write, stderr, stdout};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use anyhow::{Context, Result};
use cosmorama_convert::{Decision, Diagnostic, Message, Outcome, Setting, Severity};
use cosmorama_io::pending::Unfinished;

pub(crate) use log::{Log, VARIABLE, unknown_topic};

use crate::args::ProgressStyle;

/// Streams of a run.
#[derive(Debug, Default)]
pub(crate) struct Console {
    /// Each file that stands for a stream, with its readable name.
    names: Vec<(String, String)>,
    /// Log that takes all messages.
    log: Log,
    /// Files that are being written; an interrupt removes them.
    pub(crate) unfinished: Unfinished,
    /// Diagnostics that were printed: none is twice.
    said: Mutex<HashSet<String>>,
    /// Whether an engine for jobs reads along, by Open Job Description.
    is_for_engine: AtomicBool,
}

impl Console {
    /// Creates the console whose messages go to a log.
    pub(crate) fn new(log: Log) -> Self {
        Self { log, ..Self::default() }
    }

    /// Returns the style of progress that was asked for; by itself it is JSON where the log is. From now on an engine that reads along is
    /// told of a failure, too.
    pub(crate) fn progress(&self, style: ProgressStyle) -> ProgressStyle {
        self.is_for_engine.store(style == ProgressStyle::Openjd, Ordering::Relaxed);
        if style == ProgressStyle::Auto && self.log.is_json() { ProgressStyle::Json } else { style }
    }

    /// Sets the readable name under which messages show a file from now on.
    pub(crate) fn call(&mut self, file: &Path, name: &str) {
        self.names.push((file.to_string_lossy().into_owned(), name.to_owned()));
    }

    /// Returns a text in which files have their readable names.
    pub(crate) fn told(&self, text: &str) -> String {
        self.names.iter().fold(text.to_owned(), |text, (file, name)| text.replace(file, name))
    }

    /// Tells of a diagnostic that does not stop the work. Notes are told only on request.
    pub(crate) fn warn(&self, diagnostic: &Diagnostic) {
        self.tell(diagnostic, false, option);
    }

    /// Tells what a check found. If it failed, notes are told, too: one may say why.
    pub(crate) fn tell_all<T>(&self, outcome: &Outcome<T>) {
        self.tell_all_as(outcome, option);
    }

    /// Tells what a check found, with settings by other names than those of options.
    pub(crate) fn tell_all_as<T>(&self, outcome: &Outcome<T>, name: impl Fn(Setting) -> String) {
        let has_failed = outcome.result.is_err();
        outcome.diagnostics.iter().for_each(|diagnostic| self.tell(diagnostic, has_failed, &name));
    }

    fn tell(&self, diagnostic: &Diagnostic, is_for_all: bool, name: impl Fn(Setting) -> String) {
        let text = self.told(&diagnostic.message.render(name));
        let is_note = diagnostic.severity == Severity::Note;
        let told = format!("{is_note} {is_for_all} {text}");
        if !self.said.lock().unwrap_or_else(PoisonError::into_inner).insert(told) {
            return;
        }
        if is_note {
            self.log.note(diagnostic.code, &text, is_for_all);
        } else {
            self.log.warning(Some(diagnostic.code), &text);
        }
    }

    /// Tells of something that may be wrong.
    pub(crate) fn warning(&self, text: impl Display) {
        self.log.warning(None, &self.told(&text.to_string()));
    }

    /// Tells why the work ends.
    pub(crate) fn error(&self, text: &str) {
        let text = self.told(text);
        self.log.error(&text);
        self.fail_for_engine(&text);
    }

    /// Tells an engine, if there is one, that the work has failed. Others read it in what was printed.
    pub(crate) fn fail_for_engine(&self, text: &str) {
        if self.is_for_engine.load(Ordering::Relaxed) {
            say_failure(text);
        }
    }

    /// Tells what was done.
    pub(crate) fn report(&self, text: impl Display) {
        self.log.report(&self.told(&text.to_string()));
    }

    /// Tells what was decided, to those who ask.
    pub(crate) fn decision(&self, decision: &Decision) {
        self.log.decision(decision.topic, decision.is_detail, &self.told(&in_options(&decision.message)));
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

/// Tells an engine of Open Job Description why the work ends.
pub(crate) fn say_failure(text: &str) {
    say(format_args!("openjd_fail: {}", text.replace('\n', " ")));
}

/// Prints a line on standard error. If nobody reads it any more, since a pipe is closed or a disk is full, the work
/// goes on.
pub(crate) fn say(line: impl Display) {
    say_as_it_is(&format!("{line}\n"));
}

/// Prints whole lines at once, so that those of several threads do not mix.
fn say_as_it_is(lines: &str) {
    let _ = stderr().write_all(escaped(lines).as_bytes());
}

/// Returns a text whose control characters, as names of files may hold them, are escaped as in JSON: a terminal obeys them, also those that
/// turn the direction of writing. Ends of lines and tabs stay.
fn escaped(text: &str) -> Cow<'_, str> {
    let turns = |c: char| matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let is_harmful = |c: char| (c.is_control() && !matches!(c, '\n' | '\t')) || turns(c);
    if !text.contains(is_harmful) {
        return text.into();
    }
    let escape = |c: char| if is_harmful(c) { format!("\\u{:04x}", u32::from(c)) } else { c.to_string() };
    text.chars().map(escape).collect::<String>().into()
}

/// Returns a message in which settings are options of the command line.
pub(crate) fn in_options(message: &Message) -> String {
    message.render(option)
}

/// Returns the option of a setting.
pub(crate) fn option(setting: Setting) -> String {
    match setting {
        Setting::Overwrite => "-y (--overwrite)".to_owned(),
        other => format!("--{}", other.name()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_commands_a_terminal() {
        assert_eq!(escaped("a\u{1b}[2J\r\u{7}\u{9b}b\u{7f}\n\tc"), "a\\u001b[2J\\u000d\\u0007\\u009bb\\u007f\n\tc");
        assert_eq!(escaped("a\u{202e}gpj.exe"), "a\\u202egpj.exe");
        assert!(matches!(escaped("plain, ä"), Cow::Borrowed(_)));
    }
}
