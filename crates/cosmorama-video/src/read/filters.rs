//! Filters by which ffmpeg makes RGB, each choice given in words: its own guesses differ between versions.

use cosmorama::raster::{Channels, Depth};

use crate::colour::{Axis, Coding};
use crate::ffmpeg::EXACT;
use crate::{ChromaPlace, VideoError, VideoInfo};

/// Format of the frames that come out of ffmpeg, and what becomes of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Raw {
    pub(super) channels: Channels,
    pub(super) depth: Depth,
    pub(super) pixels: Pixels,
    /// Bits of ffmpeg's samples.
    bits: u32,
}

/// Kind of the pixels that come out of ffmpeg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Pixels {
    /// RGB, as it is given on.
    Rgb,
    /// Planes of YUV of more than 8 bits, with all chroma samples. ffmpeg would convert them with errors of the size of a code of 8 bits.
    Yuv(Coding),
    /// A plane of grey of more than 8 bits.
    Grey(Coding),
}

impl Raw {
    /// Returns the format for a video.
    ///
    /// # Errors
    /// When its matrix is none of three weights.
    pub(super) fn of(info: &VideoInfo) -> Result<Self, VideoError> {
        let is_deep = info.bits > 8;
        // Formats with alpha have no 9 and 14 bits.
        let bits = match info.bits {
            ..=10 => 10,
            11 | 12 => 12,
            _ => 16,
        };
        let coding = |matrix| Coding::new(matrix, info.range(), bits).ok_or_else(|| other_matrix(info));
        let pixels = match (is_deep, info.is_rgb, info.is_grey && !info.has_alpha) {
            (true, false, true) => Pixels::Grey(coding(GREY)?),
            (true, false, false) if !info.is_grey => Pixels::Yuv(coding(info.matrix())?),
            _ => Pixels::Rgb,
        };
        Ok(Self {
            channels: if info.has_alpha { Channels::Rgba } else { Channels::Rgb },
            depth: if is_deep { Depth::Sixteen } else { Depth::Eight },
            pixels,
            bits,
        })
    }

    /// Returns ffmpeg's name.
    pub(super) fn name(self) -> String {
        match (self.pixels, self.depth, self.channels.has_alpha()) {
            (Pixels::Rgb, Depth::Eight, false) => "rgb24".to_owned(),
            (Pixels::Rgb, Depth::Eight, true) => "rgba".to_owned(),
            (Pixels::Rgb, _, false) => "rgb48le".to_owned(),
            (Pixels::Rgb, _, true) => "rgba64le".to_owned(),
            (Pixels::Yuv(_), _, false) => format!("yuv444p{}le", self.bits),
            (Pixels::Yuv(_), _, true) => format!("yuva444p{}le", self.bits),
            (Pixels::Grey(_), ..) => format!("gray{}le", self.bits),
        }
    }

    /// Returns the number of ffmpeg's samples in a pixel.
    pub(super) fn samples(self) -> usize {
        match self.pixels {
            Pixels::Rgb | Pixels::Yuv(_) => self.channels.count(),
            Pixels::Grey(_) => 1,
        }
    }
}

/// Matrix for grey, which has none: any.
const GREY: u8 = 1;

fn other_matrix(info: &VideoInfo) -> VideoError {
    let found = format!("its matrix from YUV to RGB is {}", Axis::Matrix.name(info.matrix()));
    let expected = "BT.709, BT.601, BT.2020 with non-constant luminance, FCC or SMPTE 240M".to_owned();
    VideoError::Unsupported { path: info.path.clone(), found, expected }
}

/// Returns the chain of filters: frames before the time `from` are dropped, each frame is told in the messages, made RGB, and
/// turned upright.
///
/// # Errors
/// When the video is interlaced, or its matrix is none of three weights.
pub(super) fn chain(info: &VideoInfo, raw: Raw, from: Option<i64>) -> Result<String, VideoError> {
    if info.is_interlaced {
        let found = "its frames are interlaced: two moments in one".to_owned();
        let expected = "progressive frames, as from ffmpeg -vf bwdif".to_owned();
        return Err(VideoError::Unsupported { path: info.path.clone(), found, expected });
    }
    let mut filters = vec![format!("settb={}", info.time_base)];
    filters.extend(from.map(|time| format!("select='gte(pts,{time})'")));
    // Files may bring notes of their own, which would be printed, too, and look like anything.
    filters.push("metadata=mode=delete".to_owned());
    // The second prints frames that have a note, and so the first gives each of them one.
    filters.push("metadata=mode=add:key=c:value=1".to_owned());
    filters.push(r"metadata=mode=print:file=pipe\\:2:direct=1".to_owned());
    filters.push(scale(info, raw)?);
    filters.push(format!("format={}", raw.name()));
    // After the conversion: half of the chroma in a row would not be half in a column.
    filters.extend(info.turn.filters().into_iter().map(str::to_owned));
    Ok(filters.join(","))
}

fn scale(info: &VideoInfo, raw: Raw) -> Result<String, VideoError> {
    if info.is_rgb {
        return Ok(format!("scale={EXACT}"));
    }
    let range = info.range().name();
    // ffmpeg itself takes the middle of two columns, whatever the tag. A place between rows would also move planes that have all rows.
    let place = match info.colour.chroma {
        Some(ChromaPlace::Centre) => "",
        Some(ChromaPlace::TopLeft) => ":in_h_chr_pos=0:in_v_chr_pos=0",
        Some(ChromaPlace::Left) | None => ":in_h_chr_pos=0",
    };
    if raw.pixels != Pixels::Rgb {
        return Ok(format!("scale=in_range={range}:out_range={range}{place}:{EXACT}"));
    }
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
        _ => return Err(other_matrix(info)),
    };
    Ok(format!("scale=in_color_matrix={matrix}:in_range={range}:out_range=pc{place}:{EXACT}"))
}
