//! Progress of work in the pool, told to an observer on the thread that runs the conversion.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Sender, channel};

use cosmorama::camera::View;
use cosmorama::render::{Progress, Share};
use rayon::ThreadPool;

use super::{Observer, Work};

/// Does work in a pool while an observer, which stays on this thread, is told how far it is. `None` if the observer stops it.
pub(crate) fn watched<T: Send>(
    pool: &ThreadPool,
    observer: &mut dyn Observer,
    work: Work,
    make: impl FnOnce(&dyn Progress) -> T + Send,
) -> Option<T> {
    if observer.advance(work, 0.0).is_break() {
        return None;
    }
    let (sender, fractions) = channel();
    let stopped = AtomicBool::new(false);
    let (mut made, mut told) = (None, 0.0);
    pool.in_place_scope(|scope| {
        let (made, stopped) = (&mut made, &stopped);
        scope.spawn(move |_| *made = Some(make(&Reporter { sender, stopped })));
        while let Ok(fraction) = fractions.recv() {
            // While the observer was busy there may have been several.
            told = fractions.try_iter().last().unwrap_or(fraction);
            if observer.advance(work, told).is_break() {
                stopped.store(true, Ordering::Relaxed);
                break;
            }
        }
    });
    // Where there was nothing to do, nothing was told.
    let is_stopped = stopped.into_inner() || told < 1.0 && observer.advance(work, 1.0).is_break();
    made.filter(|_| !is_stopped)
}

/// The end of a channel at which work is done.
struct Reporter<'a> {
    sender: Sender<f64>,
    stopped: &'a AtomicBool,
}

impl Progress for Reporter<'_> {
    fn advance(&self, fraction: f64) -> ControlFlow<()> {
        // Nobody listens any more once the work is stopped.
        if self.stopped.load(Ordering::Relaxed) || self.sender.send(fraction).is_err() {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }
}

/// Splits the progress of work on several views by their pixels, in the order in which they are made.
pub(crate) struct Shares<'a> {
    whole: &'a dyn Progress,
    pixels: usize,
    begun: usize,
}

impl<'a> Shares<'a> {
    pub(crate) fn new<'v>(whole: &'a dyn Progress, views: impl Iterator<Item = &'v View>) -> Self {
        Self { whole, pixels: views.map(pixels).sum(), begun: 0 }
    }

    /// Returns the share of the next view.
    pub(crate) fn next(&mut self, view: &View) -> Share<'a> {
        let at = |begun: usize| begun as f64 / self.pixels as f64;
        let (from, to) = (at(self.begun), at(self.begun + pixels(view)));
        self.begun += pixels(view);
        Share { whole: self.whole, from, to }
    }
}

fn pixels(view: &View) -> usize {
    view.width() * view.height()
}
