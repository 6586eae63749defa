//! ffmpeg that decodes: raw frames from its output, and their times from its messages.

use std::io::{self, BufReader, Read};
use std::ops::Range;
use std::process::{ChildStdout, Stdio};

use cosmorama::raster::{Depth, EncodedImage, FramePool, Samples};

use super::ReadOptions;
use super::filters::{Pixels, Raw, chain};
use crate::ffmpeg::{Child, Event, Log, input_limits, url};
use crate::{Ffmpeg, Timeline, Version, VideoError, VideoInfo};

/// Point at which decoding begins.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Start {
    /// Seconds after the file's beginning to which ffmpeg seeks; it lands there or before.
    pub(super) seek: Option<f64>,
    /// Time in ticks of the first frame that is wanted.
    pub(super) from: Option<i64>,
    /// Meaning of messages before that frame.
    pub(super) heard: HeardBefore,
}

/// Meaning of messages before the first frame that is wanted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum HeardBefore {
    /// Messages of that frame.
    #[default]
    Own,
    /// Messages of frames that are decoded and dropped, or of those that lack others before the place where decoding began.
    Others,
    /// Complaints of frames that are left out, since they took after others that were cut off.
    Leading,
}

/// Frames from whose number on seeking is worth it.
const WORTH_SEEKING: u64 = 50;

/// Seconds before a frame to which ffmpeg seeks, so that all frames that it needs lie behind.
pub(super) const MARGIN: f64 = 0.5;

impl Start {
    /// Returns where decoding begins for a frame to be the first.
    pub(super) fn at(first: u64, info: &VideoInfo, timeline: &Timeline) -> Self {
        let is_partial = first > 0 || info.leading > 0 || info.is_open;
        let Some(time) = is_partial.then(|| timeline.time(first)).flatten() else { return Self::default() };
        let half = match timeline {
            Timeline::Even { time_base, rate, .. } => rate.inverse().rescale(1, *time_base) / 2,
            // ffmpeg guesses the times of some.
            Timeline::Listed { .. } => {
                let before = first.checked_sub(1).and_then(|before| timeline.time(before)).unwrap_or(time);
                time.saturating_sub(before) / 2
            }
        };
        let seconds = time as f64 * info.time_base.to_f64() - info.file_start - MARGIN;
        let seek = (first >= WORTH_SEEKING && seconds > 0.0).then_some(seconds);
        let heard = if first > 0 { HeardBefore::Others } else { HeardBefore::Leading };
        Self { seek, from: Some(time.saturating_sub(half)), heard }
    }
}

/// A running decoder. Dropped, it ends its ffmpeg.
#[derive(Debug)]
pub(super) struct Decoder {
    child: Child,
    frames: BufReader<ChildStdout>,
    log: Log,
    raw: Raw,
    size: (usize, usize),
    /// Rows that ffmpeg gives.
    rows: Range<usize>,
    /// Whether a frame that is wanted has been told.
    has_begun: bool,
    /// Meaning of messages before it.
    heard: HeardBefore,
    /// Whether something was heard before it: frames may be damaged, or lack others before the place where decoding began.
    is_doubtful: bool,
    /// Whether a message of an error is about the frame that comes next, which is painted over and given all the same.
    is_painted: bool,
}

/// A frame, and what was said of it.
#[derive(Debug)]
pub(super) struct Decoded {
    pub(super) image: EncodedImage,
    pub(super) time: Option<i64>,
    pub(super) is_corrupt: bool,
    /// First message of an error before the frame.
    pub(super) complaint: Option<String>,
    /// Frames of which one is meant, from this one on.
    pub(super) meant: u64,
}

/// End of the frames.
#[derive(Debug)]
pub(super) struct Ended {
    pub(super) is_success: bool,
    /// Message of the error that was heard, if one was.
    pub(super) complaint: Option<String>,
}

/// Next thing that a decoder gives.
#[derive(Debug)]
pub(super) enum Next {
    Frame(Decoded),
    End(Ended),
}

