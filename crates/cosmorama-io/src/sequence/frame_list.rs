use std::fmt;

/// Frame numbers without duplicates, in the requested order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FrameList(Vec<u64>);

/// Largest frame number; a larger number is a date or a hash.
pub(super) const LAST_FRAME: u64 = u32::MAX as u64;

impl FrameList {
    /// Creates a list of these frames.
    pub fn new(frames: impl IntoIterator<Item = u64>) -> Self {
        let mut seen = std::collections::HashSet::new();
        Self(frames.into_iter().filter(|frame| seen.insert(*frame)).collect())
    }

    /// Returns the numbers.
    pub fn frames(&self) -> &[u64] {
        &self.0
    }
}

/// Prints the shortest list of the same frames, with ranges for runs.
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

    #[test]
    fn runs_are_shown_as_ranges() {
        assert_eq!(FrameList::new([1, 2, 3, 5, 7, 8]).to_string(), "1-3,5,7,8");
        assert_eq!(FrameList::new([]).to_string(), "");
    }
}
