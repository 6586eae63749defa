use super::packets::{CodedFrame, CodedStream, FIRST, shown_times, timed};
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

/// Way in which frames follow each other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Evenness {
    /// At a rate.
    Even,
    /// In places for a rate, some of which are empty: these.
    Lacking(Vec<u64>),
    /// At no rate.
    Varying,
}

impl Evenness {
    fn of(times: &[i64], even: &Timeline) -> Self {
        let frames: Vec<u64> = times.iter().map(|time| even.frame(*time)).collect();
        if (0..).zip(&frames).all(|(place, frame)| place == *frame) {
            return Self::Even;
        }
        let is_placed = |time: i64| {
            let frame = even.frame(time);
            let near = even.time(frame).zip(even.time(frame + 1));
            near.is_some_and(|(place, next)| 8 * place.abs_diff(time) <= place.abs_diff(next))
        };
        let last = frames.last().copied().unwrap_or(0);
        let are_placed = frames.is_sorted_by(|a, b| a < b) && times.iter().all(|time| is_placed(*time));
        if !are_placed || last >= 2 * frames.len() as u64 {
            return Self::Varying;
        }
        Self::Lacking((0..last).filter(|place| frames.binary_search(place).is_err()).collect())
    }

    /// Returns whether the empty places are those that the end of a film lacks that was cut out: all frames behind them are decoded when the last one
    /// is, or later.
    fn is_of_end(&self, coded: &[CodedFrame], even: &Timeline) -> bool {
        let Self::Lacking(places) = self else { return false };
        let numbers: Vec<u64> = coded.iter().map(|coded| even.frame(coded.time)).collect();
        let last = numbers.iter().max().and_then(|last| numbers.iter().position(|number| number == last));
        last.is_some_and(|last| numbers[..last].iter().all(|number| *number < places[0]))
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

    /// Returns how many frames a film of a constant rate has by the time of its last one: where it lacks some before that, as at the end of a
    /// film that was cut out without coding it anew, these are more than it counts.
    pub(super) fn frames_by_time(&self, info: &VideoInfo) -> Result<u64, VideoError> {
        /// Seconds from the end, within which the last frame is decoded; and frames, where these are slow.
        const END: (f64, f64) = (2.0, 40.0);
        let end = info.start as f64 * info.time_base.to_f64() + info.duration.unwrap_or(0.0);
        let part = format!("{:.3}%", (end - END.0.max(END.1 / info.rate.to_f64())).max(0.0));
        let coded = self.coded_frames(info, &["-read_intervals", &part])?;
        let last = shown_times(&coded).last().copied();
        let even = Timeline::Even { start: info.start, time_base: info.time_base, rate: info.rate };
        Ok(last.map_or(0, |last| even.frame(last) + 1))
    }

    /// Finds out whether the first hundred frames follow each other at the rate that is told.
    pub(super) fn evenness(&self, info: &VideoInfo) -> Result<Evenness, VideoError> {
        /// Frames at the end of those that are read, or that are left of a cut file, before which others may come.
        const UNSURE: usize = 20;
        let stream = CodedStream::of(info);
        let packets = self.packets(&info.path, stream, &FIRST)?;
        let times = stream.times_of(info, &packets);
        let is_whole = times.len() < 100 && info.cut.is_none();
        let sure = times.len().saturating_sub(if is_whole { 0 } else { UNSURE });
        let even = Timeline::Even { start: info.start, time_base: info.time_base, rate: info.rate };
        let coded = if stream.tells_times(&packets) { timed(&packets) } else { Vec::new() };
        Ok(match Evenness::of(&times[..sure], &even) {
            found if is_whole && found.is_of_end(&coded, &even) => Evenness::Even,
            // So many are no accident.
            Evenness::Lacking(places) if 4 * places.len() > sure => Evenness::Varying,
            found => found,
        })
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
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn a_few_places_that_are_empty_are_no_other_rate() {
        let time_base = Ratio::parse("1/1000").unwrap();
        let even = Timeline::Even { start: 7, time_base, rate: Ratio::parse("24000/1001").unwrap() };
        let times = |places: &[u64]| places.iter().filter_map(|place| even.time(*place)).collect::<Vec<_>>();
        let all: Vec<u64> = (0..100).collect();
        assert_eq!(Evenness::of(&times(&all), &even), Evenness::Even);
        let without = |lost: &[u64]| all.iter().copied().filter(|place| !lost.contains(place)).collect::<Vec<_>>();
        let lacking = Evenness::of(&times(&without(&[41, 60])), &even);
        assert_eq!(lacking, Evenness::Lacking(vec![41, 60]));
        assert_eq!(Evenness::of(&times(&[1, 2]), &even), Evenness::Lacking(vec![0]));
        assert_eq!(Evenness::of(&[0, i64::MAX / 2], &even), Evenness::Varying);
        let mut late = times(&without(&[41]));
        late[70] += 15;
        assert_eq!(Evenness::of(&late, &even), Evenness::Varying);
    }

    #[test]
    fn the_end_of_a_film_that_was_cut_out_lacks_what_is_decoded_behind_its_last() {
        let time_base = Ratio::parse("1/1000").unwrap();
        let even = Timeline::Even { start: 0, time_base, rate: Ratio::parse("25").unwrap() };
        let is_of_end = |numbers: &[u64]| {
            let frame =
                |number: &u64| CodedFrame { time: even.time(*number).unwrap(), is_key: *number == 0, is_shown: true };
            let coded: Vec<CodedFrame> = numbers.iter().map(frame).collect();
            Evenness::of(&shown_times(&coded), &even).is_of_end(&coded, &even)
        };
        assert!(is_of_end(&[0, 4, 2, 1, 3, 8, 6]));
        assert!(is_of_end(&[0, 4, 2, 1, 3, 8]));
        assert!(!is_of_end(&[0, 4, 2, 3, 8, 6]));
        assert!(!is_of_end(&[0, 4, 2, 1, 3, 8, 6, 5, 7]));
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
