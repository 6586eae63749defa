//! Filters by which ffmpeg makes RGB, each choice given in words: its own guesses differ between versions.

use cosmorama::raster::{Channels, Depth};

use crate::colour::Axis;
use crate::ffmpeg::EXACT;
use crate::{ChromaPlace, VideoError, VideoInfo};

/// Format of the frames that come out of ffmpeg.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Raw {
    pub(super) channels: Channels,
    pub(super) depth: Depth,
}

impl Raw {
    pub(super) fn of(info: &VideoInfo) -> Self {
        Self {
            channels: if info.has_alpha { Channels::Rgba } else { Channels::Rgb },
            depth: if info.bits > 8 { Depth::Sixteen } else { Depth::Eight },
        }
    }

    /// Returns ffmpeg's name.
    pub(super) fn name(self) -> &'static str {
        match (self.depth, self.channels.has_alpha()) {
            (Depth::Eight, false) => "rgb24",
            (Depth::Eight, true) => "rgba",
            (_, false) => "rgb48le",
            (_, true) => "rgba64le",
        }
    }
}

/// Returns the chain of filters: frames before the time `from` are dropped, each frame is told in the messages, made RGB, and
/// turned upright.
///
/// # Errors
/// When the video is interlaced, or its matrix is none of three weights.
pub(super) fn chain(info: &VideoInfo, from: Option<i64>) -> Result<String, VideoError> {
    if info.is_interlaced {
        let found = "its frames are interlaced: two moments in one".to_owned();
        let expected = "progressive frames, as from ffmpeg -vf bwdif".to_owned();
        return Err(VideoError::Unsupported { path: info.path.clone(), found, expected });
    }
    let mut filters = vec![format!("settb={}", info.time_base)];
    filters.extend(from.map(|time| format!("select='gte(pts,{time})'")));
    // The second prints frames that have a note, and so the first gives each of them one.
    filters.push("metadata=mode=add:key=c:value=1".to_owned());
    filters.push(r"metadata=mode=print:file=pipe\\:2:direct=1".to_owned());
    filters.push(scale(info)?);
    filters.push(format!("format={}", Raw::of(info).name()));
    // After the conversion: half of the chroma in a row would not be half in a column.
    filters.extend(info.turn.filters().into_iter().map(str::to_owned));
    Ok(filters.join(","))
}

fn scale(info: &VideoInfo) -> Result<String, VideoError> {
    if info.is_rgb {
        return Ok(format!("scale={EXACT}"));
    }
    let range = info.range().name();
    if info.is_grey {
        return Ok(format!("scale=in_range={range}:out_range=pc:{EXACT}"));
    }
    let matrix = match info.matrix() {
        1 => "bt709",
        4 => "fcc",
        5 => "bt470",
        6 => "smpte170m",
        7 => "smpte240m",
        9 => "bt2020",
        other => {
            let found = format!("its matrix from YUV to RGB is {}", Axis::Matrix.name(other));
            let expected = "BT.709, BT.601, BT.2020 with non-constant luminance, FCC or SMPTE 240M".to_owned();
            return Err(VideoError::Unsupported { path: info.path.clone(), found, expected });
        }
    };
    // The left place is that of ffmpeg itself.
    let place = match info.colour.chroma {
        Some(ChromaPlace::Centre) => ":in_h_chr_pos=128:in_v_chr_pos=128",
        Some(ChromaPlace::TopLeft) => ":in_h_chr_pos=0:in_v_chr_pos=0",
        Some(ChromaPlace::Left) | None => "",
    };
    Ok(format!("scale=in_color_matrix={matrix}:in_range={range}:out_range=pc{place}:{EXACT}"))
}
