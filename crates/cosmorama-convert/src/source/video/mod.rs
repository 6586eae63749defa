//! Videos as inputs and outputs: their frames by number, what they say of themselves, and one file of many pictures.
//!
//! A frame of a video has a name, such as `movie.mp4, frame 13`, that stands where a file's name would. Frames are numbered from 0, as
//! ffmpeg counts them.

#[cfg(not(feature = "video"))]
mod absent;
#[cfg(feature = "video")]
mod counted;
#[cfg(feature = "video")]
mod damage;
#[cfg(feature = "video")]
mod described;
mod frame_name;
#[cfg(feature = "video")]
mod live;
#[cfg(feature = "video")]
mod made;
#[cfg(feature = "video")]
mod raw;
#[cfg(feature = "video")]
mod read;
#[cfg_attr(not(feature = "video"), allow(dead_code, reason = "plans are for videos"))]
mod settings;
mod sink;

use std::path::Path;

#[cfg(not(feature = "video"))]
pub(crate) use absent::MadeVideos;
#[cfg(not(feature = "video"))]
pub use absent::Videos;
pub(crate) use frame_name::FrameName;
#[cfg(feature = "video")]
pub(crate) use made::MadeVideos;
#[cfg(feature = "video")]
pub use read::Videos;
pub(crate) use settings::{Coming, FrameDamage, RawBytes, RawFiles, RawKind, VideoPlan, VideoSource};
pub use settings::{DamagedFrames, VideoSettings};
pub use sink::PictureSink;

/// Returns whether a file is taken for a video or a stream of pictures, by its name. Without the feature `video`, none is.
pub fn is_video(path: &Path) -> bool {
    cfg!(feature = "video") && (cosmorama_io::is_video(path) || RawKind::of(path).is_some())
}

/// Returns what an output's extension may be beside those of pictures, in words; nothing without the feature `video`.
pub(crate) fn extensions() -> &'static str {
    if cfg!(feature = "video") {
        "; for a video mp4, m4v, mov, mkv or webm; for a stream of raw pictures y4m, pam or pfm"
    } else {
        ""
    }
}

#[cfg(all(test, feature = "video"))]
mod tests {
    use super::*;

    #[test]
    fn extensions_that_are_told_are_those_that_are_written() {
        let is_written = |name: &str| {
            cosmorama_video::Container::of_path(name.as_ref()).is_some() || RawKind::of(name.as_ref()).is_some()
        };
        let told = extensions().split(|sign: char| !sign.is_ascii_alphanumeric());
        let told = told.filter(|word| is_written(&format!("a.{word}"))).collect::<Vec<_>>();
        assert_eq!(told, ["mp4", "m4v", "mov", "mkv", "webm", "y4m", "pam", "pfm"]);
    }
}
