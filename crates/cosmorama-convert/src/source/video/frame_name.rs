use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use super::is_video;

/// Name of a frame of a video.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct FrameName {
    /// File of the video.
    pub(crate) video: PathBuf,
    /// Number of the frame, from 0.
    pub(crate) frame: u64,
}

/// Text between the name of a video and the number of a frame.
const BETWEEN: &str = ", frame ";

impl FrameName {
    /// Reads the name of a frame; `None` for a file.
    pub(crate) fn parse(path: &Path) -> Option<Self> {
        let (video, number) = parted(path)?;
        let (video, frame) = (PathBuf::from(video), number.parse().ok()?);
        is_video(&video).then_some(Self { video, frame })
    }

    /// Returns the name in place of a file's.
    pub(crate) fn path(&self) -> PathBuf {
        let mut name = self.video.clone().into_os_string();
        name.push(format!("{BETWEEN}{}", self.frame));
        name.into()
    }

    /// Returns the file that a name leads to: the video of a frame, or the file itself.
    pub(crate) fn file(path: &Path) -> PathBuf {
        Self::parse(path).map_or_else(|| path.to_owned(), |name| name.video)
    }
}

/// Parts a name into those of a video, which may be no UTF-8, and of a frame.
#[cfg(unix)]
fn parted(path: &Path) -> Option<(&OsStr, &str)> {
    use std::os::unix::ffi::OsStrExt;
    let bytes = path.as_os_str().as_bytes();
    let at = bytes.windows(BETWEEN.len()).rposition(|part| part == BETWEEN.as_bytes())?;
    Some((OsStr::from_bytes(&bytes[..at]), std::str::from_utf8(&bytes[at + BETWEEN.len()..]).ok()?))
}

#[cfg(not(unix))]
fn parted(path: &Path) -> Option<(&OsStr, &str)> {
    let (video, number) = path.to_str()?.rsplit_once(BETWEEN)?;
    Some((OsStr::new(video), number))
}

#[cfg(all(test, feature = "video"))]
mod tests {
    use super::*;

    #[test]
    fn a_frame_is_named_in_place_of_a_file() {
        let name = FrameName { video: "a, frame 3/movie.mp4".into(), frame: 13 };
        assert_eq!(name.path(), Path::new("a, frame 3/movie.mp4, frame 13"));
        assert_eq!(FrameName::parse(&name.path()), Some(name.clone()));
        assert_eq!(FrameName::file(&name.path()), name.video);
        for file in ["movie.mp4", "picture.png, frame 3", "movie.mp4, frame x", "movie.mp4, frame "] {
            assert_eq!(FrameName::parse(Path::new(file)), None, "{file}");
            assert_eq!(FrameName::file(Path::new(file)), Path::new(file));
        }
    }
}
