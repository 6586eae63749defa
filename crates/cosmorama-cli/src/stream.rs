//! What messages and reports call the files that stand for streams: standard input and output, pipes; and where messages go.

use std::fmt::Display;
use std::io::{Write, stderr};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// Each file with its name for people.
static NAMES: Mutex<Vec<(String, String)>> = Mutex::new(Vec::new());

/// From now on a file is called so.
pub(crate) fn call(file: &Path, name: &str) {
    let entry = (file.to_string_lossy().into_owned(), name.to_owned());
    NAMES.lock().unwrap_or_else(PoisonError::into_inner).push(entry);
}

/// Says a line on standard error. Where nobody reads it any more, since a pipe is closed or a disk is full, the work goes on.
pub(crate) fn say(line: impl Display) {
    let _ = writeln!(stderr(), "{line}");
}

/// A text for people, with files called as they have it.
pub(crate) fn told(text: &str) -> String {
    let names = NAMES.lock().unwrap_or_else(PoisonError::into_inner);
    names.iter().fold(text.to_owned(), |text, (file, name)| text.replace(file, name))
}
