use std::path::Path;

use super::writer::LONGEST;
use super::{Container, WriteSettings};
use crate::{Ffmpeg, MasteringDisplay, VideoError};

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

/// Encoder with its arguments and the format of its pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Encoder {
    pub(super) name: &'static str,
    pub(super) pixel_format: &'static str,
    pub(super) arguments: Vec<String>,
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

    /// Returns the codec that a container has unless another is chosen, for frames of more than 8 bits or of 8.
    pub fn usual(container: Container, is_deep: bool) -> Self {
        match container {
            Container::Mp4 if is_deep => Self::Hevc,
            _ => container.codecs()[0],
        }
    }

    /// Returns ffmpeg's encoders that make it, the best first.
    pub fn encoders(self) -> &'static [&'static str] {
        match self {
            Self::H264 => &["libx264"],
            Self::Hevc => &["libx265"],
            Self::ProRes => &["prores_ks"],
            Self::DnxHr => &["dnxhd"],
            Self::Ffv1 => &["ffv1"],
            Self::Av1 => &["libsvtav1", "libaom-av1"],
            Self::Vp9 => &["libvpx-vp9"],
        }
    }

    /// Returns whether the pixels are RGB, so that nothing is lost by a matrix.
    pub(super) fn is_rgb(self) -> bool {
        self == Self::Ffv1
    }

    /// Returns whether a video of this codec holds alpha.
    pub fn holds_alpha(self, is_deep: bool) -> bool {
        self.pixel_format(is_deep, true).is_some()
    }

    /// Returns the format of the pixels; `None` if the codec has no room for alpha.
    fn pixel_format(self, is_deep: bool, has_alpha: bool) -> Option<&'static str> {
        match (self, is_deep, has_alpha) {
            (Self::H264 | Self::Hevc | Self::Av1 | Self::Vp9, false, false) => Some("yuv420p"),
            (Self::H264 | Self::Hevc | Self::Av1 | Self::Vp9, true, false) => Some("yuv420p10le"),
            (Self::Vp9, false, true) => Some("yuva420p"),
            (Self::ProRes, _, false) => Some("yuv422p10le"),
            (Self::ProRes, _, true) => Some("yuva444p10le"),
            (Self::DnxHr, false, false) => Some("yuv422p"),
            (Self::DnxHr, true, false) => Some("yuv422p10le"),
            (Self::Ffv1, false, false) => Some("bgr0"),
            (Self::Ffv1, false, true) => Some("bgra"),
            (Self::Ffv1, true, false) => Some("gbrp16le"),
            (Self::Ffv1, true, true) => Some("gbrap16le"),
            _ => None,
        }
    }

    /// Chooses the codec of a container for these settings, and its encoder.
    pub(super) fn choose(
        ffmpeg: &Ffmpeg,
        path: &Path,
        container: Container,
        settings: &WriteSettings,
    ) -> Result<(Self, Encoder), VideoError> {
        let is_deep = settings.is_deep() || settings.colour.is_hdr();
        let usual = match container {
            Container::WebM if !Self::Vp9.is_in(ffmpeg.encoders()?) => Self::Av1,
            _ => Self::usual(container, is_deep),
        };
        let codec = settings.codec.unwrap_or(usual);
        let cannot =
            |found: String, expected: String| VideoError::CannotHold { path: path.to_owned(), found, expected };
        if !container.codecs().contains(&codec) {
            let found = format!("{} does not hold {}", container.name(), codec.name());
            return Err(cannot(found, names(container.codecs())));
        }
        let pixel_format = codec.pixel_format(is_deep, settings.has_alpha).ok_or_else(|| {
            let depth = if is_deep { "more than 8" } else { "8" };
            let able = container.codecs().iter().copied().filter(|able| able.holds_alpha(is_deep));
            let able = able.collect::<Vec<_>>();
            let able = if able.is_empty() { "frames without alpha, or .mov or .mkv".to_owned() } else { names(&able) };
            cannot(format!("{} holds no alpha with {depth} bits", codec.name()), able)
        })?;
        let known = ffmpeg.encoders()?;
        let there = codec.encoders().iter().copied().filter(|name| known.iter().any(|known| known == name));
        let there = there.collect::<Vec<_>>();
        if there.is_empty() {
            return Err(VideoError::NoEncoder {
                codec: codec.name(),
                needed: codec.encoders().join(" or "),
                existing: names(&Self::ALL.into_iter().filter(|codec| codec.is_in(known)).collect::<Vec<_>>()),
            });
        }
        let name = codec.encoder_of_size(&there, settings.size).map_err(|expected| VideoError::UnfitSize {
            path: path.to_owned(),
            codec: codec.name(),
            size: settings.size,
            expected,
        })?;
        let arguments = codec.arguments(name, container, settings, is_deep);
        Ok((codec, Encoder { name, pixel_format, arguments }))
    }

    fn is_in(self, known: &[String]) -> bool {
        self.encoders().iter().any(|name| known.iter().any(|known| known == name))
    }

    /// Returns the first of these encoders that takes frames of a size; the error says which sizes they take.
    fn encoder_of_size<'a>(self, encoders: &[&'a str], (width, height): (usize, usize)) -> Result<&'a str, String> {
        // Pixels share samples of chroma.
        let (columns, rows, even) = match self {
            Self::Ffv1 => (1, 1, ""),
            Self::ProRes | Self::DnxHr => (2, 1, "an even number of columns"),
            Self::H264 | Self::Hevc | Self::Av1 | Self::Vp9 => (2, 2, "even numbers of columns and rows"),
        };
        if !width.is_multiple_of(columns) || !height.is_multiple_of(rows) {
            return Err(format!("{even}, or FFV1 in .mkv"));
        }
        let takes = |encoder: &str| {
            let [least, most] = bounds(encoder);
            let is_between = (least.0..=most.0).contains(&width) && (least.1..=most.1).contains(&height);
            is_between && !is_too_thin(encoder, (width, height))
        };
        encoders.iter().copied().find(|encoder| takes(encoder)).ok_or_else(|| {
            let sizes = |encoder: &&str| {
                let [least, most] = bounds(encoder);
                let thin = format!("; with fewer than {THIN} columns or rows, {LONGEST_OF_THIN} of the other at most");
                let thin = if is_too_thin(encoder, (width, height)) { thin } else { String::new() };
                format!("{}x{} to {}x{}{thin}", least.0, least.1, most.0, most.1)
            };
            encoders.iter().map(sizes).collect::<Vec<_>>().join(" or ")
        })
    }

    fn arguments(self, encoder: &str, container: Container, settings: &WriteSettings, is_deep: bool) -> Vec<String> {
        let fixed: &[&str] = match (self, encoder) {
            (Self::H264, _) => &["-preset", "medium", "-crf", "16"],
            (Self::Hevc, _) => &["-preset", "medium", "-crf", "17"],
            (Self::ProRes, _) if settings.has_alpha => &["-profile:v", "4", "-vendor", "apl0"],
            (Self::ProRes, _) => &["-profile:v", "3", "-vendor", "apl0"],
            (Self::DnxHr, _) if is_deep => &["-profile:v", "dnxhr_hqx"],
            (Self::DnxHr, _) => &["-profile:v", "dnxhr_hq"],
            // The number of slices is fixed: otherwise it would follow from the machine's threads.
            (Self::Ffv1, _) => &["-level", "3", "-g", "1", "-slices", "16", "-slicecrc", "1"],
            (Self::Av1, "libsvtav1") => &["-preset", "8", "-crf", "24"],
            (Self::Av1, _) => &["-cpu-used", "6", "-row-mt", "1", "-crf", "24", "-b:v", "0"],
            (Self::Vp9, _) => &["-row-mt", "1", "-crf", "20", "-b:v", "0"],
        };
        let mut arguments = fixed.iter().map(|&argument| argument.to_owned()).collect::<Vec<_>>();
        if self == Self::Hevc {
            arguments.extend(["-x265-params".to_owned(), x265(settings)]);
            if container.has_boxes() {
                // The name by which Apple's players know it.
                arguments.extend(["-tag:v".to_owned(), "hvc1".to_owned()]);
            }
        }
        arguments
    }
}

