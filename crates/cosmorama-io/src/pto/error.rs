use std::io;
use std::path::PathBuf;

use thiserror::Error;

/// Why a Hugin project cannot be read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PtoError {
    /// The file cannot be opened.
    #[error("cannot open the Hugin project {}: {source}", path.display())]
    Open {
        /// Which.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A line that cannot be understood, or asks for what is not supported.
    #[error("{}, line {line}: {reason}", path.display())]
    Line {
        /// The project.
        path: PathBuf,
        /// Which line, from 1.
        line: usize,
        /// What was found and what was expected.
        reason: String,
    },
    /// Something is missing.
    #[error("{}: {reason}", path.display())]
    Project {
        /// The project.
        path: PathBuf,
        /// What was found and what was expected.
        reason: String,
    },
}
