use std::path::Path;

use super::Codec;

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

    /// Returns the codecs that it holds, the usual one first.
    pub fn codecs(self) -> &'static [Codec] {
        match self {
            Self::Mp4 => &[Codec::H264, Codec::Hevc, Codec::Av1, Codec::Vp9],
            Self::Mov => &[Codec::ProRes, Codec::DnxHr, Codec::H264, Codec::Hevc],
            Self::Matroska => {
                &[Codec::Ffv1, Codec::H264, Codec::Hevc, Codec::ProRes, Codec::DnxHr, Codec::Av1, Codec::Vp9]
            }
            Self::WebM => &[Codec::Vp9, Codec::Av1],
        }
    }

    /// Returns ffmpeg's name.
    pub(super) fn muxer(self) -> &'static str {
        match self {
            Self::Mp4 => "mp4",
            Self::Mov => "mov",
            Self::Matroska => "matroska",
            Self::WebM => "webm",
        }
    }

    /// Returns the name that users know.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Mp4 => "MP4",
            Self::Mov => "MOV",
            Self::Matroska => "Matroska",
            Self::WebM => "WebM",
        }
    }

    /// Returns whether spherical tags are boxes.
    pub(super) fn has_boxes(self) -> bool {
        matches!(self, Self::Mp4 | Self::Mov)
    }
}
