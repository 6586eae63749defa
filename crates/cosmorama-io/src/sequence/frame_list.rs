use std::fmt;
use std::str::FromStr;

use crate::IoError;

/// Frame numbers in the order in which they were asked for, each once: `1-3,5,7-20:2`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FrameList(Vec<u64>);

/// The largest number of a frame: a larger one is a date or a hash.
pub(super) const LAST_FRAME: u64 = u32::MAX as u64;

/// More frames than any film has: a slip of the finger.
const MOST: u64 = 10_000_000;

impl FrameList {
    /// These frames.
    pub fn new(frames: impl IntoIterator<Item = u64>) -> Self {
        let mut seen = std::collections::HashSet::new();
        Self(frames.into_iter().filter(|frame| seen.insert(*frame)).collect())
    }

    /// The numbers.
    pub fn frames(&self) -> &[u64] {
        &self.0
    }
}

impl FromStr for FrameList {
    type Err = IoError;

    fn from_str(text: &str) -> Result<Self, IoError> {
        let fail = |reason: String| IoError::FrameList { list: text.to_owned(), reason };
        let mut frames = Vec::new();
        for part in text.split(',').map(str::trim) {
            let range = Range::parse(part).map_err(fail)?;
            if range.len() + frames.len() as u64 > MOST {
                return Err(fail(format!("more than {MOST} frames")));
            }
            frames.extend((range.first..=range.last).step_by(range.step));
        }
        Ok(Self::new(frames))
    }
}

struct Range {
    first: u64,
    last: u64,
    step: usize,
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

    fn len(&self) -> u64 {
        (self.last - self.first) / self.step as u64 + 1
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
            None if text.contains(char::is_whitespace) => "; put commas between".to_owned(),
            None => String::new(),
        };
        return Err(format!("{text} is not a frame number{hint}"));
    }
    text.parse().ok().filter(|frame| *frame <= LAST_FRAME).ok_or_else(|| format!("{text} is too large"))
}

/// What to write for all frames between two.
fn meant(first: u64, last: u64) -> String {
    if first < last { format!("for frames {first} to {last} write {first}-{last}") } else { format!("write {first}") }
}

/// The shortest list that stands for the same frames: runs become ranges.
impl fmt::Display for FrameList {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut rest = &self.0[..];
        let mut separator = "";
        while let Some(&first) = rest.first() {
            let run = rest.iter().zip(first..).take_while(|(frame, expected)| **frame == *expected).count();
            let last = rest[run - 1];
            match run {
                1 => write!(f, "{separator}{first}")?,
                2 => write!(f, "{separator}{first},{last}")?,
                _ => write!(f, "{separator}{first}-{last}")?,
            }
            separator = ",";
            rest = &rest[run..];
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Vec<u64> {
        text.parse::<FrameList>().unwrap().frames().to_vec()
    }

    fn refused(text: &str) -> String {
        text.parse::<FrameList>().unwrap_err().to_string()
    }

    #[test]
    fn the_grammar_of_the_manual() {
        assert_eq!(parsed("5"), [5]);
        assert_eq!(parsed("1-4"), [1, 2, 3, 4]);
        assert_eq!(parsed("1-3,5,7-12:2"), [1, 2, 3, 5, 7, 9, 11]);
        assert_eq!(parsed("7-12x2, 7"), [7, 9, 11]);
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

    #[test]
    fn runs_are_shown_as_ranges() {
        assert_eq!(FrameList::new([1, 2, 3, 5, 7, 8]).to_string(), "1-3,5,7,8");
        assert_eq!(FrameList::new([]).to_string(), "");
    }
}
