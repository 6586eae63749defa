//! The installed programs: found, asked for their version and encoders, and run.

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use crate::read::Timeline;
use crate::{VideoError, VideoInfo};

/// The installed ffmpeg and ffprobe. Clones share nothing; each value asks for the encoders once.
#[derive(Debug)]
pub struct Ffmpeg {
    ffmpeg: PathBuf,
    ffprobe: PathBuf,
    version: Version,
    encoders: OnceLock<Vec<String>>,
}

/// Version of ffmpeg.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Version {
    /// First number.
    pub major: u32,
    /// Second number.
    pub minor: u32,
}

impl fmt::Display for Version {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.major, self.minor)
    }
}

impl Ffmpeg {
    /// Oldest version that is used.
    pub const OLDEST: Version = Version { major: 4, minor: 4 };

    /// Finds ffmpeg and ffprobe on the search path of the process.
    ///
    /// # Errors
    /// When one is not installed, or older than 4.4; the message says how to install it.
    pub fn find() -> Result<Self, VideoError> {
        todo!()
    }

    /// Returns the version of ffmpeg.
    pub fn version(&self) -> Version {
        self.version
    }

    /// Returns the names of the video encoders of this build.
    ///
    /// # Errors
    /// When ffmpeg cannot be run.
    pub fn encoders(&self) -> Result<&[String], VideoError> {
        todo!()
    }

    /// Reads what a video is, without decoding it.
    ///
    /// # Errors
    /// When the file cannot be read, holds no video, or says impossible things of it.
    pub fn probe(&self, _path: &Path) -> Result<VideoInfo, VideoError> {
        todo!()
    }

    /// Finds the times of all frames. For a video of variable rate this reads the whole file, without decoding it.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn timeline(&self, _info: &VideoInfo) -> Result<Timeline, VideoError> {
        todo!()
    }
}
