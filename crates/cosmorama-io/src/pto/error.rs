use std::io;
use std::path::PathBuf;

use thiserror::Error;

/// Reason why a Hugin project cannot be read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PtoError {
    /// The file cannot be opened.
    #[error("cannot open the Hugin project {}: {source}", path.display())]
    Open {
        /// Path of the file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// This build of the library reads no projects.
    #[error(
        "{}: this build reads no Hugin projects; it was made without the feature `hugin`: use a program that was made with it, or \
         list the views in a world file (.toml)", path.display()
    )]
    NotBuilt {
        /// Path of the project.
        path: PathBuf,
    },
    /// A line cannot be understood, or asks for something unsupported.
    #[error("{}, line {line}: {reason}", path.display())]
    Line {
        /// Path of the project.
        path: PathBuf,
        /// Number of the line, from 1.
        line: usize,
        /// Reason: what was found, and what was expected.
        reason: String,
    },
    /// A part of the project is missing.
    #[error("{}: {reason}", path.display())]
    Project {
        /// Path of the project.
        path: PathBuf,
        /// Reason: what was found, and what was expected.
        reason: String,
    },
}
