use std::fmt;
use std::str::FromStr;

use thiserror::Error;

use super::TimeRanges;

/// Frame numbers as typed, in the requested order: `1-3,5,7-20:2`.
///
/// ```
/// use cosmorama_spec::FrameRanges;
/// let ranges: FrameRanges = "1-3,5,7-12:2".parse()?;
/// assert_eq!(ranges.frames().collect::<Vec<_>>(), [1, 2, 3, 5, 7, 9, 11]);
/// assert_eq!(ranges.to_string(), "1-3,5,7-12:2");
/// # Ok::<(), cosmorama_spec::FrameRangesError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FrameRanges(Vec<Range>);

/// Reason why a list of frames cannot be understood.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("frames {list}: {reason}; expected a list such as 5, 1-10 or 1-3,5,7-20:2; all frames are the default")]
pub struct FrameRangesError {
    /// List as typed.
    pub list: String,
    /// Description of the mistake.
    pub reason: String,
}

/// Largest frame number; a larger number is a date or a hash.
const LAST_FRAME: u64 = u32::MAX as u64;

/// Greatest number of frames; more is a typing error.
const MOST: u64 = 10_000_000;

impl FrameRanges {
    /// Returns the numbers, range by range; a number in two ranges occurs twice.
    pub fn frames(&self) -> impl Iterator<Item = u64> {
        self.0.iter().flat_map(|range| range.frames())
    }
}

impl fmt::Display for FrameRanges {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, range) in self.0.iter().enumerate() {
            let separator = if index == 0 { "" } else { "," };
            write!(f, "{separator}{range}")?;
        }
        Ok(())
    }
}

impl FromStr for FrameRanges {
    type Err = FrameRangesError;

    fn from_str(text: &str) -> Result<Self, FrameRangesError> {
        let fail = |reason: String| FrameRangesError { list: text.to_owned(), reason };
        if TimeRanges::are_meant(text) {
            return Err(fail("these are times, but frames are chosen by their numbers here".to_owned()));
        }
        let (mut ranges, mut count) = (Vec::new(), 0);
        for part in text.split(',').map(str::trim) {
            let range = Range::parse(part).map_err(fail)?;
            count += range.len();
            if count > MOST {
                return Err(fail(format!("more than {MOST} frames")));
            }
            ranges.push(range);
        }
        Ok(Self(ranges))
    }
}

/// Frame numbers from the first to the last, by a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Range {
    first: u64,
    last: u64,
    step: usize,
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self { first, last, step: 1 } if first == last => write!(f, "{first}"),
            Self { first, last, step: 1 } => write!(f, "{first}-{last}"),
            Self { first, last, step } => write!(f, "{first}-{last}:{step}"),
        }
    }
}

impl Range {
    fn parse(part: &str) -> Result<Self, String> {
        let (range, step) = match part.split_once([':', 'x']) {
            Some((range, step)) => (range, Some(number(step)?)),
            None => (part, None),
        };
        let (first, last) = match (range.split_once('-'), step) {
            (Some((first, last)), _) => (number(first)?, number(last)?),
            (None, None) => (number(range)?, number(range)?),
            // In other programs a colon makes a range.
            (None, Some(step)) => {
                return Err(format!("{part} is one frame with a step; {}", meant(number(range)?, step)));
            }
        };
        let step = step.unwrap_or(1);
        if first > last {
            return Err(format!("{range} runs backwards; write {last}-{first}"));
        }
        match usize::try_from(step) {
            Ok(step) if step > 0 => Ok(Self { first, last, step }),
            _ => Err(format!("a step of {step} in {part}")),
        }
    }

    fn len(self) -> u64 {
        (self.last - self.first) / self.step as u64 + 1
    }

    fn frames(self) -> impl Iterator<Item = u64> {
        (self.first..=self.last).step_by(self.step)
    }
}

fn number(text: &str) -> Result<u64, String> {
    let text = text.trim();
    if text.is_empty() {
        return Err("a number is missing".to_owned());
    }
    if !text.bytes().all(|byte| byte.is_ascii_digit()) {
        let dotted = text.split_once("..").and_then(|(first, last)| Some((first.parse().ok()?, last.parse().ok()?)));
        let hint = match dotted {
            Some((first, last)) => format!("; {}", meant(first, last)),
            None if is_time(text) => "; convert takes times of a video, written as in 00:00:01.5-00:00:02".to_owned(),
            None if text.contains(char::is_whitespace) => "; put commas between".to_owned(),
            None => String::new(),
        };
        return Err(format!("{text} is not a frame number{hint}"));
    }
    text.parse().ok().filter(|frame| *frame <= LAST_FRAME).ok_or_else(|| format!("{text} is too large"))
}

/// Returns whether somebody means seconds: a decimal number, or one with a unit.
fn is_time(text: &str) -> bool {
    let number = text.strip_suffix("ms").or(text.strip_suffix('s')).unwrap_or(text);
    number.starts_with(|first: char| first.is_ascii_digit())
        && number.bytes().all(|byte| byte.is_ascii_digit() || byte == b'.')
        && number.matches('.').count() < 2
}

/// Returns the text for all frames between two numbers.
fn meant(first: u64, last: u64) -> String {
    if first < last { format!("for frames {first} to {last} write {first}-{last}") } else { format!("write {first}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_means_seconds_is_told_how_times_are_written() {
        for (text, is_time) in [
            ("0.5s-1s", true),
            ("1.5", true),
            ("500ms-1s", true),
            ("1e3", false),
            ("+5", false),
            ("all", false),
            ("a.b", false),
        ] {
            let told = text.parse::<FrameRanges>().unwrap_err().to_string();
            assert_eq!(told.contains("00:00:01.5-00:00:02"), is_time, "{told}");
        }
    }

    fn parsed(text: &str) -> Vec<u64> {
        text.parse::<FrameRanges>().unwrap().frames().collect()
    }

    fn refused(text: &str) -> String {
        text.parse::<FrameRanges>().unwrap_err().to_string()
    }

    #[test]
    fn the_grammar_of_the_manual() {
        assert_eq!(parsed("5"), [5]);
        assert_eq!(parsed("1-4"), [1, 2, 3, 4]);
        assert_eq!(parsed("1-3,5,7-12:2"), [1, 2, 3, 5, 7, 9, 11]);
        assert_eq!(parsed("7-12x2, 7"), [7, 9, 11, 7]);
        assert_eq!(parsed("0001-0002"), [1, 2]);
    }

    #[test]
    fn what_is_no_list() {
        assert!(refused("9-3").contains("write 3-9"));
        assert!(refused("").contains("missing"));
        assert!(refused("1,,2").contains("missing"));
        assert!(refused("1-5:0").contains("step of 0"));
        assert!(refused("1:3").contains("1:3 is one frame with a step; for frames 1 to 3 write 1-3;"));
        assert!(refused("4,5x2").contains("5x2 is one frame with a step; write 5;"));
        assert!(refused("1..3").contains("for frames 1 to 3 write 1-3;"));
        assert!(refused("1-3 4").contains("put commas between"));
        assert!(refused("a-b").contains("not a frame number"));
        assert!(refused("0-4000000000").contains("more than"));
        assert!(refused("99999999999999999999").contains("too large"));
        assert!(refused("0-18446744073709551615").contains("too large"));
    }
}
