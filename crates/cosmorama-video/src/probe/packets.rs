//! Coded frames of a stream, as ffprobe tells them without decoding.

use std::path::Path;

use super::Places;
use super::container::{AVI, MPEG1, begins_anywhere, is_bare_mpeg1};
use crate::{Ffmpeg, VideoError, VideoInfo};

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
pub(super) const FIRST: [&str; 2] = ["-read_intervals", "%+#120"];

/// Frames of a video at most: ten days of 120 a second.
const MOST_FRAMES: usize = 100_000_000;

impl Ffmpeg {
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

    pub(super) fn packets(&self, path: &Path, stream: CodedStream, part: &[&str]) -> Result<Vec<Packet>, VideoError> {
        let index = stream.index.to_string();
        let entries = ["-select_streams", &index, "-show_entries", "packet=pts,dts,pos,flags", "-of", "csv=p=0"];
        let arguments = [stream.input_options(), &entries, part].concat();
        let mut packets = Vec::new();
        self.ffprobe_lines(path, &arguments, |line| {
            // Behind those of a packet's side data, ffprobe ends the line once more.
            if line.is_empty() {
                return Ok(());
            }
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
    pub(super) fn times_of(self, info: &VideoInfo, packets: &[Packet]) -> Vec<i64> {
        let mut times = self.shown_times(packets);
        times.retain(|time| is_of_video(info, *time));
        times
    }

    /// Returns whether a file tells when coded frames are shown, or it can be known.
    pub(super) fn tells_times(self, packets: &[Packet]) -> bool {
        is_mpeg(self.codec) || packets.iter().any(|packet| packet.shown.is_some())
    }

    /// Returns the times of the frames that are shown, in their order. Where the file does not tell them, ffmpeg gives a frame the time at
    /// which the one is decoded that comes so much later as the decoder keeps back; behind the last, it guesses.
    pub(super) fn shown_times(self, packets: &[Packet]) -> Vec<i64> {
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

/// Returns whether a coded frame is one of the video's. Of those before the first key frame, some are lost without a word where decoding
/// begins with it.
fn is_of_video(info: &VideoInfo, time: i64) -> bool {
    time >= info.start || (info.leading == 0 && !begins_anywhere(&info.container))
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
pub(super) struct Packet {
    pub(super) shown: Option<i64>,
    pub(super) decoded: Option<i64>,
    /// Byte of the file at which it begins, if that is told.
    pub(super) byte: Option<u64>,
    pub(super) is_key: bool,
    pub(super) is_shown: bool,
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
pub(super) fn timed(packets: &[Packet]) -> Vec<CodedFrame> {
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
}
