//! Videos made of frames, whole or not at all.

mod arguments;
mod carried;
mod codec;
mod command;
mod container;
mod feed;
mod labels;
mod timecode;
mod verify;
mod writer;

use std::ops::Range;
use std::path::PathBuf;

use cosmorama::raster::Depth;

pub use codec::Codec;
pub use container::Container;
pub use writer::VideoWriter;

use crate::{ColourTags, HdrTags, Ratio, SpatialTags, VideoInfo};

/// Choices for writing a video.
#[derive(Clone, Debug)]
pub struct WriteSettings {
    /// Columns and rows.
    pub size: (usize, usize),
    /// Times of the frames.
    pub times: FrameTimes,
    /// Depth of the frames that will be given; 8 bits, or integers of 16.
    pub depth: Depth,
    /// Whether frames have an alpha that is to be kept.
    pub has_alpha: bool,
    /// Colour tags. Where matrix or range are `None`, they follow from the primaries: BT.2020's, or else BT.709's, and narrow.
    pub colour: ColourTags,
    /// Mastering display and light levels.
    pub hdr: HdrTags,
    /// Tags of spherical video.
    pub spatial: Option<SpatialTags>,
    /// Codec; `None` for the usual one of the container.
    pub codec: Option<Codec>,
    /// Further arguments of ffmpeg, put before the output's name: options with their values.
    pub arguments: Vec<String>,
    /// Video whose sound, subtitles, chapters, time code and metadata are copied.
    pub source: Option<Carried>,
    /// Number of frames that will be given, if it is known; [`VideoWriter::finish`] then fails for any other.
    pub frames: Option<u64>,
    /// Threads of the encoder; 0 for as many as ffmpeg thinks right.
    pub threads: usize,
}

impl WriteSettings {
    /// Creates the settings of a video of this size and constant rate, of 8 bits, with the tags of BT.709.
    pub fn new(size: (usize, usize), rate: Ratio) -> Self {
        let colour = ColourTags { primaries: Some(1), transfer: Some(1), ..ColourTags::default() };
        Self {
            size,
            times: FrameTimes::Even { rate },
            depth: Depth::Eight,
            has_alpha: false,
            colour,
            hdr: HdrTags::default(),
            spatial: None,
            codec: None,
            arguments: Vec::new(),
            source: None,
            frames: None,
            threads: 0,
        }
    }
}

impl WriteSettings {
    /// Returns whether frames have more than 8 bits.
    fn is_deep(&self) -> bool {
        self.depth != Depth::Eight
    }

    /// Returns the rate, or its mean.
    fn rate(&self) -> Ratio {
        match self.times {
            FrameTimes::Even { rate } | FrameTimes::Stamps { rate, .. } => rate,
        }
    }

    /// Returns the unit of frames' times: a frame, where the rate is constant.
    fn tick(&self) -> Ratio {
        match self.times {
            FrameTimes::Even { rate } => rate.inverse(),
            FrameTimes::Stamps { time_base, .. } => time_base,
        }
    }
}

/// Times of the frames of a video to write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameTimes {
    /// A constant rate.
    Even {
        /// Frames a second.
        rate: Ratio,
    },
    /// A time for each frame, given with it.
    Stamps {
        /// Seconds a tick.
        time_base: Ratio,
        /// Mean of the frames a second, for the encoder's decisions.
        rate: Ratio,
    },
}

/// Video of which all but the pictures is copied.
#[derive(Clone, Debug)]
pub struct Carried {
    /// The video.
    pub info: VideoInfo,
    /// Seconds of it that the new video shows, from its first frame on; `None` for all.
    pub seconds: Option<Range<f64>>,
}

/// Account of a video that was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// The file.
    pub path: PathBuf,
    /// Frames in it.
    pub frames: u64,
    /// Name of the encoder.
    pub encoder: String,
    /// Statements on what the container or codec cannot hold, a sentence each.
    pub notes: Vec<String>,
}
