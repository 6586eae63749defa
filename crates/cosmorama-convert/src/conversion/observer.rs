use std::ops::ControlFlow;

use crate::diagnostic::Diagnostic;

/// Request of an observer to end a conversion before its last frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stop;

/// Callbacks of a running conversion.
pub trait Observer {
    /// Called with the number of frames to make, before the first.
    fn begin(&mut self, _frames: usize) {}

    /// Called with a diagnostic.
    fn diagnostic(&mut self, _diagnostic: &Diagnostic) {}

    /// Called when a frame is written; `None` for one without a number. The result says whether to go on.
    ///
    /// After `Break(Stop)` no further frame and no further file is started. Files that are being written are finished, and no
    /// partial file stays behind. [`run`](crate::Checked::run) then returns
    /// [`ConvertError::Stopped`](crate::ConvertError::Stopped), unless this was the last frame.
    fn frame_done(&mut self, _frame: Option<u64>) -> ControlFlow<Stop> {
        ControlFlow::Continue(())
    }
}

/// An observer that ignores everything.
#[derive(Clone, Copy, Debug, Default)]
pub struct Quiet;

impl Observer for Quiet {}
