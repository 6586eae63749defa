use std::io;
use std::path::PathBuf;

use thiserror::Error;

/// Reason why a calibration cannot be read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CalibrationError {
    /// The file cannot be opened.
    #[error("cannot open the calibration {}: {source}", path.display())]
    Open {
        /// Path of the file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The file lacks what a calibration needs.
    #[error("{}: {reason}", path.display())]
    Wrong {
        /// Path of the file.
        path: PathBuf,
        /// Reason: what was found, and what was expected.
        reason: String,
    },
}
