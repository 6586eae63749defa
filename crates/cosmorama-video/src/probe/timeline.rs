use std::path::Path;
use std::time::Duration;

use super::Places;
use super::container::{AVI, MPEG1, begins_anywhere, is_bare_mpeg1, is_matroska};
use crate::{Ffmpeg, Ratio, VideoError, VideoInfo};

/// Times of a video's frames.
#[derive(Clone, Debug, PartialEq)]
pub enum Timeline {
    /// A constant rate.
    Even {
        /// Time of the first frame in ticks.
        start: i64,
        /// Seconds a tick.
        time_base: Ratio,
        /// Frames a second.
        rate: Ratio,
    },
    /// A time for each frame.
    Listed {
        /// Times in ticks, increasing.
        times: Vec<i64>,
        /// Seconds a tick.
        time_base: Ratio,
    },
}

/// Coded frame, as the container tells it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct CodedFrame {
    /// Time in ticks.
    pub(crate) time: i64,
    /// Whether it is decoded without others.
    pub(crate) is_key: bool,
    /// Whether it is shown, and not decoded for the sake of others alone.
    pub(crate) is_shown: bool,
}

/// Returns the times of the frames that are shown, in their order.
pub(crate) fn shown_times(coded: &[CodedFrame]) -> Vec<i64> {
    let mut times: Vec<i64> = coded.iter().filter(|frame| frame.is_shown).map(|frame| frame.time).collect();
    times.sort_unstable();
    times.dedup();
    times
}

/// Option of ffprobe for the first packets.
const FIRST: [&str; 2] = ["-read_intervals", "%+#120"];

/// Frames of a video at most: ten days of 120 a second.
const MOST_FRAMES: usize = 100_000_000;

impl Timeline {
    /// Returns the time of a frame in ticks; `None` beyond the end of a list.
    pub fn time(&self, frame: u64) -> Option<i64> {
        match self {
            Self::Even { start, time_base, rate } => {
                let frame = i64::try_from(frame).ok()?;
                Some(start.saturating_add(rate.inverse().rescale(frame, *time_base)))
            }
            Self::Listed { times, .. } => times.get(usize::try_from(frame).ok()?).copied(),
        }
    }

    /// Returns the number of the frame whose time is nearest to a number of ticks; of two as near, the later. Times before the first frame are
    /// the first's, times beyond the end of a list the last's.
    pub fn frame(&self, time: i64) -> u64 {
        match self {
            Self::Even { start, time_base, rate } => {
                let frame = time_base.rescale(time.saturating_sub(*start), rate.inverse());
                u64::try_from(frame).unwrap_or(0)
            }
            Self::Listed { times, .. } => nearest(times, time) as u64,
        }
    }

    /// Returns the number of the first frame that begins `seconds` after the first frame, or later, to within a tick.
    pub fn frame_at(&self, seconds: f64) -> u64 {
        let ticks = |time_base: &Ratio| (seconds.max(0.0) / time_base.to_f64()).round() as i64;
        match self {
            Self::Even { rate, .. } => {
                // Times that users write are rounded to a millisecond.
                let rounding = (0.0005 * rate.to_f64()).min(0.25);
                let frame = seconds.max(0.0) * rate.to_f64();
                let nearest = frame.round();
                if (frame - nearest).abs() <= rounding { nearest as u64 } else { frame.ceil() as u64 }
            }
            Self::Listed { times, time_base } => {
                let first = times.first().copied().unwrap_or(0);
                times.partition_point(|time| time.saturating_sub(first) < ticks(time_base)) as u64
            }
        }
    }

    /// Returns the number of frames; `None` for a rate, which goes on for ever.
    pub fn frames(&self) -> Option<u64> {
        match self {
            Self::Even { .. } => None,
            Self::Listed { times, .. } => Some(times.len() as u64),
        }
    }

    /// Returns the seconds of a tick.
    pub fn time_base(&self) -> Ratio {
        match self {
            Self::Even { time_base, .. } | Self::Listed { time_base, .. } => *time_base,
        }
    }
}

fn nearest(times: &[i64], time: i64) -> usize {
    let after = times.partition_point(|known| *known < time);
    let distance = |index: usize| times.get(index).map_or(u64::MAX, |known| known.abs_diff(time));
    if after > 0 && distance(after - 1) < distance(after) {
        after - 1
    } else {
        after.min(times.len().saturating_sub(1))
    }
}

