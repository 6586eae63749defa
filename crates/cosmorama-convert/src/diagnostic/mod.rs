//! Diagnostics of a conversion: typed, and returned to the caller instead of printed.

mod code;
mod decision;
mod error;
mod mark;
mod message;
mod setting;

pub use code::Code;
pub use decision::{Decision, Topic};
pub use error::{ConvertError, Outcome, Result};
pub use message::{Message, Part};
pub use setting::Setting;

pub(crate) use error::{InPlace, bail, failed, failed_as, failure, of_opening, usage, usage_as};
pub(crate) use mark::Mark;
pub(crate) use setting::*;

/// A diagnostic of a conversion.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// Kind.
    pub code: Code,
    /// Severity: whether the work continues.
    pub severity: Severity,
    /// Subject: a file, a view or an output.
    pub subject: Option<String>,
    /// Readable text.
    pub message: Message,
    /// Remedy, if one setting provides it.
    pub remedy: Option<Remedy>,
}

/// Severity of a diagnostic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The work ends.
    Error,
    /// The work continues.
    Warning,
    /// Background for those who ask why; nothing is wrong.
    Note,
}

/// Change of a setting that resolves a diagnostic.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Remedy {
    /// Set a setting to this value.
    Set(Setting, String),
    /// Remove a setting.
    Drop(Setting),
}

impl Diagnostic {
    /// Creates a warning.
    pub fn warning(code: Code, message: impl Into<Message>) -> Self {
        Self { code, severity: Severity::Warning, subject: None, message: message.into(), remedy: None }
    }

    /// Creates a note.
    pub fn note(code: Code, message: impl Into<Message>) -> Self {
        Self { severity: Severity::Note, ..Self::warning(code, message) }
    }

    /// Creates an error.
    pub fn error(code: Code, message: impl Into<Message>) -> Self {
        Self { severity: Severity::Error, ..Self::warning(code, message) }
    }

    /// Sets the subject.
    #[must_use]
    pub fn about(self, subject: impl std::fmt::Display) -> Self {
        Self { subject: Some(subject.to_string()), ..self }
    }

    /// Sets the remedy.
    #[must_use]
    pub fn with_remedy(self, remedy: Remedy) -> Self {
        Self { remedy: Some(remedy), ..self }
    }
}

/// Writes the message with the settings' plain names.
impl std::fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.message.fmt(f)
    }
}
