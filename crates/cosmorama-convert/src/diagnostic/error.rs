use std::error::Error as _;
use std::io::ErrorKind;

use cosmorama::camera::CameraError;
use cosmorama::layout::LayoutError;
use cosmorama::world::WorldError;
use cosmorama_io::{CalibrationError, CameraPathError, IoError, PtoError};
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
    /// A calibration cannot be read.
    #[error(transparent)]
    Calibration(#[from] CalibrationError),
    /// The path of a camera cannot be read.
    #[error(transparent)]
    Path(#[from] CameraPathError),
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
    /// An observer stopped the conversion early.
    #[error(
        "stopped after {}, as was asked for; their files are whole, and to resume makes the others",
        frames.map_or_else(|| format!("{done} frames of a stream"), |frames| format!("{done} of {frames} frames"))
    )]
    Stopped {
        /// Frames that were reported as written.
        done: usize,
        /// Frames that were planned; `None` while the end of a stream was not known.
        frames: Option<usize>,
    },
    /// An error with its place: a line of a file, or a frame.
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
        self.map_err(|error| match error.into() {
            // For a stopped conversion, the frame does not matter.
            stopped @ ConvertError::Stopped { .. } => stopped,
            error => ConvertError::At { place: place(), error: Box::new(error) },
        })
    }
}

/// Creates an error about settings.
pub(crate) fn usage(message: impl Into<Message>) -> ConvertError {
    usage_as(Code::Settings, message)
}

/// Creates an error about settings, of a kind.
pub(crate) fn usage_as(code: Code, message: impl Into<Message>) -> ConvertError {
    ConvertError::Settings(Box::new(Diagnostic::error(code, message)))
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
/// Creates an error about files or the machine, optionally of a kind: `failure!(Damaged: "…")`.
macro_rules! failure {
    ($code:ident: $($text:tt)*) => {
        $crate::diagnostic::failed_as($crate::diagnostic::Code::$code, format!($($text)*))
    };
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
            Self::Io(IoError::NoSuchPart { .. } | IoError::NoSuchChannel { .. } | IoError::ChannelTwice { .. }) => true,
            Self::Path(error) => error.is_of_rate,
            Self::At { error, .. } => error.is_of_settings(),
            _ => false,
        }
    }

    /// Returns whether it is about a damaged frame that is to be left out.
    pub(crate) fn is_left_out(&self) -> bool {
        matches!(self, Self::Io(IoError::LeftOut { .. }))
    }

    /// Returns the kind of the error.
    pub fn code(&self) -> Code {
        match self {
            Self::Settings(diagnostic) | Self::Failed(diagnostic) => diagnostic.code,
            Self::At { error, .. } => error.code(),
            Self::Stopped { .. } => Code::Stopped,
            Self::Io(error) => of_file(error),
            Self::Project(error) => of_project(error),
            Self::Calibration(error) => of_calibration(error),
            Self::Path(_) => Code::Malformed,
            Self::CameraModel(_) | Self::World(_) | Self::Layout(_) => Code::Geometry,
            Self::Spec(_) => Code::Settings,
        }
    }

    /// Returns the error and its causes on one line.
    pub fn message(&self) -> Message {
        let mut message = String::new();
        for cause in self.causes() {
            // Many errors have their cause in their own message.
            if !message.contains(&cause) {
                message += if message.is_empty() { "" } else { ": " };
                message += &cause;
            }
        }
        message.into()
    }

    /// Replaces a setting in the text by other words.
    pub(crate) fn reworded(&self, setting: Mark, words: &str) -> Self {
        self.with_message(self.message().reworded(setting, words))
    }

    /// Returns the error with a text before its message.
    pub(crate) fn after(&self, words: &str) -> Self {
        self.with_message(self.message().after(words))
    }

    fn with_message(&self, message: Message) -> Self {
        if self.is_of_settings() { usage_as(self.code(), message) } else { failed_as(self.code(), message) }
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

/// Returns the code of an error about a file.
fn of_file(error: &IoError) -> Code {
    match error {
        IoError::Open { source, .. } => of_opening(source),
        IoError::NoFaces { .. }
        | IoError::MissingFaces { .. }
        | IoError::NoFrames { .. }
        | IoError::FarFrames { .. }
        | IoError::MissingFrames { .. } => Code::NotFound,
        IoError::FaceIsFolder { .. } => Code::Unreadable,
        IoError::Empty { .. } | IoError::Damaged { .. } | IoError::LeftOut { .. } => Code::Damaged,
        IoError::UnknownContent { .. }
        | IoError::VideoContent { .. }
        | IoError::PictureContent { .. }
        | IoError::Unsupported { .. }
        | IoError::NotBuilt { .. } => Code::Unsupported,
        IoError::TooLarge { .. } => Code::Memory,
        IoError::UnknownExtension { .. } | IoError::CannotHold { .. } => Code::OutputFormat,
        IoError::Write { .. } => Code::Unwritable,
        IoError::Video(_) => Code::Failed,
        IoError::NotAFacePattern { .. }
        | IoError::NoSuchPart { .. }
        | IoError::NoSuchChannel { .. }
        | IoError::ChannelTwice { .. } => Code::Settings,
        IoError::AmbiguousNaming { .. } => Code::Ambiguous,
        _ => Code::Failed,
    }
}

/// Returns the code of an error about a Hugin project.
fn of_project(error: &PtoError) -> Code {
    match error {
        PtoError::Open { source, .. } => of_opening(source),
        PtoError::NotBuilt { .. } => Code::Unsupported,
        _ => Code::Malformed,
    }
}

/// Returns the code of an error about a calibration.
fn of_calibration(error: &CalibrationError) -> Code {
    match error {
        CalibrationError::Open { source, .. } => of_opening(source),
        _ => Code::Malformed,
    }
}

/// Returns the code of an error while a file is opened.
pub(crate) fn of_opening(error: &std::io::Error) -> Code {
    if error.kind() == ErrorKind::NotFound { Code::NotFound } else { Code::Unreadable }
}
