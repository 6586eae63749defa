//! Beginning of a stream: the first frame that can be decoded.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use super::container::{FLV, is_bare_mpeg1, is_boxes, is_matroska};
use super::packets::{CodedStream, FIRST, Packet, timed};
use super::{Announced, VideoInfo};
use crate::{Ffmpeg, VideoError};

/// Beginning of a stream.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beginning {
    /// Time of the first frame.
    pub(super) start: i64,
    /// Coded frames that would be shown before it, behind the key frame with which the stream begins.
    pub(super) leading: u64,
    /// Leading frames that are to be shown.
    pub(super) left_out: u64,
    /// Whether it is H.264 whose first key frame does not make frames before it needless.
    pub(super) is_open: bool,
    /// Whether some of its first frames are not shown.
    pub(super) hides: bool,
}

impl Beginning {
    /// Returns that of a stream that begins with its first coded frame.
    fn whole(start: i64) -> Self {
        Self { start, leading: 0, left_out: 0, is_open: false, hides: false }
    }

    /// Returns the beginning at a time, behind coded frames before that, of which some are to be shown, and others that have no time.
    fn behind(coded: &[i64], shown: &[i64], untimed: u64, start: i64) -> Self {
        let before = |times: &[i64]| times.iter().filter(|time| **time < start).count() as u64 + untimed;
        Self { start, leading: before(coded), left_out: before(shown), ..Self::whole(start) }
    }
}

impl Ffmpeg {
    /// Finds where a stream begins; `None` where no frame of it has a time. Frames that are decoded behind the first key frame and shown before
    /// it may take after others that were cut off: the decoder tells.
    pub(super) fn beginning(&self, path: &Path, stream: CodedStream) -> Result<Option<Beginning>, VideoError> {
        let packets = self.packets(path, stream, &FIRST)?;
        let shown = stream.shown_times(&packets);
        let Some(first) = shown.first().copied() else { return Ok(None) };
        let listed = Listed { ffmpeg: self, path, stream, packets, shown };
        let beginning = listed.behind_cut_off().unwrap_or(Beginning::whole(first));
        let is_open = stream.codec == "h264" && (beginning.leading > 0 || listed.begins_open().unwrap_or(false));
        let hides = listed.packets.iter().any(|packet| !packet.is_shown);
        Ok(Some(Beginning { is_open, hides, ..beginning }))
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
            // ffmpeg guesses no mean rate of it, and then counts from 0, and not from before the frames that are kept back.
            self.start = self.rate.inverse().rescale(self.delay as i64, self.time_base);
        }
        self.is_open = beginning.is_some_and(|beginning| beginning.is_open);
        self.hides = beginning.is_some_and(|beginning| beginning.hides);
        let Some(Beginning { leading, left_out, .. }) = beginning.filter(|beginning| beginning.leading > 0) else {
            return;
        };
        (self.leading, self.left_out) = (leading, left_out);
        self.announced = self.announced.map(|told| Announced { frames: told.frames.saturating_sub(leading), ..told });
    }
}

/// First coded frames of a stream.
struct Listed<'a> {
    ffmpeg: &'a Ffmpeg,
    path: &'a Path,
    stream: CodedStream<'a>,
    packets: Vec<Packet>,
    /// Times of those that are shown, in their order.
    shown: Vec<i64>,
}