impl Decoder {
    pub(super) fn start(
        ffmpeg: &Ffmpeg,
        info: &VideoInfo,
        options: &ReadOptions,
        start: Start,
    ) -> Result<Self, VideoError> {
        let raw = Raw::of(info)?;
        let rows = raw.rows(info.size().1, options.rows.as_ref());
        let mut command = ffmpeg.ffmpeg_command();
        command.args(Log::OPTIONS).args(input_limits());
        command.args(["-err_detect", detection(info), "-copyts", "-noautorotate"]);
        let is_painted = is_painted(ffmpeg, info);
        if is_painted {
            // Decoders of several frames at a time would not tell which of them they mean.
            command.args(["-thread_type", "slice"]);
        }
        // Of H.264 that begins between key frames, several threads at a time would give no frame at all.
        let threads = if info.early > 0 && start.seek.is_none() { 1 } else { options.threads };
        if threads > 0 {
            command.args(["-threads", &threads.to_string()]);
        }
        if let Some(seconds) = start.seek {
            command.args(["-noaccurate_seek", "-ss", &format!("{seconds:.6}")]);
        }
        command.args(info.input_options()).arg("-i").arg(url(&info.path)).args(["-map", &format!("0:{}", info.stream)]);
        command.args(["-vf", &chain(info, (raw, &rows), start.from)?]).args(ffmpeg.every_frame_once());
        command.args(["-f", "rawvideo", "-c:v", "rawvideo", "-pix_fmt", &raw.name(), "pipe:1"]);
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = Child::start(command, "ffmpeg", ffmpeg.unfinished())?;
        let log = Log::of(child.stderr());
        let stdout = child.stdout().ok_or_else(|| failed(io::ErrorKind::BrokenPipe.into()))?;
        Ok(Self {
            child,
            frames: BufReader::with_capacity(1 << 16, stdout),
            log,
            raw,
            size: info.size(),
            rows,
            has_begun: false,
            heard: start.heard,
            is_doubtful: false,
            is_painted,
        })
    }

    /// Returns the next frame, or how the frames have ended.
    pub(super) fn next(&mut self, info: &VideoInfo, pool: &FramePool) -> Result<Next, VideoError> {
        let Some(image) = self.image(info, pool)? else { return self.end() };
        let (mut is_corrupt, mut complaint, mut meant) = (false, None, 1);
        let heard = if self.has_begun { HeardBefore::Own } else { self.heard };
        let time = loop {
            match self.log.next() {
                Some(Event::Frame(time)) => break time,
                Some(Event::Corrupt | Event::Complaint(_) | Event::CorruptPacket(_))
                    if heard == HeardBefore::Others =>
                {
                    self.is_doubtful = true
                }
                Some(Event::Complaint(text)) if heard == HeardBefore::Leading && is_of_cut_off(&text) => {}
                Some(Event::Corrupt) => is_corrupt = true,
                // Its decoder may paint over what it lacks without a word. Where streams were joined, nothing is lacking, and nobody can tell.
                Some(Event::CorruptPacket(stream)) if stream == info.stream => {
                    // It is of a frame that is read now: those that are kept back come before it, and one is in the parser.
                    meant = info.delay + 2;
                    complaint.get_or_insert_with(|| "packets are lost, or streams were joined there".to_owned());
                }
                Some(Event::CorruptPacket(_)) => {}
                Some(Event::Complaint(text)) => {
                    is_corrupt |= self.is_painted;
                    complaint.get_or_insert(text);
                }
                None => break None,
            }
        };
        self.has_begun = true;
        Ok(Next::Frame(Decoded { image, time, is_corrupt, complaint, meant }))
    }

    /// Returns once whether something was heard before the first frame that is wanted.
    pub(super) fn take_doubt(&mut self) -> bool {
        std::mem::take(&mut self.is_doubtful)
    }

