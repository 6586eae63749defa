//! Tags that are said in a video's frames alone.

use serde_json::Value;

use super::document::PATIENCE;
use super::stream::side_data;
use crate::{Ffmpeg, HdrTags, VideoError, VideoInfo};

/// Bytes of ffprobe's answer about a frame.
const ANSWER: usize = 1 << 20;

/// First frame of a video.
pub(super) struct FirstFrame {
    pub(super) hdr: HdrTags,
}

impl FirstFrame {
    /// Decodes the first frame. One that is damaged tells nothing; the reader will name it.
    pub(super) fn read(ffmpeg: &Ffmpeg, info: &VideoInfo) -> Result<Self, VideoError> {
        let stream = info.stream.to_string();
        let arguments = ["-select_streams", &stream, "-read_intervals", "%+#1", "-of", "json", "-show_frames"];
        let said = ffmpeg.ffprobe(&info.path, &arguments, ANSWER, PATIENCE)?;
        let document = serde_json::from_slice::<Value>(&said.stdout).unwrap_or_default();
        let (hdr, _) = side_data(&document["frames"][0]["side_data_list"], info.coded_size);
        Ok(Self { hdr })
    }
}