impl Listed<'_> {
    /// Finds where the stream begins, behind frames that take after others that were cut off; `None` if with its first coded frame.
    fn behind_cut_off(&self) -> Option<Beginning> {
        let may_lead = self.stream.delay > 0 && self.packets.first()?.is_key;
        match may_lead {
            true if self.stream.tells_times(&self.packets) => self.by_times(),
            true => self.without_times(),
            false => None,
        }
    }

    /// Finds out whether the first slice of H.264 is of a key frame that does not make those before it needless (IDR); `None` if it is not there.
    fn begins_open(&self) -> Option<bool> {
        /// Bytes of a packet, within which the first slice begins.
        const ENOUGH: u64 = 1 << 16;
        let place = self.packets.first().filter(|first| first.is_key)?.byte?;
        let mut file = File::open(self.path).ok()?;
        file.seek(SeekFrom::Start(place)).ok()?;
        let mut bytes = Vec::new();
        file.take(ENOUGH).read_to_end(&mut bytes).ok()?;
        // The kinds of units are those of H.264, table 7-1: 1 to 5 are slices, and 5 those of an IDR picture.
        let mut kinds = units(&bytes, self.stream.container).map(|unit| unit & 31);
        Some(kinds.find(|kind| (1..=5).contains(kind))? != 5)
    }

    /// Finds that of a stream that tells when its frames are shown.
    fn by_times(&self) -> Option<Beginning> {
        let coded: Vec<i64> = timed(&self.packets).iter().map(|frame| frame.time).collect();
        let untimed = if is_matroska(self.stream.container) { untimed_behind_first(&self.packets) } else { 0 };
        let key = coded.first().filter(|key| untimed > 0 || coded.iter().any(|time| time < key))?;
        let start = self.shown.iter().copied().find(|time| time >= key)?;
        // Where one of them can be decoded, they were not cut off: if others cannot, these are damaged.
        let is_behind = |decoded: FirstDecoded| match untimed {
            0 => decoded.time >= start,
            _ => decoded.byte.is_some() && decoded.byte == self.packets[0].byte,
        };
        self.first_decoded().is_none_or(is_behind).then(|| Beginning::behind(&coded, &self.shown, untimed, start))
    }

    /// Finds that of a stream that does not tell when its frames are shown, as far as it is known.
    fn without_times(&self) -> Option<Beginning> {
        let key = self.packets.first()?.byte?;
        // Behind a key frame that is damaged, the decoder begins with a later one.
        let decoded = self.first_decoded().filter(|decoded| decoded.byte == Some(key))?;
        Some(Beginning::behind(&self.shown, &self.shown, 0, decoded.time))
    }

    /// Decodes the first frames, and returns the first that is shown; `None` also if that fails.
    fn first_decoded(&self) -> Option<FirstDecoded> {
        /// Packets that a decoder keeps back, 16 at most, and some more.
        const ENOUGH: [&str; 2] = ["-read_intervals", "%+#20"];
        let index = self.stream.index.to_string();
        let entries =
            ["-select_streams", &index, "-show_entries", "frame=best_effort_timestamp,pkt_pos", "-of", "csv=p=0"];
        let mut first = None;
        let lines = self.ffmpeg.ffprobe_lines(self.path, &[&entries[..], &ENOUGH].concat(), |line| {
            first = first.or_else(|| FirstDecoded::of_line(line));
            Ok(())
        });
        lines.ok().and(first)
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

/// Returns the first byte of each unit of H.264 behind a place at which a packet begins. They tell their length, or begin with marks (annex B).
fn units<'a>(bytes: &'a [u8], container: &str) -> Box<dyn Iterator<Item = u8> + 'a> {
    let header = match container {
        container if is_boxes(container) => 0,
        // The numbers of the track and the time, and flags.
        container if is_matroska(container) => 4,
        // The header of a tag, and of its picture.
        FLV => 16,
        _ => return Box::new(bytes.windows(4).filter(|bytes| bytes.starts_with(&[0, 0, 1])).map(|bytes| bytes[3])),
    };
    let mut rest = bytes.get(header..).unwrap_or_default();
    Box::new(std::iter::from_fn(move || {
        let (length, content) = rest.split_first_chunk()?;
        rest = content.get(u32::from_be_bytes(*length) as usize..).unwrap_or_default();
        content.first().copied()
    }))
}

/// Counts the packets without a time that follow the first: Matroska tells none before its beginning.
fn untimed_behind_first(packets: &[Packet]) -> u64 {
    let is_untimed = |packet: &&Packet| packet.shown.or(packet.decoded).is_none();
    packets.iter().skip(1).take_while(is_untimed).count() as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_h264_are_found() {
        let marked = [0, 0, 0, 1, 9, 0xf0, 0, 0, 1, 6, 5, 0, 0, 1, 0x65, 1];
        assert_eq!(units(&marked, "mpegts").collect::<Vec<_>>(), [9, 6, 0x65]);
        let counted = [0, 0, 0, 2, 6, 5, 0, 0, 0, 1, 0x41, 0xff, 0xff, 0xff, 0xff, 0x65];
        for (container, header) in [("mov,mp4,m4a,3gp,3g2,mj2", 0), ("matroska,webm", 4), (FLV, 16)] {
            let packet = [&[0x81; 16][..header], &counted].concat();
            assert_eq!(units(&packet, container).collect::<Vec<_>>(), [6, 0x41, 0x65], "{container}");
            assert_eq!(units(&[0, 0, 0], container).count(), 0);
        }
    }
}
