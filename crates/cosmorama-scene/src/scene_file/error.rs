use std::ops::Range;
use std::path::{Path, PathBuf};

use cosmorama_spec::did_you_mean;
use thiserror::Error;

/// Mistake in a scene file, with its line.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{place}: {message}")]
pub struct SceneFileError {
    /// File, and line if it is known.
    pub place: String,
    /// Explanation: the text that was found, and the one that was expected.
    pub message: String,
}

/// Path and text of a scene file, for messages with places.
#[derive(Clone, Debug)]
pub(super) struct Source {
    pub(super) path: PathBuf,
    pub(super) text: String,
}

impl Source {
    pub(super) fn error(&self, span: Option<Range<usize>>, message: impl Into<String>) -> SceneFileError {
        SceneFileError { place: self.place(span), message: message.into() }
    }

    /// Returns the error of the TOML reader without programming terms, and with what may have been meant.
    pub(super) fn malformed(&self, error: &toml::de::Error) -> SceneFileError {
        let words = [
            ("floating point", "number"),
            ("expected f64", "expected a number"),
            ("expected usize", "expected a whole number"),
            ("invalid type: ", "found "),
            ("unknown field", "unknown key"),
            ("unknown variant", "unknown name"),
        ];
        let message = words.iter().fold(error.message().to_owned(), |text, (from, to)| text.replace(from, to));
        let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
        let meant = match quoted.split_first() {
            Some((typed, known)) if message.starts_with("unknown") => did_you_mean(typed, known),
            _ => String::new(),
        };
        self.error(error.span(), format!("{message}{meant}"))
    }

    /// Returns the folder that names of files are relative to.
    pub(super) fn folder(&self) -> &Path {
        self.path.parent().unwrap_or(Path::new(""))
    }

    /// Returns an input's name from the program's own folder; built-in worlds keep theirs.
    pub(super) fn beside(&self, input: &str) -> String {
        if input.starts_with("builtin:") {
            input.to_owned()
        } else {
            self.folder().join(input).to_string_lossy().into_owned()
        }
    }

    /// Returns the file and the line.
    pub(super) fn place(&self, span: Option<Range<usize>>) -> String {
        let path = self.path.display();
        span.map_or_else(|| path.to_string(), |span| format!("{path}, line {}", self.line(&span)))
    }

    /// Returns the line, from 1 on.
    pub(super) fn line(&self, span: &Range<usize>) -> usize {
        1 + self.text.bytes().take(span.start).filter(|byte| *byte == b'\n').count()
    }
}
