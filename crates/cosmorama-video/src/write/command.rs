//! Command by which ffmpeg encodes.

use std::path::Path;
use std::process::{Command, Stdio};

use cosmorama::raster::Depth;

use super::carried::Plan;
use super::codec::Encoder;
use super::feed::{Planes, RawFormat};
use super::{Codec, Container, WriteSettings};
use crate::colour::{Coding, RgbToYuv420};
use crate::ffmpeg::{EXACT, Log, url};
use crate::{ColourTags, Ffmpeg, SignalRange};

/// Parts of a command.
pub(super) struct Parts<'a> {
    pub(super) settings: &'a WriteSettings,
    pub(super) container: Container,
    pub(super) codec: Codec,
    pub(super) encoder: &'a Encoder,
    pub(super) plan: &'a Plan,
    pub(super) output: &'a Path,
}

impl Parts<'_> {
    pub(super) fn command(&self, ffmpeg: &Ffmpeg) -> Command {
        let Parts { settings, container, encoder, plan, .. } = self;
        let tick = settings.tick();
        let mut command = ffmpeg.ffmpeg_command();
        command.args(Log::OPTIONS).arg("-y");
        // The header says all: no frame is kept in memory to find out more, and few are while others are encoded.
        command.args(["-probesize", "32", "-analyzeduration", "0", "-fpsprobesize", "0", "-thread_queue_size", "2"]);
        command.args(["-f", "matroska", "-i", "pipe:0"]).args(&plan.input);
        command.args(["-map", "0:v:0", "-vf", &self.filters()]).args(ffmpeg.every_frame_once());
        // Of the pictures alone: sound that is coded anew counts samples, and would end with the first.
        command.args(["-enc_time_base:v", &format!("{}:{}", tick.numerator(), tick.denominator())]);
        command.args(["-c:v", encoder.name]).args(&encoder.arguments);
        if settings.threads > 0 {
            command.args(["-threads:v", &settings.threads.to_string()]);
        }
        command.args(self.tags()).args(&plan.output);
        // Sound waits for the first frame, however long that takes.
        command.args(["-max_muxing_queue_size", "1000000", "-fflags", "+bitexact"]);
        if container.has_boxes() {
            command.args(["-movflags", "+write_colr"]);
            if tick.numerator() == 1 {
                command.args(["-video_track_timescale", &tick.denominator().to_string()]);
            }
        }
        command.args(&settings.arguments).args(["-f", container.muxer()]).arg(url(self.output));
        command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
        command
    }

    fn filters(&self) -> String {
        let (tick, tags) = (self.settings.tick(), self.colour());
        let range = tags.range.unwrap_or(SignalRange::Narrow).name();
        let scale = if self.codec.is_rgb() {
            format!("scale={EXACT}")
        } else if matches!(self.planes(), Some(Planes::Yuv420(_))) {
            "null".to_owned()
        } else if self.planes().is_some() {
            // The matrix is applied before; only chroma samples become fewer.
            format!("scale=in_range={range}:out_range={range}:{LEFT}:{EXACT}")
        } else {
            let matrix = match tags.matrix {
                Some(9) => "bt2020",
                Some(5 | 6) => "smpte170m",
                Some(7) => "smpte240m",
                Some(4) => "fcc",
                _ => "bt709",
            };
            format!("scale=in_range=pc:out_color_matrix={matrix}:out_range={range}:{LEFT}:{EXACT}")
        };
        format!("settb={tick},{scale},format={},setparams={}", self.encoder.pixel_format, parameters(&tags).join(":"))
    }

    /// Returns the format in which ffmpeg gets frames.
    pub(super) fn format(&self) -> RawFormat {
        RawFormat { depth: self.settings.depth, has_alpha: self.settings.has_alpha, planes: self.planes() }
    }

    /// Returns the planes that frames become before ffmpeg gets them; `None` where it gets RGB.
    fn planes(&self) -> Option<Planes> {
        let tags = self.colour();
        let coding = |bits| Coding::new(tags.matrix?, tags.range.unwrap_or(SignalRange::Narrow), bits);
        match self.encoder.pixel_format {
            "yuv420p" if self.settings.depth == Depth::Eight => Some(Planes::Yuv420(RgbToYuv420::new(&coding(8)?))),
            name if name.ends_with("10le") => coding(10).map(Planes::Deep),
            _ => None,
        }
    }

    /// Returns the colour tags, with matrix and range chosen.
    pub(super) fn colour(&self) -> ColourTags {
        const BT2020: u8 = 9;
        const RGB: u8 = 0;
        let tags = self.settings.colour;
        if self.codec.is_rgb() {
            return ColourTags { matrix: Some(RGB), range: Some(SignalRange::Full), ..tags };
        }
        let usual = if tags.primaries == Some(BT2020) { BT2020 } else { 1 };
        let matrix = tags.matrix.filter(|matrix| matches!(matrix, 1 | 4 | 5 | 6 | 7 | 9)).unwrap_or(usual);
        ColourTags { matrix: Some(matrix), range: Some(tags.range.unwrap_or(SignalRange::Narrow)), ..tags }
    }

    fn tags(&self) -> Vec<String> {
        let tags = self.colour();
        let number = |name: &str, number: Option<u8>| {
            number.map(|number| [name.to_owned(), number.to_string()]).into_iter().flatten().collect::<Vec<_>>()
        };
        let range = tags.range.map_or_else(Vec::new, |range| vec!["-color_range".to_owned(), range.name().to_owned()]);
        [
            number("-color_primaries", tags.primaries),
            number("-color_trc", tags.transfer),
            number("-colorspace", tags.matrix),
            range,
        ]
        .concat()
    }
}

/// Place of chroma samples in files without a tag for it: the left one of two columns. ffmpeg's filter itself takes the middle.
const LEFT: &str = "out_h_chr_pos=0";

/// Returns what the filter `setparams` writes into each frame: newer versions take the tags from there.
fn parameters(tags: &ColourTags) -> Vec<String> {
    let number = |name: &str, number: Option<u8>| number.map(|number| format!("{name}={number}"));
    let range = tags.range.map(|range| format!("range={}", range.name()));
    let all = [
        range,
        number("color_primaries", tags.primaries),
        number("color_trc", tags.transfer),
        number("colorspace", tags.matrix),
    ];
    all.into_iter().flatten().collect()
}
