use std::fmt;
use std::str::FromStr;

use thiserror::Error;

use crate::FrameRate;

/// Times of a video as typed, in the requested order: `00:01:00-00:01:10,00:02:00`.
///
/// A time is hours, minutes and seconds, perhaps with a fraction. A range ends before its second time, so that ranges that follow each
/// other share no frame. A single time is the frame that is shown then.
///
/// ```
/// use cosmorama_spec::{FrameRate, TimeRanges};
/// let times: TimeRanges = "00:00:01-00:00:01.2,00:01:00".parse()?;
/// let frames = times.frames(FrameRate { frames: 25, seconds: 1 }, 2000);
/// assert_eq!(frames.collect::<Vec<_>>(), [25, 26, 27, 28, 29, 1500]);
/// assert_eq!(times.to_string(), "00:00:01-00:00:01.2,00:01:00");
/// # Ok::<(), cosmorama_spec::TimeRangesError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TimeRanges(Vec<Range>);

/// Reason why a list of times cannot be understood.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error(
    "times {list}: {reason}; expected times such as 00:01:00-00:01:10, or 00:00:02.5 for the frame that is shown then"
)]
pub struct TimeRangesError {
    /// List as typed.
    pub list: String,
    /// Description of the mistake.
    pub reason: String,
}

/// Time from the beginning of a video, in nanoseconds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Time(u64);

/// Times from the first up to the second, or a single one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Range {
    first: Time,
    end: Option<Time>,
}

const SECOND: u64 = 1_000_000_000;

impl TimeRanges {
    /// Returns whether a list of frames has times in place of numbers, also where their hours are missing: no number has a colon
    /// before a dash, or a point.
    pub fn are_meant(text: &str) -> bool {
        let first = text.split([',', '-']).next().unwrap_or_default();
        let is_followed_by_dash = text[first.len()..].starts_with('-');
        let colons = first.matches(':').count();
        colons > 1 || colons == 1 && (is_followed_by_dash || first.contains('.'))
    }

    /// Returns the first range, as typed, that ends behind a video of `count` frames by a frame or more, or a single time at which it
    /// shows none. Programs round the lengths that they tell.
    pub fn beyond(&self, rate: FrameRate, count: u64) -> Option<String> {
        let is_beyond = |range: &&Range| match range.end {
            Some(end) => end.shown(rate) > count,
            None => range.first.shown(rate) >= count,
        };
        self.0.iter().find(is_beyond).map(ToString::to_string)
    }

    /// Returns the first range that ends behind a video of variable rate, or a single time that lies there. Its frames begin at these
    /// nanoseconds, and the last one is shown twice as long, at most, as the longest before it.
    pub fn beyond_among(&self, begins: &[u64]) -> Option<String> {
        let longest = begins.windows(2).map(|pair| pair[1] - pair[0]).max().unwrap_or(u64::MAX);
        let end = begins.last().map_or(0, |last| last.saturating_add(longest.saturating_mul(2)));
        self.0.iter().find(|range| range.end.unwrap_or(range.first).0 > end).map(ToString::to_string)
    }

    /// Returns the time at which a frame begins, as it is typed: that of the frame behind the last is a video's end.
    pub fn time_of(rate: FrameRate, frame: u64) -> String {
        let nanoseconds = u128::from(frame) * u128::from(rate.seconds) * u128::from(SECOND) / u128::from(rate.frames);
        Time(u64::try_from(nanoseconds).unwrap_or(u64::MAX)).to_string()
    }

    /// Returns the numbers of the frames that begin in these ranges, and of those that are shown at single times, in a video of
    /// `count` frames. The first has number 0 and begins at 0.
    pub fn frames(&self, rate: FrameRate, count: u64) -> impl Iterator<Item = u64> {
        self.0.iter().flat_map(move |range| {
            let shown = range.first.shown(rate);
            let (first, end) = match range.end {
                Some(end) => (range.first.frames_before(rate), end.frames_before(rate)),
                None => (shown, shown.saturating_add(1)),
            };
            first..end.min(count)
        })
    }

    /// Returns the numbers of the frames that begin in these ranges, and of those that are shown at single times, in a video of
    /// variable rate. Its frames begin at these nanoseconds, the first at 0 and each later than the one before.
    pub fn frames_among(&self, begins: &[u64]) -> Vec<u64> {
        let before = |time: Time| begins.partition_point(|begin| *begin < time.0);
        let of = |range: &Range| match range.end {
            Some(end) => before(range.first)..before(end),
            None => {
                let shown = begins.partition_point(|begin| *begin <= range.first.0);
                shown.saturating_sub(1)..shown
            }
        };
        self.0.iter().flat_map(of).map(|frame| frame as u64).collect()
    }
}