    fn image(&mut self, info: &VideoInfo, pool: &FramePool) -> Result<Option<EncodedImage>, VideoError> {
        let count = self.raw.samples((self.size.0, self.rows.len())) as usize;
        let samples = if self.raw.depth == Depth::Eight {
            let mut samples = pool.take::<u8>(count);
            self.fill(info, &mut samples)?.then(|| self.shallow(samples, pool))
        } else {
            let mut samples = pool.take::<u16>(count);
            let is_filled = self.fill(info, bytemuck::cast_slice_mut(&mut samples))?;
            samples.iter_mut().for_each(|sample| *sample = u16::from_le(*sample));
            is_filled.then(|| self.deep(samples, pool))
        };
        let Some(samples) = samples else { return Ok(None) };
        let image = EncodedImage::new(self.size.0, self.size.1, self.raw.channels, self.raw.depth, samples);
        image.map(Some).map_err(|error| failed(io::Error::other(error)))
    }

    /// Returns RGB of 8 bits.
    fn shallow(&self, planes: Vec<u8>, pool: &FramePool) -> Samples {
        let Pixels::Yuv420 { coding, .. } = self.raw.pixels else { return Samples::U8(planes) };
        let row = self.size.0 * self.raw.channels.count();
        let mut pixels = pool.take(row * self.size.1);
        let given = &mut pixels[row * self.rows.start..row * self.rows.end];
        coding.pixels(&planes, (self.size.0, self.rows.len()), given);
        pool.give(Samples::U8(planes));
        Samples::U8(pixels)
    }

    /// Returns RGB of more than 8 bits.
    fn deep(&self, planes: Vec<u16>, pool: &FramePool) -> Samples {
        if self.raw.pixels == Pixels::Rgb {
            return Samples::U16(planes);
        }
        let count = self.raw.channels.count();
        let mut pixels = pool.take(self.size.0 * self.size.1 * count);
        match self.raw.pixels {
            Pixels::Yuv(coding) => coding.pixels(&planes, count, &mut pixels),
            Pixels::Grey(coding) => coding.grey_pixels(&planes, &mut pixels),
            Pixels::Rgb | Pixels::Yuv420 { .. } => {}
        }
        pool.give(Samples::U16(planes));
        Samples::U16(pixels)
    }

    /// Fills a frame; `false` at the end, an error within a frame.
    fn fill(&mut self, info: &VideoInfo, bytes: &mut [u8]) -> Result<bool, VideoError> {
        let mut filled = 0;
        while filled < bytes.len() {
            match self.frames.read(&mut bytes[filled..]) {
                Ok(0) if filled == 0 => return Ok(false),
                Ok(0) => {
                    let reason = format!("it ended within a frame: {}", self.log.last_words());
                    return Err(VideoError::Decode { path: info.path.clone(), reason });
                }
                Ok(read) => filled += read,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(failed(error)),
            }
        }
        Ok(true)
    }

    fn end(&mut self) -> Result<Next, VideoError> {
        let complaint = self.log.rest();
        let status = self.child.wait().map_err(failed)?;
        Ok(Next::End(Ended { is_success: status.success(), complaint }))
    }
}

/// Returns what ffmpeg takes for damage: that is an error, and its frame is missed; otherwise it is painted over.
fn detection(info: &VideoInfo) -> &'static str {
    match info.codec.as_str() {
        // Frames that were cut off are errors, and so all that name them, which need them in name only.
        "h264" if info.is_open => "crccheck+bitstream+buffer+aggressive",
        // Bits that are left over behind a slice, too. Decoders of other codecs take more for damage then, which may be none.
        "h264" => "crccheck+bitstream+buffer+explode+aggressive",
        _ => "crccheck+bitstream+buffer+explode",
    }
}

/// Returns whether ffmpeg's decoder of H.264 says that a frame does not find others that it gives up (`libavcodec/h264_refs.c`).
fn is_of_cut_off(text: &str) -> bool {
    ["mmco: unref short failure", "number of reference frames"].iter().any(|lacking| text.contains(lacking))
}

/// Returns whether ffmpeg gives damaged frames on, painted over, with a message before each and no other sign.
fn is_painted(ffmpeg: &Ffmpeg, info: &VideoInfo) -> bool {
    /// From this version on, a decoder runs ahead of the frames that are given.
    const THREADED: Version = Version { major: 7, minor: 0 };
    info.codec == "ffv1" && ffmpeg.version() < THREADED
}

fn failed(source: io::Error) -> VideoError {
    VideoError::Run { program: "ffmpeg".to_owned(), source }
}
