//! Frames of a video, by their numbers.

use std::ops::RangeInclusive;

use cosmorama::raster::EncodedImage;

use crate::{Ffmpeg, Ratio, VideoError, VideoInfo};

/// Frames of a video in the order in which they are shown. Dropped early, it ends its ffmpeg.
#[derive(Debug)]
pub struct VideoReader {
    faults: Vec<Fault>,
}

/// Choices for reading a video.
#[derive(Clone, Debug)]
pub struct ReadOptions {
    /// Numbers of the first and last frame, from 0; `None` for all.
    pub frames: Option<RangeInclusive<u64>>,
    /// Answer to a frame that is damaged or missing.
    pub damaged: Damaged,
    /// Bytes that one frame may take.
    pub memory: u64,
    /// Threads of the decoder; 0 for as many as ffmpeg thinks right.
    pub threads: usize,
}

impl Default for ReadOptions {
    /// Returns all frames, without tolerance for damage, of at most four gigabytes each.
    fn default() -> Self {
        Self { frames: None, damaged: Damaged::Error, memory: 4 << 30, threads: 0 }
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

/// Damaged or missing frame that was held or skipped.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Number of the frame.
    pub frame: u64,
    /// Finding, in words.
    pub reason: String,
}

/// Times of a video's frames.
#[derive(Clone, Debug, PartialEq)]
pub enum Timeline {
    /// A constant rate.
    Even {
        /// Time of the first frame in ticks.
        start: i64,
        /// Seconds a tick.
        time_base: Ratio,
        /// Frames a second.
        rate: Ratio,
    },
    /// A time for each frame.
    Listed {
        /// Times in ticks, increasing.
        times: Vec<i64>,
        /// Seconds a tick.
        time_base: Ratio,
    },
}

impl Timeline {
    /// Returns the time of a frame in ticks; `None` beyond the end of a list.
    pub fn time(&self, _frame: u64) -> Option<i64> {
        todo!()
    }

    /// Returns the number of the frame whose time is nearest to a number of ticks.
    pub fn frame(&self, _time: i64) -> u64 {
        todo!()
    }

    /// Returns the number of the first frame that is shown at `seconds` after the first frame, or later.
    pub fn frame_at(&self, _seconds: f64) -> u64 {
        todo!()
    }
}

impl VideoReader {
    /// Starts to decode.
    ///
    /// # Errors
    /// When a frame is larger than permitted, the video is of a kind that cannot be read right (interlaced, or of a matrix that
    /// is no matrix), the frames asked for are not there, or ffmpeg cannot be run.
    pub fn open(_ffmpeg: &Ffmpeg, _info: &VideoInfo, _options: ReadOptions) -> Result<Self, VideoError> {
        todo!()
    }

    /// Returns the next frame; `None` after the last.
    ///
    /// # Errors
    /// When a frame is damaged or missing and neither held nor skipped, or there are fewer than the file announces.
    pub fn next_frame(&mut self) -> Result<Option<VideoFrame>, VideoError> {
        todo!()
    }

    /// Returns the frames so far that were held or skipped.
    pub fn faults(&self) -> &[Fault] {
        &self.faults
    }
}
