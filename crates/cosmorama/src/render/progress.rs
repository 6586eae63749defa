//! Progress of long work, and whether it is to go on.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use thiserror::Error;

/// Receiver of reports on long work, which may stop it. Closures are receivers.
pub trait Progress: Sync {
    /// Receives the fraction of the work that is done, after each part.
    ///
    /// Fractions never fall, and the last is 1. Calls come from the threads that work, one at a time. They must return
    /// soon, and start no parallel work. After `Break` there is no further call, no further part is begun, and the work
    /// returns [`Stopped`].
    fn advance(&self, fraction: f64) -> ControlFlow<()>;
}

impl<F: Fn(f64) -> ControlFlow<()> + Sync> Progress for F {
    fn advance(&self, fraction: f64) -> ControlFlow<()> {
        self(fraction)
    }
}

/// Error of work that its [`Progress`] stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("stopped before the end, as was asked for")]
pub struct Stopped;

/// Progress of one task among several that follow one another.
pub struct Share<'a> {
    /// Progress of all tasks.
    pub whole: &'a dyn Progress,
    /// Fraction of the whole before this task.
    pub from: f64,
    /// Fraction of the whole after it.
    pub to: f64,
}

impl<'a> Share<'a> {
    /// Returns the share of the task at a place among so many that take equally long.
    pub fn of(whole: &'a dyn Progress, (place, count): (usize, usize)) -> Self {
        let at = |place: usize| place as f64 / count.max(1) as f64;
        Self { whole, from: at(place), to: at(place + 1) }
    }
}

impl Progress for Share<'_> {
    fn advance(&self, fraction: f64) -> ControlFlow<()> {
        self.whole.advance(between(self.from, self.to, fraction))
    }
}

/// Interpolates so that neither end is missed by rounding.
fn between(from: f64, to: f64, fraction: f64) -> f64 {
    from * (1.0 - fraction) + to * fraction
}

/// Receiver of the progress of work, if anybody watches it, and the work's stretch of the whole.
#[derive(Clone, Copy)]
pub(crate) struct Watch<'a> {
    watcher: Option<(&'a dyn Progress, &'a AtomicBool)>,
    from: f64,
    to: f64,
}

impl<'a> Watch<'a> {
    /// Work that nobody watches.
    pub(crate) const NONE: Self = Self { watcher: None, from: 0.0, to: 1.0 };

    /// Does work that is watched.
    pub(crate) fn over<T>(progress: &dyn Progress, work: impl FnOnce(Watch) -> T) -> Result<T, Stopped> {
        let stopped = AtomicBool::new(false);
        let made = work(Watch { watcher: Some((progress, &stopped)), ..Watch::NONE });
        if stopped.into_inner() || progress.advance(1.0).is_break() { Err(Stopped) } else { Ok(made) }
    }

    /// Returns one of `of` tasks of this work, all of which take equally long.
    pub(crate) fn task(self, index: usize, of: usize) -> Self {
        let at = |tasks: usize| between(self.from, self.to, tasks as f64 / of as f64);
        Self { from: at(index), to: at(index + 1), ..self }
    }

    /// Returns the parts of this work, which may be done on several threads.
    pub(crate) fn parts(self, of: usize) -> Parts<'a> {
        Parts { watch: self, of, done: Mutex::new(0) }
    }

    /// Returns whether the work is to stop.
    pub(crate) fn is_stopped(self) -> bool {
        self.watcher.is_some_and(|(_, stopped)| stopped.load(Ordering::Relaxed))
    }
}

/// Parts of a piece of work, counted as they are done.
pub(crate) struct Parts<'a> {
    watch: Watch<'a>,
    of: usize,
    done: Mutex<usize>,
}

impl Parts<'_> {
    /// Does a part and reports it; `None` if the work is stopped.
    pub(crate) fn part<T>(&self, work: impl FnOnce() -> T) -> Option<T> {
        if self.watch.is_stopped() {
            return None;
        }
        let made = work();
        if let Some((progress, stopped)) = self.watch.watcher {
            let mut done = self.done.lock().unwrap_or_else(PoisonError::into_inner);
            *done += 1;
            let fraction = between(self.watch.from, self.watch.to, *done as f64 / self.of as f64);
            // The end of all work is reported by `Watch::over`, once nothing runs any more.
            if fraction < 1.0 && !self.watch.is_stopped() && progress.advance(fraction).is_break() {
                stopped.store(true, Ordering::Relaxed);
            }
        }
        Some(made)
    }
}
