//! What a conversion has to say: typed, and handed to the caller instead of printed.

mod code;
mod error;
mod mark;
mod message;
mod setting;

pub use code::Code;
pub use error::{ConvertError, Outcome, Result};
pub use message::{Message, Part};
pub use setting::Setting;

pub(crate) use error::{InPlace, bail, failed, failed_as, failure, usage};
pub(crate) use mark::*;

/// Something that should be known about a conversion.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// What kind of thing it is.
    pub code: Code,
    /// Whether the work goes on.
    pub severity: Severity,
    /// What it is about: a file, a view, an output.
    pub subject: Option<String>,
    /// Text for people.
    pub message: Message,
    /// What would change it, where one setting would.
    pub remedy: Option<Remedy>,
}

/// How much a diagnostic matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// Ends the work.
    Error,
    /// Should be known; the work goes on.
    Warning,
}

/// What a caller may do about a diagnostic.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Remedy {
    /// Give a setting this value.
    Set(Setting, String),
    /// Leave a setting out.
    Drop(Setting),
}

impl Diagnostic {
    /// Creates a warning.
    pub fn warning(code: Code, message: impl Into<Message>) -> Self {
        Self { code, severity: Severity::Warning, subject: None, message: message.into(), remedy: None }
    }

    /// Creates an error.
    pub fn error(code: Code, message: impl Into<Message>) -> Self {
        Self { severity: Severity::Error, ..Self::warning(code, message) }
    }

    /// Says what it is about.
    #[must_use]
    pub fn about(self, subject: impl std::fmt::Display) -> Self {
        Self { subject: Some(subject.to_string()), ..self }
    }

    /// Says what a caller may do.
    #[must_use]
    pub fn with_remedy(self, remedy: Remedy) -> Self {
        Self { remedy: Some(remedy), ..self }
    }
}

/// Writes the message, settings by their plain names.
impl std::fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.message.fmt(f)
    }
}
