use std::path::{Path, PathBuf};

use cosmorama_io::FramePattern;

/// The file of a view, or its files by frame.
#[derive(Clone, Debug)]
pub enum ViewFiles {
    /// One file for all frames.
    One(PathBuf),
    /// A file for each frame.
    Sequence(FramePattern),
}

impl ViewFiles {
    /// A file name, which may hold a frame marker.
    pub fn new(path: &Path) -> Self {
        match path.to_str().and_then(FramePattern::parse) {
            // A file that really has such a name is no sequence.
            Some(pattern) if !path.is_file() => Self::Sequence(pattern),
            _ => Self::One(path.to_owned()),
        }
    }

    /// The file of a frame.
    pub fn path(&self, frame: Option<u64>) -> PathBuf {
        match (self, frame) {
            (Self::One(path), _) => path.clone(),
            (Self::Sequence(pattern), Some(frame)) => pattern.path(frame),
            (Self::Sequence(pattern), None) => pattern.as_str().into(),
        }
    }

    /// The pattern, if it is one.
    pub(crate) fn sequence(&self) -> Option<&FramePattern> {
        match self {
            Self::One(_) => None,
            Self::Sequence(pattern) => Some(pattern),
        }
    }

    /// Whether a folder stands where an image should be.
    pub fn is_folder(&self) -> bool {
        self.path(None).is_dir()
    }
}
