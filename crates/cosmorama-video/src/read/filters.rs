//! Filters by which ffmpeg makes RGB, each choice given in words: its own guesses differ between versions.

use std::ops::Range;

use cosmorama::raster::{Channels, Depth};

use super::ReadOptions;

use crate::colour::{Axis, Coding, Yuv420ToRgb};
use crate::ffmpeg::EXACT;
use crate::{ChromaPlace, Turn, VideoError, VideoInfo};

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
    /// Planes of YUV of 8 bits, with a quarter of the chroma samples. ffmpeg would convert them exactly, but slowly.
    Yuv420 { coding: Yuv420ToRgb, name: &'static str },
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
        let coding = |matrix, bits| Coding::new(matrix, info.range(), bits).ok_or_else(|| other_matrix(info));
        let pixels = match (is_deep, info.is_rgb, info.is_grey && !info.has_alpha) {
            (true, false, true) => Pixels::Grey(coding(GREY, bits)?),
            (true, false, false) if !info.is_grey => Pixels::Yuv(coding(info.matrix(), bits)?),
            _ => match yuv420(info) {
                Some(name) => {
                    Pixels::Yuv420 { coding: Yuv420ToRgb::new(&coding(info.matrix(), 8)?, place(info)), name }
                }
                None => Pixels::Rgb,
            },
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
            (Pixels::Yuv420 { name, .. }, ..) => name.to_owned(),
            (Pixels::Rgb, Depth::Eight, false) => "rgb24".to_owned(),
            (Pixels::Rgb, Depth::Eight, true) => "rgba".to_owned(),
            (Pixels::Rgb, _, false) => "rgb48le".to_owned(),
            (Pixels::Rgb, _, true) => "rgba64le".to_owned(),
            (Pixels::Yuv(_), _, false) => format!("yuv444p{}le", self.bits),
            (Pixels::Yuv(_), _, true) => format!("yuva444p{}le", self.bits),
            (Pixels::Grey(_), ..) => format!("gray{}le", self.bits),
        }
    }

    /// Returns the rows of a frame that ffmpeg is to give, if some are looked at: with those whose chroma is mixed in, in pairs.
    pub(super) fn rows(self, height: usize, looked_at: Option<&Range<usize>>) -> Range<usize> {
        const AROUND: usize = 4;
        match (self.pixels, looked_at) {
            (Pixels::Yuv420 { .. }, Some(Range { start, end })) if start < end => {
                let first = start.saturating_sub(AROUND) / 2 * 2;
                first..end.saturating_add(AROUND).next_multiple_of(2).min(height)
            }
            _ => 0..height,
        }
    }

    /// Returns the number of ffmpeg's samples in a frame.
    pub(super) fn samples(self, (width, height): (usize, usize)) -> u64 {
        let plane = |width: usize, height: usize| width as u64 * height as u64;
        match self.pixels {
            Pixels::Rgb | Pixels::Yuv(_) => plane(width, height) * self.channels.count() as u64,
            Pixels::Yuv420 { .. } => plane(width, height) + 2 * plane(width.div_ceil(2), height.div_ceil(2)),
            Pixels::Grey(_) => plane(width, height),
        }
    }
}

/// Returns ffmpeg's name of the planes of a video of 8 bits with a quarter of the chroma samples; `None` for others, and for frames that
/// are to be turned.
fn yuv420(info: &VideoInfo) -> Option<&'static str> {
    let is_upright = info.turn == Turn::default();
    ["yuv420p", "yuvj420p"].into_iter().find(|name| is_upright && *name == info.pixel_format)
}

/// Checks that a frame takes no more memory than it may.
pub(super) fn check_memory(info: &VideoInfo, options: &ReadOptions) -> Result<(), VideoError> {
    let (raw, (width, height)) = (Raw::of(info)?, info.size());
    // Planes are held beside the picture that is made of them.
    let planes = if raw.pixels == Pixels::Rgb { 0 } else { raw.samples((width, height)) };
    let pixels = width as u64 * height as u64 * raw.channels.count() as u64;
    let needed = u128::from(pixels + planes) * raw.depth.bytes() as u128;
    let limit = options.memory.min(isize::MAX as u64);
    if needed > u128::from(limit) {
        let size = (width as u64, height as u64);
        return Err(VideoError::TooLarge { name: info.path.display().to_string(), size, needed, limit });
    }
    Ok(())
}

/// Returns the place of a video's chroma samples.
fn place(info: &VideoInfo) -> ChromaPlace {
    info.colour.chroma.unwrap_or(ChromaPlace::Left)
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
pub(super) fn chain(
    info: &VideoInfo,
    (raw, rows): (Raw, &Range<usize>),
    from: Option<i64>,
) -> Result<String, VideoError> {
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
    if !matches!(raw.pixels, Pixels::Yuv420 { .. }) {
        filters.push(scale(info, raw)?);
    } else if rows.len() < info.size().1 {
        filters.push(format!("crop=iw:{}:0:{}:exact=1", rows.len(), rows.start));
    }
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
    let place = match place(info) {
        ChromaPlace::Centre => "",
        ChromaPlace::TopLeft => ":in_h_chr_pos=0:in_v_chr_pos=0",
        ChromaPlace::Left => ":in_h_chr_pos=0",
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