impl Ffmpeg {
    /// Finds the times of all frames. For a video of variable rate this reads the whole file, without decoding it.
    ///
    /// # Errors
    /// When the file cannot be read, or its frames have no times.
    pub fn timeline(&self, info: &VideoInfo) -> Result<Timeline, VideoError> {
        if !info.is_variable {
            return Ok(Timeline::Even { start: info.start, time_base: info.time_base, rate: info.rate });
        }
        let times = self.packet_times(info)?;
        if times.is_empty() {
            let reason = "none of its frames has a time".to_owned();
            return Err(VideoError::NoVideo { path: info.path.clone(), reason });
        }
        Ok(Timeline::Listed { times, time_base: info.time_base })
    }

    /// Finds out whether the first hundred frames follow each other at the rate that is told.
    pub(super) fn begins_evenly(&self, info: &VideoInfo) -> Result<bool, VideoError> {
        /// Frames at the end of those that are read, or that are left of a cut file, before which others may come.
        const UNSURE: usize = 20;
        let stream = CodedStream::of(info);
        let times = stream.times_of(info, &self.packets(&info.path, stream, &FIRST)?);
        let is_whole = times.len() < 100 && info.cut.is_none();
        let sure = times.len().saturating_sub(if is_whole { 0 } else { UNSURE });
        let even = Timeline::Even { start: info.start, time_base: info.time_base, rate: info.rate };
        Ok(times[..sure].iter().zip(0..).all(|(time, frame)| even.frame(*time) == frame))
    }

    /// Reads the times of all coded frames that are shown, in their order.
    pub(crate) fn packet_times(&self, info: &VideoInfo) -> Result<Vec<i64>, VideoError> {
        let stream = CodedStream::of(info);
        let packets = self.packets(&info.path, stream, &[])?;
        if packets.iter().all(|packet| packet.shown.or(packet.decoded).is_none()) {
            // Those of bare streams, which follow each other.
            let even = Timeline::Even { start: info.start, time_base: info.time_base, rate: info.rate };
            return Ok((0..packets.len() as u64).filter_map(|frame| even.time(frame)).collect());
        }
        Ok(stream.times_of(info, &packets))
    }

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

    /// Reads what is said of all coded frames, in the order in which they are decoded; nothing where the file does not tell when they
    /// are shown.
    pub(crate) fn coded_frames(&self, info: &VideoInfo, part: &[&str]) -> Result<Vec<CodedFrame>, VideoError> {
        let stream = CodedStream::of(info);
        let mut packets = self.packets(&info.path, stream, part)?;
        if info.container == AVI && is_mpeg(&info.codec) {
            insert_lost(&mut packets, Places::compared(&info.path, info.stream, u64::MAX).resized());
        }
        let mut coded = if stream.tells_times(&packets) { timed(&packets) } else { Vec::new() };
        coded.retain(|frame| is_of_video(info, frame.time));
        Ok(coded)
    }

    fn packets(&self, path: &Path, stream: CodedStream, part: &[&str]) -> Result<Vec<Packet>, VideoError> {
        let index = stream.index.to_string();
        let entries = ["-select_streams", &index, "-show_entries", "packet=pts,dts,pos,flags", "-of", "csv=p=0"];
        let arguments = [stream.input_options(), &entries, part].concat();
        let mut packets = Vec::new();
        self.ffprobe_lines(path, &arguments, |line| {
            packets.push(Packet::of_line(line));
            if packets.len() > MOST_FRAMES {
                let found = format!("it has more than {MOST_FRAMES} frames");
                let expected = "fewer".to_owned();
                return Err(VideoError::Unsupported { path: path.to_owned(), found, expected });
            }
            Ok(())
        })?;
        // A first frame of MPEG-1 has a time of its own where the others have none, and is not shown one frame before its next.
        if let (MPEG1, [first, second, ..]) = (stream.codec, &mut *packets)
            && second.shown.is_none()
        {
            first.shown = None;
        }
        Ok(packets)
    }
}

/// Beginning of a stream.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beginning {
    /// Time of the first frame.
    pub(super) start: i64,
    /// Coded frames that come before it, behind a key frame.
    pub(super) leading: u64,
    /// Those of them that are to be shown.
    pub(super) left_out: u64,
}

impl Beginning {
    /// Returns the beginning at a time, of coded frames that have times and of those that are to be shown.
    fn after(coded: &[i64], shown: &[i64], start: i64) -> Self {
        let before = |times: &[i64]| times.iter().filter(|time| **time < start).count() as u64;
        Self { start, leading: before(coded), left_out: before(shown) }
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

/// Returns whether a coded frame is one of the video's. Of those before the first key frame, some are lost without a word where decoding
/// begins with it.
fn is_of_video(info: &VideoInfo, time: i64) -> bool {
    time >= info.start || (info.leading == 0 && !begins_anywhere(&info.container))
}

/// Stream of a file.
#[derive(Clone, Copy, Debug)]
pub(super) struct CodedStream<'a> {
    pub(super) index: u32,
    pub(super) container: &'a str,
    pub(super) codec: &'a str,
    /// Frames that its decoder keeps back.
    pub(super) delay: u64,
}

impl<'a> CodedStream<'a> {
    pub(super) fn of(info: &'a VideoInfo) -> Self {
        Self { index: info.stream, container: &info.container, codec: &info.codec, delay: info.delay }
    }

