//! Progress of work in the pool, told to an observer on the thread that runs the conversion.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Sender, channel};

use cosmorama::render::Progress;
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
