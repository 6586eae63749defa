use std::fmt::Debug;
use std::io::BufRead;
use std::path::{Path, PathBuf};

use cosmorama::raster::{Channels, Depth, Primaries, Transfer};
use cosmorama_io::{Format, IoError};
use cosmorama_spec::{FrameRate, Spec};

/// Settings of videos, read and made.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct VideoSettings {
    /// Frames a second of a video that is made; those of the first input that is a video, or 30, unless given.
    pub rate: Option<FrameRate>,
    /// Name of the codec's preset; the usual one of the container, unless given.
    pub codec: Option<String>,
    /// Further arguments of ffmpeg, before the output's name.
    pub arguments: Vec<String>,
    /// Answer to damaged frames of an input.
    pub damaged: DamagedFrames,
}

/// Answer to a frame of a video that is damaged or missing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DamagedFrames {
    /// An error that names the frame.
    #[default]
    Error,
    /// The frame before is shown again, with a warning.
    Hold,
    /// There is no such frame in the output, with a warning.
    Skip,
}

impl DamagedFrames {
    /// Returns whether outputs may be made of frames with such damage.
    pub(crate) fn accepts(self, damage: FrameDamage) -> bool {
        match self {
            Self::Error => false,
            Self::Hold => true,
            Self::Skip => damage == FrameDamage::Traces,
        }
    }
}

/// Difference of a video's frame from what it should be, from the least to the greatest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum FrameDamage {
    /// It takes after a damaged one, and may show traces of it.
    Traces,
    /// Another one stands in its place.
    Held,
}

/// Plan of the videos that a conversion makes.
#[derive(Clone, Debug)]
pub(crate) struct VideoPlan {
    /// Settings.
    pub(crate) settings: VideoSettings,
    /// Projection of the pictures.
    pub(crate) to: Option<Spec>,
    /// Sample type.
    pub(crate) depth: Depth,
    /// Channels.
    pub(crate) channels: Channels,
    /// Transfer function.
    pub(crate) transfer: Transfer,
    /// Primaries.
    pub(crate) primaries: Primaries,
    /// Number of frames; `None` while the input's end is not known.
    pub(crate) frames: Option<u64>,
    /// Input whose sound and rate the videos take over.
    pub(crate) source: Option<VideoSource>,
}

/// Video among the inputs, with the frames of it that are shown.
#[derive(Clone, Debug)]
pub(crate) struct VideoSource {
    /// File.
    pub(crate) video: PathBuf,
    /// Numbers of the frames, in the order of the output.
    pub(crate) frames: Vec<u64>,
}

/// Kind of a stream of raw pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RawKind {
    /// YUV4MPEG2.
    Y4m,
    /// PGM, PPM or PAM.
    Pam,
    /// Portable float maps.
    Pfm,
}

impl RawKind {
    /// Returns the kind of a file, by its extension; `None` for other files.
    pub(crate) fn of(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        match extension.as_str() {
            "y4m" => Some(Self::Y4m),
            "pam" => Some(Self::Pam),
            "pfm" => Some(Self::Pfm),
            _ => None,
        }
    }

    /// Returns the format of its pictures.
    pub(crate) fn format(self) -> Format {
        match self {
            Self::Y4m | Self::Pam => Format::Video,
            Self::Pfm => Format::Pfm,
        }
    }
}

/// Source of the bytes of streams.
pub(crate) trait RawFiles: Debug + Send + Sync {
    /// Opens a stream.
    fn open(&self, path: &Path) -> Result<RawBytes, IoError>;
}

/// Bytes of a stream.
pub(crate) enum RawBytes {
    /// As often as they are asked for.
    Kept(Box<dyn BufRead + Send>),
    /// Once, as they come.
    Live(Box<dyn BufRead + Send>),
}

/// Arrival of a frame of a stream that is read as it comes. Frames of other videos are there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Coming {
    /// It can be read at once, or there is an error to tell of.
    Here,
    /// It has not come yet.
    Later,
    /// The stream has ended before it.
    Never,
}
