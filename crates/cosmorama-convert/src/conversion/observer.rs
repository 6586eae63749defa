use crate::diagnostic::Diagnostic;

/// Watches a conversion while it runs.
pub trait Observer {
    /// Learns how many frames are to be made, before the first.
    fn begin(&mut self, _frames: usize) {}

    /// Learns what should be known.
    fn diagnostic(&mut self, _diagnostic: &Diagnostic) {}

    /// Learns that a frame is written; `None` is one without a number.
    fn frame_done(&mut self, _frame: Option<u64>) {}

    /// Learns how many bytes all frames in flight take at most, before the first of a sequence: memory of one that is done is as
    /// large as what the next one wants.
    fn memory_in_flight(&mut self, _bytes: u64) {}
}

/// Watches nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Quiet;

impl Observer for Quiet {}
