use std::path::{Path, PathBuf};

use thiserror::Error;

/// Reason why the path of a camera cannot be read.
#[derive(Debug, Error)]
#[error("{}: {place}{reason}", path.display())]
pub struct CameraPathError {
    /// Path of the file.
    pub path: PathBuf,
    /// Place in the file, as `line 3: `; empty for the whole file.
    pub place: String,
    /// Reason: what was found, and what was expected.
    pub reason: String,
    /// Whether the rate of frames is at fault, which is not in the file.
    pub is_of_rate: bool,
}

/// Creates the error of a whole file.
pub(super) fn wrong(path: &Path, reason: impl Into<String>) -> CameraPathError {
    CameraPathError { path: path.to_owned(), place: String::new(), reason: reason.into(), is_of_rate: false }
}
