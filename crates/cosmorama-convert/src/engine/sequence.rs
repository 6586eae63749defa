//! Frames in order through three stages that overlap.
//!
//! One scheduling thread has files read ahead, filters the current frame, and has pictures written behind. All work runs in
//! one thread pool, so that codecs and the filter share the cores. Pool threads never block on a queue; only the scheduling
//! thread does. Both queues are bounded, and keep the frames' order.

use std::collections::VecDeque;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};

use rayon::{Scope, ThreadPool};

use crate::budget::QueueDepth;
use crate::conversion::ConvertJob;
use crate::diagnostic::{InPlace, Result, bail};
use crate::engine::{Engine, FrameFile, FrameLight, Levels, Stage, Stages, ViewImage, Which};
use crate::output::FrameOutputs;

/// The frames of a job, as they are made.
pub(crate) struct Sequence<'a> {
    pub(crate) job: &'a ConvertJob,
    pub(crate) engine: &'a Engine<'a>,
    pub(crate) stages: &'a Stages,
    pub(crate) pool: &'a ThreadPool,
}

/// Watches frames while they are made, in their order.
pub(crate) trait Watcher {
    /// Learns how many bytes frames in flight take.
    fn begin(&mut self, bytes: u64);

    /// Looks at the light of a frame.
    fn look(&mut self, frame: &FrameOutputs, light: &FrameLight);

    /// Learns that a frame is written.
    fn done(&mut self, frame: &FrameOutputs);
}

/// What comes of tasks that were given to the pool.
type Results<T> = Vec<Receiver<Result<T>>>;

/// Frames that are being read, with their place in the sequence, and those that are being written; each by its outputs and its files.
#[derive(Default)]
struct Queues<'a> {
    read: VecDeque<(usize, &'a FrameOutputs, Results<Vec<ViewImage>>)>,
    written: VecDeque<(&'a FrameOutputs, Results<Levels>)>,
}

impl<'a> Sequence<'a> {
    /// Makes all frames. The first error ends it: frames before that one are finished, none is begun any more; those under
    /// way are finished.
    pub(crate) fn run(&self, watcher: &mut dyn Watcher) -> Result<()> {
        let failure = &FirstFailure::none();
        let mut queues = Queues::default();
        self.pool.in_place_scope(|scope| {
            let made = self.make(scope, failure, &mut queues, watcher);
            // What is being written belongs to frames before the one that failed: their errors come first. Where one of them has failed,
            // what `made` says of a later one, whose files were not read for that, is of no interest.
            let earlier = queues.finish_written(0, watcher);
            failure.end();
            earlier.and(made)
        })
    }

    fn make<'s>(
        &self,
        scope: &Scope<'s>,
        failure: &'s FirstFailure,
        queues: &mut Queues<'a>,
        watcher: &mut dyn Watcher,
    ) -> Result<()>
    where
        'a: 's,
    {
        let QueueDepth { read, written, bytes } = self.engine.queue_depth(self.pool.current_num_threads());
        watcher.begin(bytes);
        let mut light = self.engine.frame_light();
        let mut upcoming = (1..).zip(&self.job.outputs.frames);
        let mut which = Which::All;
        loop {
            while queues.read.len() < read {
                let Some((place, frame)) = upcoming.next() else { break };
                queues.read.push_back((place, frame, self.have_read((scope, failure, place), frame, which)));
                which = Which::Moving;
            }
            let Some((place, frame, results)) = queues.read.pop_front() else { return Ok(()) };
            if failure.is_before(place) {
                // Whoever waits for that frame learns why.
                return Ok(());
            }
            // So that no files of later frames are read while earlier frames are written; of its own files' errors the tasks tell.
            let failed = |error| {
                failure.note(place);
                error
            };
            let images = all_of(results).at(|| told(frame))?;
            let images: Vec<ViewImage> = images.into_iter().flatten().collect();
            let filled = self.pool.install(|| light.fill(self.job, frame.frame, &images, self.stages));
            filled.at(|| told(frame)).map_err(failed)?;
            drop(images);
            watcher.look(frame, &light);
            let used = queues.finish_written(written - 1, watcher)?;
            if failure.is_before(place) {
                return Ok(());
            }
            let made = self.pool.install(|| self.engine.render(frame, &light, used));
            let pictures = made.at(|| told(frame)).map_err(failed)?;
            queues.written.push_back((frame, self.have_written((scope, failure, place), frame, pictures)));
        }
    }

    /// Has the files of a frame read.
    fn have_read<'s>(&self, turn: Turn<'_, 's>, frame: &FrameOutputs, which: Which) -> Results<Vec<ViewImage>>
    where
        'a: 's,
    {
        let Self { job, stages, .. } = *self;
        let files = FrameFile::all(job, frame.frame, which).into_iter();
        let read = |file: FrameFile| task(turn, move || stages.beside(Stage::Decode, || file.read(job)));
        files.map(read).collect()
    }

    /// Has the pictures of a frame written.
    fn have_written<'s>(&self, turn: Turn<'_, 's>, frame: &'a FrameOutputs, pictures: Vec<Levels>) -> Results<Levels>
    where
        'a: 's,
    {
        let Self { engine, stages, .. } = *self;
        let write = |((_, path), levels): (&'a (usize, std::path::PathBuf), Levels)| {
            let path: &'a Path = path;
            task(turn, move || stages.beside(Stage::Encode, || engine.writer().save_and_hand_on(levels, path)))
        };
        frame.files.iter().zip(pictures).map(write).collect()
    }
}

