//! Look at a video that was written: whether all is there.

use std::path::Path;
use std::time::Duration;

use serde_json::Value;

use super::Container;
use super::labels::Labelled;
use crate::{Ffmpeg, StreamKind, VideoError};

/// Expected content of a video.
pub(super) struct Expected<'a> {
    pub(super) frames: u64,
    pub(super) size: (usize, usize),
    pub(super) sounds: Option<usize>,
    /// Whether it must say that it is spherical.
    pub(super) is_spherical: bool,
    pub(super) container: Container,
    /// Labels that it should have.
    pub(super) labelled: &'a [Labelled],
}

/// Time for reading a whole video once, which is at least as fast as it was written.
const PATIENCE: Duration = Duration::from_secs(12 * 60 * 60);

/// Bytes of ffprobe's answer.
const ANSWER: usize = 4 << 20;

impl Expected<'_> {
    /// Reads a temporary file and compares; messages name the file that it is to become. Returns statements on labels that it has not kept.
    pub(super) fn verify(&self, ffmpeg: &Ffmpeg, written: &Path, path: &Path) -> Result<Vec<String>, VideoError> {
        let not = |found: String, expected: String| VideoError::NotAsGiven { path: path.to_owned(), found, expected };
        let said = ffmpeg.ffprobe(written, &["-count_packets", "-of", "json", "-show_streams"], ANSWER, PATIENCE)?;
        let document = serde_json::from_slice::<Value>(&said.stdout).unwrap_or_default();
        let streams = document["streams"].as_array().map(Vec::as_slice).unwrap_or_default();
        let Some(video) = streams.iter().find(|stream| stream["codec_type"] == "video") else {
            return Err(not(format!("no video ({})", said.last_words()), "one was encoded".to_owned()));
        };
        let frames = video["nb_read_packets"].as_str().and_then(|count| count.parse::<u64>().ok()).unwrap_or(0);
        if frames != self.frames {
            return Err(not(format!("{frames} frames"), format!("{} were given", self.frames)));
        }
        let (width, height) = self.size;
        if (video["width"].as_u64(), video["height"].as_u64()) != (Some(width as u64), Some(height as u64)) {
            let found = format!("frames of {}x{}", video["width"], video["height"]);
            return Err(not(found, format!("those given are of {width}x{height}")));
        }
        let sounds = streams.iter().filter(|stream| stream["codec_type"] == "audio").count();
        if let Some(expected) = self.sounds.filter(|expected| *expected != sounds) {
            return Err(not(format!("{sounds} streams of sound"), format!("there should be {expected}")));
        }
        let mut sides = video["side_data_list"].as_array().into_iter().flatten();
        let is_spherical = sides.any(|data| data["side_data_type"] == "Spherical Mapping");
        if self.is_spherical && !is_spherical {
            return Err(not("no spherical tag".to_owned(), "one was asked for".to_owned()));
        }
        Ok(self.lost_labels(streams))
    }

    fn lost_labels(&self, streams: &[Value]) -> Vec<String> {
        let lost = |(at, labelled): (usize, &Labelled)| {
            let before = self.labelled[..at].iter().filter(|other| other.kind == labelled.kind).count();
            let has_kind =
                |stream: &&Value| StreamKind::of(stream["codec_type"].as_str().unwrap_or_default()) == labelled.kind;
            // Arguments of the user's own may leave it out.
            let written = streams.iter().filter(has_kind).nth(before)?;
            let lost = labelled.lost(written, self.container)?;
            Some(format!(
                "{} loses {lost}: {} has no room for it, as ffmpeg writes it",
                labelled.name,
                self.container.name()
            ))
        };
        self.labelled.iter().enumerate().filter_map(lost).collect()
    }
}
