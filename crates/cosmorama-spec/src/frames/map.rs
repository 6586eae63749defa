use std::fmt;
use std::str::FromStr;

/// Frame of one sequence for each frame of another: `step`, `hold` or `loop`, with an offset, as `loop+12`.
///
/// ```
/// use cosmorama_spec::FrameMap;
/// let map: FrameMap = "loop+1".parse()?;
/// assert_eq!([1, 2, 3].map(|frame| map.frame(frame, &[1, 2, 3])), [Some(2), Some(3), Some(1)]);
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrameMap {
    /// Frames before the first that there is, and after the last.
    pub ends: FrameEnds,
    /// Number that is added to a frame.
    pub offset: i64,
}

/// Frames before the first that a sequence has, and after the last.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FrameEnds {
    /// There are none: each frame goes with the frame of its number.
    #[default]
    Step,
    /// The first frame stands before it, and the last one after it.
    Hold,
    /// The sequence is repeated.
    Loop,
}

/// Greatest offset; a larger number is a typing error.
const MOST: i64 = 10_000_000;

const EXPECTED: &str = "expected step, hold or loop, and perhaps frames to be added, as in loop, +12 or hold-5";

impl FrameMap {
    /// Returns the frame that goes with a frame, of those that there are, in ascending order; `None` if there is none.
    pub fn frame(&self, frame: u64, all: &[u64]) -> Option<u64> {
        let (first, last) = (i64::try_from(*all.first()?).ok()?, i64::try_from(*all.last()?).ok()?);
        let wanted = i64::try_from(frame).ok()?.checked_add(self.offset)?;
        let found = match self.ends {
            FrameEnds::Step => wanted,
            FrameEnds::Hold => wanted.clamp(first, last),
            FrameEnds::Loop => first + (wanted - first).rem_euclid(last - first + 1),
        };
        u64::try_from(found).ok().filter(|found| all.binary_search(found).is_ok())
    }
}

impl fmt::Display for FrameMap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ends = match self.ends {
            FrameEnds::Step => "step",
            FrameEnds::Hold => "hold",
            FrameEnds::Loop => "loop",
        };
        if self.offset == 0 { f.write_str(ends) } else { write!(f, "{ends}{:+}", self.offset) }
    }
}

impl FromStr for FrameMap {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("'{text}' is no rule for frames; {EXPECTED}");
        let (word, offset) = text.split_at(text.find(['+', '-']).unwrap_or(text.len()));
        let ends = match word {
            "step" => FrameEnds::Step,
            "" if !offset.is_empty() => FrameEnds::Step,
            "hold" => FrameEnds::Hold,
            "loop" => FrameEnds::Loop,
            _ => return Err(wrong()),
        };
        let offset: i64 = if offset.is_empty() { 0 } else { offset.parse().map_err(|_| wrong())? };
        if offset.abs() > MOST { Err(wrong()) } else { Ok(Self { ends, offset }) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_are_read_and_written() {
        for text in ["step", "hold", "loop", "step+3", "hold-12", "loop+1"] {
            assert_eq!(text.parse::<FrameMap>().unwrap().to_string(), text);
        }
        assert_eq!("+3".parse::<FrameMap>().unwrap().to_string(), "step+3");
        for text in ["", "mirror", "hold+", "loop+x", "loop 3", "+99999999999", "hold+1+1"] {
            assert!(text.parse::<FrameMap>().unwrap_err().contains("expected step, hold or loop"), "{text}");
        }
    }

    #[test]
    fn frames_go_with_frames() {
        let mapped = |rule: &str, all: &[u64]| {
            let map: FrameMap = rule.parse().unwrap();
            [0, 4, 5, 7, 8, 13].map(|frame| map.frame(frame, all))
        };
        let all = [5, 6, 7];
        assert_eq!(mapped("step", &all), [None, None, Some(5), Some(7), None, None]);
        assert_eq!(mapped("+1", &all), [None, Some(5), Some(6), None, None, None]);
        assert_eq!(mapped("hold", &all), [5, 5, 5, 7, 7, 7].map(Some));
        assert_eq!(mapped("loop", &all), [6, 7, 5, 7, 5, 7].map(Some));
        assert_eq!(mapped("loop-5", &all), [7, 5, 6, 5, 6, 5].map(Some));
        // A frame that lacks within the sequence is not held.
        assert_eq!(mapped("hold", &[5, 7]), [5, 5, 5, 7, 7, 7].map(Some));
        assert_eq!(mapped("+1", &[5, 7])[2], None);
    }
}
