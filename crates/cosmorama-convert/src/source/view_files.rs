use std::path::{Path, PathBuf};

use cosmorama_io::FramePattern;

use crate::source::video::{FrameName, is_video};

/// File of a view, or its files by frame.
#[derive(Clone, Debug)]
pub enum ViewFiles {
    /// One file for all frames.
    One(PathBuf),
    /// A file for each frame.
    Sequence(FramePattern),
    /// A video with all frames.
    Video(PathBuf),
}

impl ViewFiles {
    /// Parses a file name, which may contain a frame marker, or be a video's.
    pub fn new(path: &Path) -> Self {
        match path.to_str().and_then(FramePattern::parse) {
            // An existing file whose name looks like a pattern is not a sequence.
            Some(pattern) if !path.is_file() => Self::Sequence(pattern),
            _ if is_video(path) => Self::Video(path.to_owned()),
            _ => Self::One(path.to_owned()),
        }
    }

    /// Returns the file of a frame. Of a video it is the name of the frame, as in `movie.mp4, frame 13`.
    pub fn path(&self, frame: Option<u64>) -> PathBuf {
        match (self, frame) {
            (Self::One(path), _) => path.clone(),
            (Self::Sequence(pattern), Some(frame)) => pattern.path(frame),
            (Self::Sequence(pattern), None) => pattern.as_str().into(),
            (Self::Video(video), Some(frame)) => FrameName { video: video.clone(), frame }.path(),
            (Self::Video(video), None) => video.clone(),
        }
    }

    /// Returns the file on disk that holds a frame.
    pub(crate) fn file(&self, frame: Option<u64>) -> PathBuf {
        match self {
            Self::Video(video) => video.clone(),
            Self::One(_) | Self::Sequence(_) => self.path(frame),
        }
    }

    /// Returns the video.
    pub fn video(&self) -> Option<&Path> {
        match self {
            Self::Video(video) => Some(video),
            Self::One(_) | Self::Sequence(_) => None,
        }
    }

    /// Returns whether there is a picture for each frame.
    pub(crate) fn has_frames(&self) -> bool {
        !matches!(self, Self::One(_))
    }

    /// Returns whether there is a folder in the place of an image.
    pub fn is_folder(&self) -> bool {
        self.path(None).is_dir()
    }
}