impl Queues<'_> {
    /// Waits until no more than so many frames are being written; the pictures of the last that is, which nobody uses any more.
    /// After one that fails none is waited for: what becomes of later ones is told by nobody.
    fn finish_written(&mut self, most: usize, watcher: &mut dyn Watcher) -> Result<Vec<Levels>> {
        let mut used = Vec::new();
        while self.written.len() > most {
            let Some((frame, results)) = self.written.pop_front() else { break };
            used = all_of(results).at(|| told(frame)).inspect_err(|_| self.written.clear())?;
            watcher.done(frame);
        }
        Ok(used)
    }
}

/// Which frame is the first that failed, by its place: they count from one.
struct FirstFailure(AtomicUsize);

impl FirstFailure {
    fn none() -> Self {
        Self(AtomicUsize::new(usize::MAX))
    }

    fn note(&self, place: usize) {
        self.0.fetch_min(place, Ordering::Relaxed);
    }

    /// Nobody wants anything any more.
    fn end(&self) {
        self.note(0);
    }

    /// Whether one before this has failed, so that nobody wants this one any more.
    fn is_before(&self, place: usize) -> bool {
        self.0.load(Ordering::Relaxed) < place
    }
}

/// Where the tasks of a frame go, what they are to mind, and its place.
type Turn<'t, 's> = (&'t Scope<'s>, &'s FirstFailure, usize);

/// Gives a task to the pool. Once a frame before its own has failed, it is not begun.
fn task<'s, T: Send + 's>(
    (scope, failure, place): Turn<'_, 's>,
    work: impl FnOnce() -> Result<T> + Send + 's,
) -> Receiver<Result<T>> {
    let (result, receiver): (SyncSender<Result<T>>, _) = sync_channel(1);
    scope.spawn(move |_| {
        if failure.is_before(place) {
            return;
        }
        let done = work();
        if done.is_err() {
            failure.note(place);
        }
        // Nobody waits for it any more where another has failed.
        let _ = result.send(done);
    });
    receiver
}

/// Waits for tasks; the error of the first that failed.
fn all_of<T>(results: Results<T>) -> Result<Vec<T>> {
    let wait = |result: Receiver<Result<T>>| match result.recv() {
        Ok(result) => result,
        // It was not begun, since a frame before has failed, which is told first; or it has panicked, which the scope tells.
        Err(_) => bail!("a thread has given up"),
    };
    results.into_iter().map(wait).collect()
}

/// A frame, as errors name it.
fn told(frame: &FrameOutputs) -> String {
    frame.frame.map_or_else(|| "the frame".to_owned(), |number| format!("frame {number}"))
}
