use std::ops::ControlFlow;

use crate::diagnostic::{Decision, Diagnostic};

/// Request of an observer to end a conversion before its last frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stop;

/// Long work of a conversion, of which it tells how far it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Work {
    /// Looking for what the input lacks for the frames of a moving camera.
    Path,
    /// Compiling the geometry that all frames share.
    Plan,
    /// Rendering the pictures of a frame; `None` for one without a number.
    Render(Option<u64>),
    /// Measuring filters.
    Filters,
}

/// Callbacks of a running conversion, all on the thread that runs it.
pub trait Observer {
    /// Receives the number of frames to make, before the first; `None` if they go on until a stream ends.
    fn begin(&mut self, _frames: Option<usize>) {}

    /// Receives a diagnostic.
    fn diagnostic(&mut self, _diagnostic: &Diagnostic) {}

    /// Receives a decision, with its reason.
    fn decided(&mut self, _decision: &Decision) {}

    /// Receives the fraction of a work that is done, while it goes on. The result says whether to go on.
    ///
    /// The fractions of one work begin with 0, never fall, and end with 1. Pictures are made band by band, so that even a single one
    /// makes progress. After `Break(Stop)` the work ends within a band, and its frame is not written. Frames before it are
    /// finished and reported. [`run`](crate::Checked::run) then returns
    /// [`ConvertError::Stopped`](crate::ConvertError::Stopped).
    fn advance(&mut self, _work: Work, _fraction: f64) -> ControlFlow<Stop> {
        ControlFlow::Continue(())
    }

    /// Receives the number of a frame that is written; `None` for one without a number. The result says whether to go
    /// on.
    ///
    /// After `Break(Stop)` no further frame and no further file is started. Files that are being written are finished, or taken
    /// away where they wait for their turn at the disk, and no partial file stays behind. [`run`](crate::Checked::run) then returns
    /// [`ConvertError::Stopped`](crate::ConvertError::Stopped), unless this was the last frame.
    fn frame_done(&mut self, _frame: Option<u64>) -> ControlFlow<Stop> {
        ControlFlow::Continue(())
    }
}

/// An observer that ignores everything.
#[derive(Clone, Copy, Debug, Default)]
pub struct Quiet;

impl Observer for Quiet {}
