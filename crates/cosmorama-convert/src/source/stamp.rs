use std::path::Path;
use std::time::SystemTime;

/// Length of a file and the time of its last change: where they stay, its bytes have stayed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stamp {
    length: u64,
    /// Time, as the clock of the file's disk had it. Clocks are set forward and back: an order of times proves nothing.
    changed: Option<SystemTime>,
}

impl Stamp {
    /// Returns the stamp of a file on disk; `None` if there is none.
    pub(crate) fn of(path: &Path) -> Option<Self> {
        let found = std::fs::metadata(path).ok()?;
        Some(Self { length: found.len(), changed: found.modified().ok() })
    }

    /// Returns whether a file was changed before another, as far as clocks tell.
    pub(crate) fn is_before(self, other: Self) -> bool {
        self.changed.zip(other.changed).is_some_and(|(changed, other)| changed < other)
    }
}
