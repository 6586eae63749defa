use std::error::Error as _;

use cosmorama::camera::CameraError;
use cosmorama::layout::LayoutError;
use cosmorama::world::WorldError;
use cosmorama_io::{IoError, PtoError};
use cosmorama_spec::SpecError;
use thiserror::Error;

use super::{Code, Diagnostic, Mark, Message};

/// Reason why a conversion fails.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ConvertError {
    /// Settings are wrong, or do not fit together or to the files.
    #[error("{0}")]
    Settings(Box<Diagnostic>),
    /// The state of the files or the machine prevents the conversion.
    #[error("{0}")]
    Failed(Box<Diagnostic>),
    /// A file cannot be read, written or found.
    #[error(transparent)]
    Io(#[from] IoError),
    /// A Hugin project cannot be read.
    #[error(transparent)]
    Project(#[from] PtoError),
    /// A camera model does not make a view.
    #[error(transparent)]
    CameraModel(#[from] CameraError),
    /// Views do not make a world.
    #[error(transparent)]
    World(#[from] WorldError),
    /// Pictures do not fit a layout.
    #[error(transparent)]
    Layout(#[from] LayoutError),
    /// A SPEC cannot be understood.
    #[error(transparent)]
    Spec(#[from] SpecError),
    /// An observer stopped the conversion.
    #[error("stopped after {done} of {frames} frames, as was asked for; their files are whole, and to resume makes the others")]
    Stopped {
        /// Frames that the observer had learned of.
        done: usize,
        /// Frames that were to be made.
        frames: usize,
    },
    /// An error in a place: a line of a file, a frame.
    #[error("{place}")]
    At {
        /// Place, in words.
        place: String,
        /// The error.
        #[source]
        error: Box<ConvertError>,
    },
}

/// Result of a fallible step.
pub type Result<T, E = ConvertError> = std::result::Result<T, E>;

/// A result together with diagnostics, which are valid on success and failure.
#[derive(Debug)]
pub struct Outcome<T> {
    /// The result.
    pub result: Result<T>,
    /// Diagnostics, in the order in which they arose.
    pub diagnostics: Vec<Diagnostic>,
}

/// Extension that adds the place of an error.
pub(crate) trait InPlace<T> {
    /// Adds a place to an error.
    fn at(self, place: impl FnOnce() -> String) -> Result<T>;
}

impl<T, E: Into<ConvertError>> InPlace<T> for Result<T, E> {
    fn at(self, place: impl FnOnce() -> String) -> Result<T> {
        self.map_err(|error| ConvertError::At { place: place(), error: Box::new(error.into()) })
    }
}

/// Creates an error about settings.
pub(crate) fn usage(message: impl Into<Message>) -> ConvertError {
    ConvertError::Settings(Box::new(Diagnostic::error(Code::Settings, message)))
}

/// Creates an error about files or the machine.
pub(crate) fn failed(message: impl Into<Message>) -> ConvertError {
    failed_as(Code::Failed, message)
}

/// Creates an error about files or the machine, of a kind.
pub(crate) fn failed_as(code: Code, message: impl Into<Message>) -> ConvertError {
    ConvertError::Failed(Box::new(Diagnostic::error(code, message)))
}

/// Returns from a function with an error about files or the machine, perhaps of a kind: `bail!(Uncovered: "…")`.
macro_rules! bail {
    ($code:ident: $($text:tt)*) => {
        return Err($crate::diagnostic::failed_as($crate::diagnostic::Code::$code, format!($($text)*)))
    };
    ($($text:tt)*) => {
        return Err($crate::diagnostic::failed(format!($($text)*)))
    };
}
/// Creates an error about files or the machine.
macro_rules! failure {
    ($($text:tt)*) => {
        $crate::diagnostic::failed(format!($($text)*))
    };
}
pub(crate) use {bail, failure};

impl ConvertError {
    /// Returns whether settings are the cause, not files or the machine.
    pub fn is_of_settings(&self) -> bool {
        match self {
            Self::Settings(_) => true,
            Self::At { error, .. } => error.is_of_settings(),
            _ => false,
        }
    }

    /// Returns the kind of the error.
    pub fn code(&self) -> Code {
        match self {
            Self::Settings(diagnostic) | Self::Failed(diagnostic) => diagnostic.code,
            Self::At { error, .. } => error.code(),
            Self::Stopped { .. } => Code::Stopped,
            _ => Code::Failed,
        }
    }

    /// Returns the error and its causes on one line.
    pub fn message(&self) -> Message {
        let mut message = String::new();
        for cause in self.causes() {
            // Many errors tell their cause themselves.
            if !message.contains(&cause) {
                message += if message.is_empty() { "" } else { ": " };
                message += &cause;
            }
        }
        message.into()
    }

    /// Replaces a setting in the text by other words.
    pub(crate) fn reworded(&self, setting: Mark, words: &str) -> Self {
        let message = self.message().reworded(setting, words);
        if self.is_of_settings() { usage(message) } else { failed_as(self.code(), message) }
    }

    fn causes(&self) -> Vec<String> {
        match self {
            Self::Settings(diagnostic) | Self::Failed(diagnostic) => vec![diagnostic.message.marked().to_owned()],
            Self::At { place, error } => [vec![place.clone()], error.causes()].concat(),
            other => {
                let mut causes = vec![other.to_string()];
                let mut cause = other.source();
                while let Some(error) = cause {
                    causes.push(error.to_string());
                    cause = error.source();
                }
                causes
            }
        }
    }
}