impl Time {
    /// Returns the number of frames that begin before it.
    fn frames_before(self, rate: FrameRate) -> u64 {
        let unit = u128::from(SECOND) * u128::from(rate.seconds);
        (u128::from(self.0) * u128::from(rate.frames)).div_ceil(unit) as u64
    }

    /// Returns the number of frames before the one that is shown at it.
    fn shown(self, rate: FrameRate) -> u64 {
        let unit = u128::from(SECOND) * u128::from(rate.seconds);
        (u128::from(self.0) * u128::from(rate.frames) / unit) as u64
    }

    fn parse(text: &str) -> Result<Self, String> {
        let wrong = || format!("{text} is no time of hours:minutes:seconds");
        let parts: Vec<&str> = text.trim().split(':').collect();
        let [hours, minutes, seconds] = parts[..] else { return Err(wrong()) };
        let (seconds, fraction) = seconds.split_once('.').unwrap_or((seconds, "0"));
        let number = |digits: &str, longest: usize| -> Option<u64> {
            let is_number = (1..=longest).contains(&digits.len()) && digits.bytes().all(|byte| byte.is_ascii_digit());
            if is_number { digits.parse().ok() } else { None }
        };
        let below_60 = |digits: &str| number(digits, 2).filter(|number| *number < 60);
        let whole = number(hours, 4).zip(below_60(minutes)).zip(below_60(seconds));
        let ((hours, minutes), seconds) = whole.ok_or_else(wrong)?;
        let digits = number(fraction, 9).map(|_| format!("{fraction:0<9}")).ok_or_else(wrong)?;
        let nanoseconds = number(&digits, 9).ok_or_else(wrong)?;
        Ok(Self((hours * 3600 + minutes * 60 + seconds) * SECOND + nanoseconds))
    }
}

impl fmt::Display for Time {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (seconds, fraction) = (self.0 / SECOND, self.0 % SECOND);
        write!(f, "{:02}:{:02}:{:02}", seconds / 3600, seconds / 60 % 60, seconds % 60)?;
        if fraction > 0 {
            write!(f, ".{}", format!("{fraction:09}").trim_end_matches('0'))?;
        }
        Ok(())
    }
}

impl fmt::Display for TimeRanges {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, range) in self.0.iter().enumerate() {
            let separator = if index == 0 { "" } else { "," };
            write!(f, "{separator}{range}")?;
        }
        Ok(())
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.first)?;
        self.end.map_or(Ok(()), |end| write!(f, "-{end}"))
    }
}

impl FromStr for TimeRanges {
    type Err = TimeRangesError;

