use std::io;
use std::path::PathBuf;

use thiserror::Error;

use crate::error::SceneError;
use crate::shape::MeshError;

/// Reason why there is no model.
#[derive(Debug, Error)]
#[error("{}: {why}", .path.display())]
pub struct ModelError {
    /// The file.
    pub path: PathBuf,
    /// Fault.
    pub why: ModelFault,
}

/// Fault of a model's file.
#[derive(Debug, Error)]
pub enum ModelFault {
    /// It cannot be read.
    #[error("cannot be read: {0}")]
    Io(#[from] io::Error),
    /// Its name does not tell what it is.
    #[error("its name ends in no model's extension; expected {}", super::EXTENSIONS.join(", "))]
    Extension,
    /// A line of it is wrong.
    #[error("line {line}: {why}")]
    Line {
        /// Number of the line, from 1.
        line: usize,
        /// Fault.
        why: String,
    },
    /// It is not as its format says.
    #[error("{0}")]
    Format(String),
    /// It needs what is not known.
    #[error("it requires extensions of glTF that are not supported: {0}; export it without them")]
    Required(String),
    /// It is of another version of glTF.
    #[error("it is of glTF {0}; expected 2.0, or a version that 2.0 can read")]
    Version(String),
    /// Its glass bounds no solid.
    #[error(transparent)]
    Glass(#[from] SceneError),
    /// A piece of it is wrong.
    #[error("{piece} {why}")]
    Piece {
        /// The piece.
        piece: String,
        /// Fault.
        why: String,
    },
    /// Its triangles are no surface.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// Pictures were asked for on a surface that has no places for them.
    #[error("it has no texture coordinates, so that no picture can be laid on it; export it with them")]
    NoCoordinates,
    /// It has more bytes than there is memory for.
    #[error("it has {bytes} bytes, and there is memory for {most}")]
    TooLong {
        /// Number of bytes.
        bytes: u64,
        /// Greatest number.
        most: u64,
    },
    /// It has more triangles, or as many vertices, than there is memory for.
    #[error("it has {count} triangles, and there is memory for {most}")]
    TooLarge {
        /// Number of triangles.
        count: usize,
        /// Greatest number.
        most: usize,
    },
}
