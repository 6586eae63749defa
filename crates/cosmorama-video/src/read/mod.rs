//! Frames of a video, by their numbers.

mod ahead;
mod decoder;
mod filters;
mod pair;
mod preceding;
mod reader;
mod traces;

use std::collections::BTreeSet;
use std::ops::{Range, RangeInclusive};

use cosmorama::raster::EncodedImage;

pub use pair::{HalfPlace, PairedReader, SecondHalf};
pub use reader::VideoReader;
pub use traces::CodedOrder;

/// Choices for reading a video.
#[derive(Clone, Debug)]
pub struct ReadOptions {
    /// Numbers of the first and last frame, from 0; `None` for all.
    pub frames: Option<RangeInclusive<u64>>,
    /// Frames among them that are looked at; `None` for all. Others may show traces of damage.
    pub looked_at: Option<BTreeSet<u64>>,
    /// Rows of each frame that are looked at; `None` for all. Others may hold anything.
    pub rows: Option<Range<usize>>,
    /// Answer to a frame that is damaged or missing.
    pub damaged: Damaged,
    /// Bytes that one frame may take.
    pub memory: u64,
    /// Threads of the decoder; 0 for as many as ffmpeg thinks right. Of what is damaged, several may make another picture each time.
    pub threads: usize,
}

impl Default for ReadOptions {
    /// Returns all frames, without tolerance for damage, of at most four gigabytes each.
    fn default() -> Self {
        Self { frames: None, looked_at: None, rows: None, damaged: Damaged::Error, memory: 4 << 30, threads: 0 }
    }
}

impl ReadOptions {
    /// Returns whether somebody looks at one of these frames.
    fn looks_at_any(&self, frames: &Range<u64>) -> bool {
        let (first, last) = self.frames.as_ref().map_or((0, u64::MAX), |range| (*range.start(), *range.end()));
        let (first, last) = (first.max(frames.start), last.min(frames.end.saturating_sub(1)));
        first <= last && self.looked_at.as_ref().is_none_or(|looked_at| looked_at.range(first..=last).next().is_some())
    }

    /// Returns whether somebody looks at a frame.
    fn looks_at(&self, frame: u64) -> bool {
        self.looks_at_any(&(frame..frame.saturating_add(1)))
    }
}

/// Answer to a frame that is damaged or missing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Damaged {
    /// The job fails, and the frame is named.
    #[default]
    Error,
    /// The frame before is shown again; at the beginning, the first whole one.
    Hold,
    /// The frame is left out.
    Skip,
}

impl Damaged {
    /// Returns the answer of a name: `error`, `hold` or `skip`.
    pub fn of_name(name: &str) -> Option<Self> {
        match name {
            "error" => Some(Self::Error),
            "hold" => Some(Self::Hold),
            "skip" => Some(Self::Skip),
            _ => None,
        }
    }
}

/// Frame of a video.
#[derive(Clone, Debug, PartialEq)]
pub struct VideoFrame {
    /// Number from 0 on, in the order in which frames are shown.
    pub index: u64,
    /// Time in ticks of the video's clock.
    pub time: i64,
    /// Picture: RGB of 8 bits, or of 16 if the video has more than 8; with alpha if the video has one.
    pub image: EncodedImage,
    /// Relation to the file's own frame.
    pub condition: FrameCondition,
}

/// Relation of a frame to the file's own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FrameCondition {
    /// The file's own.
    Whole,
    /// Another one in the place of a damaged one.
    Held,
}

/// Frames that are damaged or missing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Number of the first frame.
    pub frame: u64,
    /// Number of frames in a row.
    pub count: u64,
    /// Finding, in words.
    pub reason: String,
    /// Whether the frames came all the same: a decoder complained, and nobody knows of which. Others were held or skipped.
    pub is_given: bool,
}
