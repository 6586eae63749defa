use std::path::{Path, PathBuf};

use cosmorama_io::FramePattern;

/// File of a view, or its files by frame.
#[derive(Clone, Debug)]
pub enum ViewFiles {
    /// One file for all frames.
    One(PathBuf),
    /// A file for each frame.
    Sequence(FramePattern),
}

impl ViewFiles {
    /// Parses a file name, which may contain a frame marker.
    pub fn new(path: &Path) -> Self {
        match path.to_str().and_then(FramePattern::parse) {
            // An existing file whose name looks like a pattern is not a sequence.
            Some(pattern) if !path.is_file() => Self::Sequence(pattern),
            _ => Self::One(path.to_owned()),
        }
    }

    /// Returns the file of a frame.
    pub fn path(&self, frame: Option<u64>) -> PathBuf {
        match (self, frame) {
            (Self::One(path), _) => path.clone(),
            (Self::Sequence(pattern), Some(frame)) => pattern.path(frame),
            (Self::Sequence(pattern), None) => pattern.as_str().into(),
        }
    }

    /// Returns the pattern of a sequence.
    pub(crate) fn sequence(&self) -> Option<&FramePattern> {
        match self {
            Self::One(_) => None,
            Self::Sequence(pattern) => Some(pattern),
        }
    }

    /// Returns whether there is a folder in the place of an image.
    pub fn is_folder(&self) -> bool {
        self.path(None).is_dir()
    }
}