/// Returns the least and the greatest size of frames that an encoder takes.
fn bounds(encoder: &str) -> [(usize, usize); 2] {
    match encoder {
        // Of VP9, in Debian's build, whose memory for frames ends there.
        "libx264" | "libvpx-vp9" => [(1, 1), (16384, 16384)],
        "libx265" => [(16, 16), (LONGEST, LONGEST)],
        // The decoder of ffmpeg takes no more rows than that.
        "dnxhd" => [(256, 120), (LONGEST, 8192)],
        // Each of its 4 × 4 slices has a pixel, then.
        "ffv1" => [(4, 4), (LONGEST, LONGEST)],
        "libsvtav1" => [(64, 64), (16384, 8704)],
        _ => [(1, 1), (LONGEST, LONGEST)],
    }
}

/// Columns or rows below which x265 codes in blocks of 16 pixels.
const THIN: usize = 32;

/// Greatest length of a side beside one so short: beyond it begins level 5 of H.265, which has no such blocks.
const LONGEST_OF_THIN: usize = 4216;

/// Returns whether an encoder refuses frames of this size because they are thin, though each side is within its bounds.
fn is_too_thin(encoder: &str, (width, height): (usize, usize)) -> bool {
    encoder == "libx265" && width.min(height) < THIN && width.max(height) > LONGEST_OF_THIN
}