    /// Returns the options to read it: none of its times is to be guessed where that would be wrong.
    pub(super) fn input_options(self) -> &'static [&'static str] {
        if is_bare_mpeg1(self.container, self.codec) { &["-fflags", "+nofillin"] } else { &[] }
    }

    /// Returns the times of the video's frames that are shown, in their order.
    fn times_of(self, info: &VideoInfo, packets: &[Packet]) -> Vec<i64> {
        let mut times = self.shown_times(packets);
        times.retain(|time| is_of_video(info, *time));
        times
    }

    /// Returns whether a file tells when coded frames are shown, or it can be known.
    fn tells_times(self, packets: &[Packet]) -> bool {
        is_mpeg(self.codec) || packets.iter().any(|packet| packet.shown.is_some())
    }

    /// Returns the times of the frames that are shown, in their order. Where the file does not tell them, ffmpeg gives a frame the time at
    /// which the one is decoded that comes so much later as the decoder keeps back; behind the last, it guesses.
    fn shown_times(self, packets: &[Packet]) -> Vec<i64> {
        if self.tells_times(packets) {
            return shown_times(&timed(packets));
        }
        let mut decoded: Vec<i64> =
            packets.iter().filter(|packet| packet.is_shown).filter_map(|packet| packet.decoded).collect();
        decoded.sort_unstable();
        decoded.dedup();
        let &[.., before, last] = &*decoded else { return decoded };
        let delay = usize::try_from(self.delay).unwrap_or(usize::MAX).min(decoded.len() - 1);
        let guessed = (1..).map(|step| last.saturating_add(last.saturating_sub(before).saturating_mul(step)));
        decoded.iter().copied().skip(delay).chain(guessed.take(delay)).collect()
    }
}

/// Returns whether a codec is one of MPEG's first, whose B frames are decoded when they are shown. H.264 has others.
fn is_mpeg(codec: &str) -> bool {
    [MPEG1, "mpeg2video", "mpeg4"].contains(&codec)
}

/// Inserts packets at the places that an AVI lost with all their bytes: that of the frame before them tells when theirs is shown.
fn insert_lost(packets: &mut Vec<Packet>, places: &[i64]) {
    for place in places {
        let behind = packets.iter().position(|packet| packet.decoded.is_some_and(|decoded| decoded >= *place));
        let Some(behind) = behind.filter(|behind| *behind > 0 && packets[*behind].decoded != Some(*place)) else {
            continue;
        };
        let lost = Packet { shown: None, decoded: Some(*place), byte: None, is_key: false, is_shown: true };
        packets.insert(behind, lost);
    }
}

/// Coded frame, as ffprobe tells it.
#[derive(Clone, Copy, Debug)]
struct Packet {
    shown: Option<i64>,
    decoded: Option<i64>,
    /// Byte of the file at which it begins, if that is told.
    byte: Option<u64>,
    is_key: bool,
    is_shown: bool,
}

impl Packet {
    fn of_line(line: &str) -> Self {
        let mut fields = line.split(',');
        let mut time = || fields.next().and_then(|time| time.parse().ok());
        let (shown, decoded) = (time(), time());
        let byte = fields.next().and_then(|byte| byte.parse().ok());
        let flags = fields.next().unwrap_or_default();
        // D marks what is decoded for the sake of others alone.
        Self { shown, decoded, byte, is_key: flags.contains('K'), is_shown: !flags.contains('D') }
    }
}

/// Returns the coded frames that have a time. AVI and MPEG's own streams tell none of some frames that are decoded before others and shown
/// behind them: such a frame is shown when the next that is no B frame is decoded. Behind the last of them, that is a guess.
fn timed(packets: &[Packet]) -> Vec<CodedFrame> {
    let mut decoded = packets.iter().rev().filter_map(|packet| packet.decoded);
    let last_two = decoded.next().zip(decoded.next());
    let mut next = last_two.map(|(last, before)| last.saturating_add(last.saturating_sub(before)));
    let frame = |packet: &Packet| {
        let Packet { shown, decoded, is_key, is_shown, .. } = *packet;
        let time = shown.or(decoded.and(next));
        // B frames are shown when they are decoded.
        if decoded.is_some() && shown != decoded {
            next = decoded;
        }
        Some(CodedFrame { time: time?, is_key, is_shown })
    };
    let mut frames: Vec<CodedFrame> = packets.iter().rev().filter_map(frame).collect();
    frames.reverse();
    frames
}

