//! Properties of a video file, as ffprobe and the file's own structure tell them.

mod avi;
mod beginning;
mod container;
mod document;
mod first_frame;
mod packets;
mod pixel_format;
mod stream;
mod structure;
mod timeline;
mod turn;

use std::path::PathBuf;

pub(crate) use avi::{Places, Uncounted};
pub(crate) use container::{AVI, GIF, is_boxes};
use packets::CodedStream;
pub(crate) use packets::{CodedFrame, shown_times};
pub use timeline::Timeline;
pub use turn::Turn;

use crate::{ColourTags, HdrTags, Labels, Ratio, SignalRange, SpatialTags};

/// Properties of a video file, without its pictures.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct VideoInfo {
    /// The file.
    pub path: PathBuf,
    /// Names of the container format, as ffprobe says them, such as `mov,mp4,m4a,3gp,3g2,mj2`.
    pub container: String,
    /// Number of the stream among all streams: the first that is video and no cover picture.
    pub stream: u32,
    /// Name of the codec, such as `h264`.
    pub codec: String,
    /// Columns and rows as they are coded.
    pub coded_size: (usize, usize),
    /// Turn that makes coded pictures upright. [`VideoReader`](crate::VideoReader) does it.
    pub turn: Turn,
    /// Width of a pixel by its height, upright; 1 if nothing is said.
    pub pixel_aspect: Ratio,
    /// Frames a second: those that the stream says, or their mean where the rate varies.
    pub rate: Ratio,
    /// Whether the rate varies, so that frames have times of their own ([`Ffmpeg::timeline`](crate::Ffmpeg::timeline)).
    pub is_variable: bool,
    /// Seconds a tick of the stream's clock.
    pub time_base: Ratio,
    /// Time of the first frame in ticks.
    pub start: i64,
    /// Seconds that the video lasts, if it says so.
    pub duration: Option<f64>,
    /// Number of frames that the file announces; `None` if it announces none, as streams do.
    pub announced: Option<Announced>,
    /// Format of the coded pixels, such as `yuv420p10le`.
    pub pixel_format: String,
    /// Significant bits of a sample.
    pub bits: u32,
    /// Whether the pixels have an alpha.
    pub has_alpha: bool,
    /// Whether the pixels are grey.
    pub is_grey: bool,
    /// Whether the pixels are coded as RGB, so that no matrix applies.
    pub is_rgb: bool,
    /// Whether the frames are interlaced, or may be.
    pub is_interlaced: bool,
    /// Colour tags, as they are in the file.
    pub colour: ColourTags,
    /// Mastering display and light levels.
    pub hdr: HdrTags,
    /// Tags of spherical video.
    pub spatial: Option<SpatialTags>,
    /// Language, title and roles of the video.
    pub labels: Labels,
    /// Streams beside the video: sound, subtitles, data.
    pub others: Vec<OtherStream>,
    /// Number of chapters.
    pub chapters: usize,
    /// Time code of the first frame, such as `01:00:00:00`.
    pub timecode: Option<String>,
    /// Names and values of the file's own metadata, such as its title.
    pub metadata: Vec<(String, String)>,
    /// Frames at the beginning that are left out: they took after others, which were cut off.
    pub left_out: u64,
    /// Places for frames of its rate that are empty, of the first hundred, where a Matroska leaves few: its encoder left frames out, or they are
    /// lost. Its rate varies then.
    pub empty_places: Vec<u64>,
    /// Bytes that the file lacks by its own account.
    pub cut: Option<CutShort>,
    /// Seconds at which the file begins, from which ffmpeg counts when it seeks, by the times of the frames.
    pub(crate) file_start: f64,
    /// Frames at the beginning that take after others before them, which were cut off; decoders make them up, or give none.
    pub(crate) early: u64,
    /// Coded frames, behind the key frame with which the stream begins, that would be shown before the first one that is.
    pub(crate) leading: u64,
    /// Whether some of its first frames are not shown, as an edit list tells.
    pub(crate) hides: bool,
    /// Whether it is H.264 that begins with a key frame of an open group: frames behind it may name others before it, which were cut off.
    pub(crate) is_open: bool,
    /// Frames that a decoder keeps back, to give them in the order in which they are shown.
    pub(crate) delay: u64,
    /// Statements about the file that a user should hear, such as "no matrix is said; taken for BT.709"; a sentence each.
    pub notes: Vec<String>,
}

impl VideoInfo {
    /// Returns the columns and rows of the upright pictures.
    pub fn size(&self) -> (usize, usize) {
        let (width, height) = self.coded_size;
        if self.turn.is_transposed { (height, width) } else { (width, height) }
    }

    /// Returns the number of the matrix by which pictures are read: the file's, or else BT.709 for pictures of more than 1024
    /// columns or 576 rows, and BT.601 for others.
    pub fn matrix(&self) -> u8 {
        let (width, height) = self.coded_size;
        let usual = if width > 1024 || height > 576 { 1 } else { 6 };
        self.colour.matrix.unwrap_or(if self.is_rgb { 0 } else { usual })
    }

    /// Returns whether the video is a bare stream, of which no frame has a time.
    pub(crate) fn is_bare(&self) -> bool {
        container::is_bare(&self.container, &self.codec)
    }

    /// Returns the options of ffmpeg and ffprobe to read it.
    pub(crate) fn input_options(&self) -> &'static [&'static str] {
        CodedStream::of(self).input_options()
    }

    /// Returns the range by which pictures are read: the file's, or else full for RGB and the formats of JPEG, and narrow for
    /// others.
    pub fn range(&self) -> SignalRange {
        let is_full = self.is_rgb || self.pixel_format.starts_with("yuvj");
        self.colour.range.unwrap_or(if is_full { SignalRange::Full } else { SignalRange::Narrow })
    }
}

/// Number of frames that a file announces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Announced {
    /// Number of frames.
    pub frames: u64,
    /// Statement by which it is known.
    pub by: AnnouncedBy,
}

/// Statement of a file by which its number of frames is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AnnouncedBy {
    /// The file's own count.
    Count,
    /// The duration of its video, times a constant rate.
    Duration,
}

/// Finding that a file ends before its own structure does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CutShort {
    /// Bytes that the file should have at least.
    pub expected: u64,
    /// Bytes that it has.
    pub found: u64,
}

/// Stream beside the video.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OtherStream {
    /// Number among all streams.
    pub index: u32,
    /// Kind.
    pub kind: StreamKind,
    /// Name of the codec, or, of data, the container's code for it; empty if none is known.
    pub codec: String,
    /// Language, title and roles.
    pub labels: Labels,
    /// Number of sound channels; 0 for others.
    pub channels: u32,
}

/// Kind of a stream beside the video.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StreamKind {
    /// Sound.
    Audio,
    /// Subtitles.
    Subtitle,
    /// A further video, or a cover picture.
    Video,
    /// File beside them, such as a font of subtitles.
    Attachment,
    /// Time code.
    TimeCode,
    /// Other data.
    Data,
}

impl StreamKind {
    /// Returns the kind by ffprobe's name.
    pub(crate) fn of(name: &str) -> Self {
        match name {
            "audio" => Self::Audio,
            "subtitle" => Self::Subtitle,
            "video" => Self::Video,
            "attachment" => Self::Attachment,
            _ => Self::Data,
        }
    }

    /// Returns a word for the kind.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Audio => "sound",
            Self::Subtitle => "subtitles",
            Self::Video => "video",
            Self::Attachment => "attached file",
            Self::TimeCode => "time code",
            Self::Data => "data",
        }
    }
}