/// Returns the parameters of x265: it alone writes the messages of HDR10 into the stream.
fn x265(settings: &WriteSettings) -> String {
    const PQ: u8 = 16;
    let mut parameters = vec!["log-level=error".to_owned()];
    if settings.colour.transfer == Some(PQ) {
        parameters.push("hdr10=1:repeat-headers=1".to_owned());
    }
    if let Some(MasteringDisplay { red, green, blue, white, brightest, darkest }) = settings.hdr.mastering {
        let pair = |name: &str, [x, y]: [u16; 2]| format!("{name}({x},{y})");
        let colours = [pair("G", green), pair("B", blue), pair("R", red), pair("WP", white)].concat();
        parameters.push(format!("master-display={colours}L({brightest},{darkest})"));
    }
    if let Some(light) = settings.hdr.light {
        parameters.push(format!("max-cll={},{}", light.brightest, light.mean));
    }
    parameters.join(":")
}

fn names(codecs: &[Codec]) -> String {
    codecs.iter().map(|codec| codec.name()).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_container_has_a_codec_and_every_codec_a_name() {
        for codec in Codec::ALL {
            assert_eq!(Codec::of_name(codec.name()), Some(codec));
            assert!(codec.pixel_format(true, false).is_some() && codec.pixel_format(false, false).is_some());
        }
        assert_eq!(Codec::of_name("H264"), None);
    }

    #[test]
    fn an_encoder_is_one_that_takes_the_size() {
        let found = |codec: Codec, size| codec.encoder_of_size(codec.encoders(), size);
        assert!(found(Codec::H264, (3, 2)).is_err() && found(Codec::ProRes, (2, 3)).is_ok());
        assert_eq!(found(Codec::Ffv1, (5, 7)), Ok("ffv1"));
        assert_eq!(found(Codec::Av1, (64, 8704)), Ok("libsvtav1"));
        assert_eq!(found(Codec::Av1, (62, 64)), Ok("libaom-av1"));
        assert_eq!(found(Codec::Av1, (64, 8706)), Ok("libaom-av1"));
        assert_eq!(Codec::Av1.encoder_of_size(&["libsvtav1"], (62, 64)), Err("64x64 to 16384x8704".to_owned()));
        for (codec, least, most) in [
            (Codec::DnxHr, (256, 120), (LONGEST, 8192)),
            (Codec::Hevc, (16, 16), (LONGEST, LONGEST)),
            (Codec::H264, (2, 2), (16384, 16384)),
            (Codec::Vp9, (2, 2), (16384, 16384)),
        ] {
            assert!(found(codec, least).is_ok() && found(codec, most).is_ok(), "{codec:?}");
            assert!(found(codec, (least.0 - 2, most.1)).is_err() && found(codec, (most.0 + 2, least.1)).is_err());
        }
        for fits in [(4216, 16), (30, 4216), (65534, 32), (32, 65534)] {
            assert!(found(Codec::Hevc, fits).is_ok(), "{fits:?}");
        }
        for thin in [(4218, 16), (16, 4218), (4218, 30), (30, 65534)] {
            assert!(found(Codec::Hevc, thin).unwrap_err().contains("4216 of the other"), "{thin:?}");
        }
        assert!(found(Codec::DnxHr, (256, 119)).is_err() && found(Codec::DnxHr, (256, 8193)).is_err());
        assert!(found(Codec::ProRes, (LONGEST + 2, 16)).is_err() && found(Codec::DnxHr, (254, 120)).is_err());
    }
}