/// Time in which a file must be probed.
pub(super) const PATIENCE: Duration = Duration::from_secs(60);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_without_a_time_are_shown_when_the_next_such_is_decoded() {
        let times = |lines: &[&str]| {
            let packets: Vec<Packet> = lines.iter().map(|line| Packet::of_line(line)).collect();
            timed(&packets).iter().map(|frame| frame.time).collect::<Vec<_>>()
        };
        // MPEG-4 with two B frames in AVI.
        assert_eq!(
            times(&["N/A,0,N/A,K_", "N/A,1,N/A,__", "2,2,N/A,__", "3,3,N/A,__", "N/A,4,N/A,__", "5,5,N/A,__"]),
            [1, 4, 2, 3, 6, 5]
        );
        assert_eq!(times(&["0,-1,N/A,K_", "3,0,N/A,__", "1,1,N/A,__", "2,2,N/A,_D"]), [0, 3, 1, 2]);
        assert_eq!(times(&["N/A,0,N/A,K_", "N/A,1,N/A,__", "N/A,2,N/A,__"]), [1, 2, 3], "there may have been B frames");
        // MPEG's own streams tell most times.
        let stream = [
            "1,0,N/A,K_",
            "4,1,N/A,__",
            "2,2,N/A,__",
            "3,3,N/A,__",
            "N/A,4,N/A,__",
            "5,5,N/A,__",
            "6,6,N/A,__",
            "10,7,N/A,__",
        ];
        assert_eq!(times(&stream), [1, 4, 2, 3, 7, 5, 6, 10]);
        assert_eq!(times(&["0,0,N/A,K_", "N/A,N/A,N/A,__", "2,2,N/A,__"]), [0, 2]);
    }

    #[test]
    fn frames_of_which_no_time_is_told_are_shown_in_order() {
        let packets = ["N/A,0,N/A,K_", "N/A,2,N/A,__", "N/A,3,N/A,__", "N/A,5,N/A,__"].map(Packet::of_line);
        let times = |codec, delay| CodedStream { index: 0, container: AVI, codec, delay }.shown_times(&packets);
        assert_eq!(times("h264", 0), [0, 2, 3, 5]);
        assert_eq!(times("h264", 2), [3, 5, 7, 9]);
        assert_eq!(times("h264", 16), [5, 7, 9, 11]);
        assert_eq!(CodedStream { index: 0, container: AVI, codec: "h264", delay: 2 }.shown_times(&packets[..1]), [0]);
        let unordered = ["N/A,5,N/A,K_", "N/A,3,N/A,__", "N/A,3,N/A,__", "N/A,4,N/A,_D"].map(Packet::of_line);
        assert_eq!(CodedStream { index: 0, container: AVI, codec: "h264", delay: 1 }.shown_times(&unordered), [5, 7]);
    }

    #[test]
    fn times_and_numbers_are_each_others_inverse() {
        let time_base = Ratio::parse("1/1000").unwrap();
        let even = Timeline::Even { start: -40, time_base, rate: Ratio::parse("30000/1001").unwrap() };
        for frame in [0, 1, 2, 29, 30, 1_000_000] {
            assert_eq!(even.frame(even.time(frame).unwrap()), frame);
        }
        let listed = Timeline::Listed { times: vec![0, 10, 11, 400], time_base };
        for frame in 0..4 {
            assert_eq!(listed.frame(listed.time(frame).unwrap()), frame);
        }
        assert_eq!((listed.time(4), listed.frame(1000), listed.frame(-9)), (None, 3, 0));
        // ffmpeg guesses the times of the last, perhaps half a frame too early.
        assert_eq!(listed.frame(5), 1, "between 0 and 10");
    }

    #[test]
    fn a_time_that_is_typed_finds_its_frame() {
        let time_base = Ratio::parse("1/90000").unwrap();
        let even = Timeline::Even { start: 900, time_base, rate: Ratio::parse("30000/1001").unwrap() };
        assert_eq!(
            [0.0, 0.033, 0.0334, 0.034, 1.001, 60.0].map(|seconds| even.frame_at(seconds)),
            [0, 1, 1, 2, 30, 1799]
        );
        let listed = Timeline::Listed { times: vec![900, 1800, 90900], time_base };
        assert_eq!([0.0, 0.01, 0.02, 1.0, 1.5].map(|seconds| listed.frame_at(seconds)), [0, 1, 2, 2, 3]);
    }
}
