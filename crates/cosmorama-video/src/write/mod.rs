//! Videos made of frames, whole or not at all.

use std::ops::Range;
use std::path::{Path, PathBuf};

use cosmorama::raster::{Depth, EncodedImage};
use cosmorama_io::pending::Unfinished;

use crate::{ColourTags, Ffmpeg, HdrTags, Ratio, SpatialTags, VideoError, VideoInfo};

/// Video in progress. Dropped without [`VideoWriter::finish`], it ends its ffmpeg and leaves nothing behind.
#[derive(Debug)]
pub struct VideoWriter {}

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
    /// Further arguments of ffmpeg, put before the output's name.
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

/// Codec by the name of its preset.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Codec {
    /// H.264 by x264.
    H264,
    /// HEVC by x265.
    Hevc,
    /// ProRes 422 HQ, or 4444 with alpha.
    ProRes,
    /// DNxHR HQ, or HQX for more than 8 bits.
    DnxHr,
    /// FFV1, without loss.
    Ffv1,
    /// AV1 by SVT-AV1 or libaom.
    Av1,
    /// VP9 by libvpx.
    Vp9,
}

impl Codec {
    /// All presets.
    pub const ALL: [Self; 7] = [Self::H264, Self::Hevc, Self::ProRes, Self::DnxHr, Self::Ffv1, Self::Av1, Self::Vp9];

    /// Returns the name of the preset.
    pub const fn name(self) -> &'static str {
        match self {
            Self::H264 => "h264",
            Self::Hevc => "hevc",
            Self::ProRes => "prores",
            Self::DnxHr => "dnxhr",
            Self::Ffv1 => "ffv1",
            Self::Av1 => "av1",
            Self::Vp9 => "vp9",
        }
    }

    /// Returns the codec of a name; `None` if none is called so.
    pub fn of_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|codec| codec.name() == name)
    }
}

/// Container format of a video to write.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Container {
    /// MP4: `.mp4`, `.m4v`.
    Mp4,
    /// QuickTime: `.mov`.
    Mov,
    /// Matroska: `.mkv`.
    Matroska,
    /// WebM: `.webm`.
    WebM,
}

impl Container {
    /// Returns the container of a file's extension; `None` if that is no video's.
    pub fn of_path(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        match extension.as_str() {
            "mp4" | "m4v" => Some(Self::Mp4),
            "mov" => Some(Self::Mov),
            "mkv" => Some(Self::Matroska),
            "webm" => Some(Self::WebM),
            _ => None,
        }
    }
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

impl VideoWriter {
    /// Starts to encode, under a temporary name in the output's folder.
    ///
    /// # Errors
    /// When the extension or the settings fit no codec, the encoder is missing in this build of ffmpeg, or nothing can be
    /// written there.
    pub fn create(
        _ffmpeg: &Ffmpeg,
        _path: &Path,
        _settings: WriteSettings,
        _unfinished: &Unfinished,
    ) -> Result<Self, VideoError> {
        todo!()
    }

    /// Gives the next frame. `time` is its time in ticks for [`FrameTimes::Stamps`], and `None` for a constant rate.
    ///
    /// # Errors
    /// When the frame is of another size, depth or kind than the settings say, times do not increase, or ffmpeg has failed.
    pub fn write(&mut self, _frame: &EncodedImage, _time: Option<i64>) -> Result<(), VideoError> {
        todo!()
    }

    /// Waits for the encoder, checks that all frames arrived, adds spherical tags, and gives the file its name.
    ///
    /// # Errors
    /// When ffmpeg fails, frames are missing in what it wrote, or the file cannot be finished. Nothing is left behind then.
    pub fn finish(self) -> Result<Written, VideoError> {
        todo!()
    }
}
