//! Beginning of a stream: the first frame that can be decoded.

use std::path::Path;

use super::container::{is_bare_mpeg1, is_matroska};
use super::packets::{CodedStream, FIRST, Packet, timed};
use super::{Announced, VideoInfo};
use crate::{Ffmpeg, VideoError};

/// Beginning of a stream.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beginning {
    /// Time of the first frame.
    pub(super) start: i64,
    /// Coded frames that come before it, behind a key frame.
    pub(super) leading: u64,
    /// Leading frames that are to be shown.
    pub(super) left_out: u64,
}

impl Beginning {
    /// Returns the beginning at a time, of coded frames that have times and of those that are to be shown.
    fn after(coded: &[i64], shown: &[i64], start: i64) -> Self {
        let before = |times: &[i64]| times.iter().filter(|time| **time < start).count() as u64;
        Self { start, leading: before(coded), left_out: before(shown) }
    }
}

impl Ffmpeg {
    /// Finds where a stream begins; `None` where no frame of it has a time. Frames that are decoded behind the first key frame and shown before
    /// it may take after others that were cut off: the decoder tells.
    pub(super) fn beginning(&self, path: &Path, stream: CodedStream) -> Result<Option<Beginning>, VideoError> {
        let packets = self.packets(path, stream, &FIRST)?;
        let shown = stream.shown_times(&packets);
        let Some(first) = shown.first().copied() else { return Ok(None) };
        let whole = Beginning { start: first, leading: 0, left_out: 0 };
        let Some(key) = packets.first().filter(|packet| packet.is_key && stream.delay > 0) else {
            return Ok(Some(whole));
        };
        if !stream.tells_times(&packets) {
            // A later frame would be the first where the key frame is damaged.
            let decoded = self.first_decoded(path, stream)?.filter(|decoded| decoded.byte == key.byte);
            let start = decoded.map_or(first, |decoded| decoded.time);
            return Ok(Some(Beginning::after(&shown, &shown, start)));
        }
        let coded: Vec<i64> = timed(&packets).iter().map(|frame| frame.time).collect();
        let untimed = if is_matroska(stream.container) { untimed_behind_first(&packets) } else { 0 };
        let Some(key) = coded.first().filter(|key| untimed > 0 || coded.iter().any(|time| time < key)) else {
            return Ok(Some(whole));
        };
        let latest = shown.iter().copied().find(|time| time >= key).unwrap_or(first);
        let decoded = self.first_decoded(path, stream)?;
        let start = decoded.map_or(latest, |decoded| decoded.time.clamp(first, latest));
        let Beginning { leading, left_out, .. } = Beginning::after(&coded, &shown, start);
        Ok(Some(Beginning { start, leading: leading + untimed, left_out: left_out + untimed }))
    }

    /// Decodes the first frames, and returns the first that is shown.
    fn first_decoded(&self, path: &Path, stream: CodedStream) -> Result<Option<FirstDecoded>, VideoError> {
        let index = stream.index.to_string();
        let entries =
            ["-select_streams", &index, "-show_entries", "frame=best_effort_timestamp,pkt_pos", "-of", "csv=p=0"];
        let mut first = None;
        self.ffprobe_lines(path, &[&entries[..], &["-read_intervals", "%+#20"]].concat(), |line| {
            first = first.or_else(|| FirstDecoded::of_line(line));
            Ok(())
        })?;
        Ok(first)
    }

    /// Counts the frames that are shown before the first key frame, where the video does not begin with one.
    pub(super) fn early_frames(&self, info: &VideoInfo) -> Result<u64, VideoError> {
        /// Longer groups of pictures are of encoders that refresh them part by part, and make no key frames.
        const LONGEST: &str = "%+#3000";
        let stream = CodedStream::of(info);
        let mut packets = self.packets(&info.path, stream, &FIRST)?;
        let first_key = |packets: &[Packet]| packets.iter().position(|packet| packet.is_key);
        if first_key(&packets).is_none() {
            packets = self.packets(&info.path, stream, &["-read_intervals", LONGEST])?;
        }
        let Some(first) = first_key(&packets).filter(|first| *first > 0) else { return Ok(0) };
        let key = timed(&packets[first..]).first().filter(|_| stream.tells_times(&packets)).map(|key| key.time);
        Ok(match key {
            Some(time) => self.timeline(info)?.frame(time),
            None => first as u64,
        })
    }
}

impl VideoInfo {
    /// Notes where the video begins.
    pub(super) fn begin(&mut self, beginning: Option<Beginning>) {
        if is_bare_mpeg1(&self.container, &self.codec) {
            // Of a stream without a mean rate, ffmpeg counts from 0, and not from before the frames that are kept back.
            self.start = self.rate.inverse().rescale(self.delay as i64, self.time_base);
        }
        let Some(Beginning { leading, left_out, .. }) = beginning.filter(|beginning| beginning.leading > 0) else {
            return;
        };
        (self.leading, self.left_out) = (leading, left_out);
        self.announced = self.announced.map(|told| Announced { frames: told.frames.saturating_sub(leading), ..told });
    }
}

/// First frame that a decoder gives.
#[derive(Clone, Copy, Debug)]
struct FirstDecoded {
    time: i64,
    /// Byte of the file at which its packet begins, if that is told.
    byte: Option<u64>,
}

impl FirstDecoded {
    fn of_line(line: &str) -> Option<Self> {
        let mut fields = line.split(',').map(str::trim);
        let time = fields.next()?.parse().ok()?;
        Some(Self { time, byte: fields.next().and_then(|byte| byte.parse().ok()) })
    }
}

/// Counts the packets without a time that follow the first: Matroska tells none before its beginning.
fn untimed_behind_first(packets: &[Packet]) -> u64 {
    let is_untimed = |packet: &&Packet| packet.shown.or(packet.decoded).is_none();
    packets.iter().skip(1).take_while(is_untimed).count() as u64
}
