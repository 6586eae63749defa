use std::error::Error as _;

use cosmorama::camera::CameraError;
use cosmorama::layout::LayoutError;
use cosmorama::world::WorldError;
use cosmorama_io::{IoError, PtoError};
use cosmorama_spec::SpecError;
use thiserror::Error;

use super::{Code, Diagnostic, Mark, Message};

/// Why a conversion cannot be done.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ConvertError {
    /// Settings are wrong, or go neither together nor with the files.
    #[error("{0}")]
    Settings(Box<Diagnostic>),
    /// The files, or the machine, are not as they would have to be.
    #[error("{0}")]
    Failed(Box<Diagnostic>),
    /// A file cannot be read, written or found.
    #[error(transparent)]
    Io(#[from] IoError),
    /// A Hugin project cannot be read.
    #[error(transparent)]
    Project(#[from] PtoError),
    /// A projection cannot be had.
    #[error(transparent)]
    CameraModel(#[from] CameraError),
    /// Views cannot be a world.
    #[error(transparent)]
    World(#[from] WorldError),
    /// Pictures cannot lie so in an image.
    #[error(transparent)]
    Layout(#[from] LayoutError),
    /// A SPEC cannot be understood.
    #[error(transparent)]
    Spec(#[from] SpecError),
    /// An error in a place: a line of a file, a frame.
    #[error("{place}")]
    At {
        /// Where.
        place: String,
        /// What.
        #[source]
        error: Box<ConvertError>,
    },
}

/// Result of what may not be possible.
pub type Result<T, E = ConvertError> = std::result::Result<T, E>;

/// A result with what should be known either way.
#[derive(Debug)]
pub struct Outcome<T> {
    /// What came of it.
    pub result: Result<T>,
    /// What should be known, in the order in which it was found.
    pub diagnostics: Vec<Diagnostic>,
}

/// Adds the place of an error.
pub(crate) trait InPlace<T> {
    /// Says where an error is.
    fn at(self, place: impl FnOnce() -> String) -> Result<T>;
}

impl<T, E: Into<ConvertError>> InPlace<T> for Result<T, E> {
    fn at(self, place: impl FnOnce() -> String) -> Result<T> {
        self.map_err(|error| ConvertError::At { place: place(), error: Box::new(error.into()) })
    }
}

/// An error of whoever made the settings.
pub(crate) fn usage(message: impl Into<Message>) -> ConvertError {
    ConvertError::Settings(Box::new(Diagnostic::error(Code::Settings, message)))
}

/// An error of what was found.
pub(crate) fn failed(message: impl Into<Message>) -> ConvertError {
    failed_as(Code::Failed, message)
}

/// An error of what was found, of a kind.
pub(crate) fn failed_as(code: Code, message: impl Into<Message>) -> ConvertError {
    ConvertError::Failed(Box::new(Diagnostic::error(code, message)))
}

/// Ends a function with an error of what was found, perhaps of a kind: `bail!(Uncovered: "…")`.
macro_rules! bail {
    ($code:ident: $($text:tt)*) => {
        return Err($crate::diagnostic::failed_as($crate::diagnostic::Code::$code, format!($($text)*)))
    };
    ($($text:tt)*) => {
        return Err($crate::diagnostic::failed(format!($($text)*)))
    };
}
/// An error of what was found.
macro_rules! failure {
    ($($text:tt)*) => {
        $crate::diagnostic::failed(format!($($text)*))
    };
}
pub(crate) use {bail, failure};

impl ConvertError {
    /// Returns whether settings are to blame, not files or the machine.
    pub fn is_of_settings(&self) -> bool {
        match self {
            Self::Settings(_) => true,
            Self::At { error, .. } => error.is_of_settings(),
            _ => false,
        }
    }

    /// Returns what kind of error it is.
    pub fn code(&self) -> Code {
        match self {
            Self::Settings(diagnostic) | Self::Failed(diagnostic) => diagnostic.code,
            Self::At { error, .. } => error.code(),
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

    /// Says the same in other words, where a setting is called otherwise.
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
