use std::io;
use std::path::PathBuf;

use thiserror::Error;

/// Why a calibration cannot be read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CalibrationError {
    /// The file cannot be opened.
    #[error("cannot open the calibration {}: {source}", path.display())]
    Open {
        /// Which.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// It does not hold what a calibration needs.
    #[error("{}: {reason}", path.display())]
    Wrong {
        /// Which.
        path: PathBuf,
        /// What was found and what was expected.
        reason: String,
    },
}
