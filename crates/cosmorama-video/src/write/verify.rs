//! Look at a video that was written: whether all is there.

use std::path::Path;
use std::time::Duration;

use serde_json::Value;

use super::Container;
use super::labels::{Labelled, lost_tags};
use crate::{Ffmpeg, StreamKind, VideoError};

/// Expected content of a video.
pub(super) struct Expected<'a> {
    pub(super) frames: u64,
    pub(super) size: (usize, usize),
    /// Whether it must say that it is spherical.
    pub(super) is_spherical: bool,
    /// Number of streams of sound that it must have; `None` where it may have fewer.
    pub(super) sounds: Option<usize>,
    pub(super) container: Container,
    /// Streams that it should have, with their labels.
    pub(super) labelled: &'a [Labelled],
    /// Names and values of the film's own metadata.
    pub(super) metadata: &'a [(String, String)],
}

/// Time for reading a whole video once, which is at least as fast as it was written.
const PATIENCE: Duration = Duration::from_secs(12 * 60 * 60);

/// Kinds of streams that go along, and of the video itself.
const KINDS: [StreamKind; 4] = [StreamKind::Video, StreamKind::Audio, StreamKind::Subtitle, StreamKind::Attachment];

/// Bytes of ffprobe's answer.
const ANSWER: usize = 4 << 20;

impl Expected<'_> {
    /// Reads a temporary file and compares; messages name the file that it is to become. Returns statements on what it has not kept.
    pub(super) fn verify(&self, ffmpeg: &Ffmpeg, written: &Path, path: &Path) -> Result<Vec<String>, VideoError> {
        let not = |found: String, expected: String| VideoError::NotAsGiven { path: path.to_owned(), found, expected };
        let said = ffmpeg.ffprobe(
            written,
            &["-count_packets", "-of", "json", "-show_streams", "-show_format"],
            ANSWER,
            PATIENCE,
        )?;
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
        let of_film = lost_tags(self.metadata, &document["format"]);
        let of_film = of_film.map(|names| format!("the film loses its tags ({names}): {}", self.no_room()));
        Ok(KINDS.iter().flat_map(|kind| self.lost_of(*kind, streams)).chain(of_film).collect())
    }

    /// Returns statements on streams of a kind that are not there, or have not kept their labels.
    fn lost_of(&self, kind: StreamKind, streams: &[Value]) -> Vec<String> {
        let expected: Vec<&Labelled> = self.labelled.iter().filter(|stream| stream.kind == kind).collect();
        let is_of_kind = |stream: &&Value| StreamKind::of(stream["codec_type"].as_str().unwrap_or_default()) == kind;
        let written: Vec<&Value> = streams.iter().filter(is_of_kind).collect();
        if written.len() < expected.len() {
            // Which one is missing, nobody tells.
            let names: Vec<&str> = expected.iter().map(|stream| stream.name.as_str()).collect();
            return vec![format!(
                "{} of {} are written of {}: what has nothing at the time of these frames is left out",
                written.len(),
                expected.len(),
                names.join(", ")
            )];
        }
        let lost = |(expected, written): (&Labelled, &Value)| {
            let is_empty =
                kind == StreamKind::Audio && written["nb_read_packets"].as_str().is_none_or(|count| count == "0");
            let nothing = is_empty.then(|| format!("{} has nothing at the time of these frames", expected.name));
            let labels = expected.lost(written, self.container);
            let labels = labels.map(|labels| format!("{} loses {labels}: {}", expected.name, self.no_room()));
            nothing.into_iter().chain(labels)
        };
        expected.into_iter().zip(written).flat_map(lost).collect()
    }

    fn no_room(&self) -> String {
        format!("{} has no room for it, as ffmpeg writes it", self.container.name())
    }
}