    fn from_str(text: &str) -> Result<Self, TimeRangesError> {
        let fail = |reason: String| TimeRangesError { list: text.to_owned(), reason };
        let range = |part: &str| match part.split_once('-') {
            None => Ok(Range { first: Time::parse(part)?, end: None }),
            Some((first, end)) => {
                let (first, end) = (Time::parse(first)?, Time::parse(end)?);
                if end > first {
                    return Ok(Range { first, end: Some(end) });
                }
                Err(format!("{end} is not after {first}"))
            }
        };
        text.split(',').map(range).collect::<Result<_, _>>().map(Self).map_err(fail)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILM: FrameRate = FrameRate { frames: 24, seconds: 1 };
    const NTSC: FrameRate = FrameRate { frames: 30_000, seconds: 1001 };

    fn frames(text: &str, rate: FrameRate) -> Vec<u64> {
        text.parse::<TimeRanges>().unwrap().frames(rate, 100_000).collect()
    }

    fn refused(text: &str) -> String {
        text.parse::<TimeRanges>().unwrap_err().to_string()
    }

    #[test]
    fn ranges_that_follow_each_other_share_no_frame_and_lack_none() {
        for rate in [FILM, NTSC] {
            let all = frames("00:00:00-00:00:04", rate);
            let parts = frames("00:00:00-00:00:01.37,00:00:01.37-00:00:02,00:00:02-00:00:04", rate);
            assert_eq!((all.first(), parts), (Some(&0), all.clone()));
            assert_eq!(all.len(), if rate == FILM { 96 } else { 120 });
        }
    }

    #[test]
    fn a_single_time_is_the_frame_that_is_shown_then() {
        assert_eq!(frames("00:00:00", FILM), [0]);
        assert_eq!(frames("00:00:00.999999999,00:00:01", FILM), [23, 24]);
        // Frame 30 of 30000/1001 begins at 1.001 s.
        assert_eq!(frames("00:00:01,00:00:01.001", NTSC), [29, 30]);
    }

    #[test]
    fn nothing_comes_after_the_last_frame() {
        let times: TimeRanges = "00:00:00-9999:00:00,00:00:02".parse().unwrap();
        assert_eq!(times.frames(FILM, 3).collect::<Vec<_>>(), [0, 1, 2]);
    }

    #[test]
    fn what_is_printed_is_read_again() {
        for text in ["00:01:00-00:01:10", "00:00:00.5", "01:02:03.004-10:00:00,123:59:59.999999999"] {
            let times: TimeRanges = text.parse().unwrap();
            assert_eq!(times.to_string(), text);
            assert_eq!(times.to_string().parse::<TimeRanges>().unwrap(), times);
        }
        assert_eq!("0:1:2-0:1:3.50".parse::<TimeRanges>().unwrap().to_string(), "00:01:02-00:01:03.5");
    }

    #[test]
    fn frames_of_a_variable_rate_are_found_by_their_own_times() {
        let begins = [0, 40, 100, 1000, 2500].map(|milliseconds: u64| milliseconds * 1_000_000);
        let found = |text: &str| text.parse::<TimeRanges>().unwrap().frames_among(&begins);
        assert_eq!(found("00:00:00-00:00:00.1"), [0, 1]);
        assert_eq!(found("00:00:00.1-00:00:09"), [2, 3, 4]);
        assert_eq!(found("00:00:02.499,00:00:00,00:00:09"), [3, 0, 4]);
        assert!(found("00:00:00.2-00:00:00.9").is_empty());
    }

    #[test]
    fn what_lies_behind_the_end_is_found() {
        let beyond = |text: &str| text.parse::<TimeRanges>().unwrap().beyond(FILM, 24);
        assert_eq!((beyond("00:00:00-00:00:01,00:00:00.99"), beyond("00:00:00.9-00:00:01")), (None, None));
        assert_eq!(beyond("00:00:00.5,00:00:00.5-00:00:01.05").as_deref(), Some("00:00:00.5-00:00:01.05"));
        assert_eq!(TimeRanges::time_of(FILM, 36), "00:00:01.5");
        // Lengths as ffmpeg prints them, rounded.
        let whole = |text: &str, rate, count| text.parse::<TimeRanges>().unwrap().beyond(rate, count);
        assert_eq!(whole("00:00:00-00:00:06.67", FrameRate { frames: 30, seconds: 1 }, 200), None);
        assert_eq!(whole("00:00:00-00:00:03.34", NTSC, 100), None);
        assert_eq!(beyond("00:00:01").as_deref(), Some("00:00:01"));
        let begins = [0, 40, 100, 1000].map(|milliseconds: u64| milliseconds * 1_000_000);
        let among = |text: &str| text.parse::<TimeRanges>().unwrap().beyond_among(&begins);
        assert_eq!((among("00:00:00-00:00:02.8"), among("00:00:02.7")), (None, None));
        assert_eq!(among("00:00:00-00:00:02.81").as_deref(), Some("00:00:00-00:00:02.81"));
        assert_eq!(among("00:00:02.9").as_deref(), Some("00:00:02.9"));
    }

    #[test]
    fn times_and_numbers_are_told_apart() {
        assert!(["00:00:01", "0:00:01-0:00:02", "0:0:1.5,0:0:2"].into_iter().all(TimeRanges::are_meant));
        // Times without hours are refused as such.
        assert!(["00:00.2", "00:01-00:02", "1:30.5-1:31"].into_iter().all(TimeRanges::are_meant));
        assert!(refused("00:01-00:02").contains("no time of hours:minutes:seconds"));
        assert!(!["1-10:2", "5", "1:3", "", "1-3,7-20:2"].into_iter().any(TimeRanges::are_meant));
    }

    #[test]
    fn what_is_no_time() {
        assert!(refused("00:00:02-00:00:01").contains("is not after 00:00:02"));
        assert!(refused("00:00:02-00:00:02").contains("is not after 00:00:02"));
        for wrong in
            ["00:60:00", "00:00:60", "00:00:", "a:b:c", "00:00:01-5", "00:00:1.0000000001", "00:00:1.", "-0:0:1"]
        {
            assert!(refused(wrong).contains("no time of hours:minutes:seconds"), "{wrong}");
        }
    }
}
