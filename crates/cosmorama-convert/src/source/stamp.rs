use std::path::Path;
use std::time::SystemTime;

/// Length of a file and the time of its last change: where they stay, its bytes have stayed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stamp {
    length: u64,
    /// Time, as the clock of the file's disk had it. Only equal times tell anything: clocks are set forward and back.
    changed: Option<SystemTime>,
}

impl Stamp {
    /// Returns the stamp of a file on disk; `None` if there is none.
    pub(crate) fn of(path: &Path) -> Option<Self> {
        let found = std::fs::metadata(path).ok()?;
        Some(Self { length: found.len(), changed: found.modified().ok() })
    }
}
