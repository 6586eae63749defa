//! Frames in order through three stages that overlap.
//!
//! One scheduling thread has files read ahead, filters the current frame and encodes its light, and has pictures written behind. All work runs in
//! one thread pool, so that codecs and the filter share the cores. Pool threads never block on a queue; only the scheduling
//! thread does. They do not wait for disks; the threads of a second pool do. All queues are bounded, and keep the frames' order.

use std::borrow::Cow;
use std::collections::VecDeque;
use std::iter::Peekable;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TryRecvError, sync_channel};

use cosmorama::raster::Threads;
use cosmorama_io::pending::Hidden;
use rayon::{Scope, ThreadPool};

use crate::diagnostic::{InPlace, Result, bail};
use crate::engine::frame::files::named;
use crate::engine::lighting::between::{Between, InterpolationReport};
use crate::engine::{Engine, FrameFile, FrameLight, FrameWords, Levels, Spent, Stage, Stages, ViewImage, Which};
use crate::job::{ConvertJob, FrameOutputs, Outputs, QueueDepth};
use crate::source::video::{Coming, FrameName};

/// The frames of a job while they are made.
pub(crate) struct Sequence<'a> {
    pub(crate) job: &'a ConvertJob,
    pub(crate) engine: &'a Engine<'a>,
    pub(crate) stages: &'a Stages,
    pub(crate) pool: &'a ThreadPool,
    /// Threads that wait for disks, so that no core is idle meanwhile. Each waits for a file, whose picture is gone by then.
    pub(crate) disks: &'a ThreadPool,
}

/// Callbacks about frames, in their order.
pub(crate) trait Watcher {
    /// Looks at the light of a frame.
    fn look(&mut self, frame: &FrameOutputs, light: &FrameLight);

    /// Renders the pictures of a frame.
    fn render(&mut self, frame: &FrameOutputs, light: &FrameLight) -> Result<Vec<Levels>>;

    /// Receives a damaged frame of a video that is left out.
    fn left_out(&mut self, frame: &FrameOutputs);

    /// Receives a frame that is written. An error ends the sequence.
    fn done(&mut self, frame: &FrameOutputs) -> Result<()>;
}

/// Results of tasks in the pool, in their order.
struct Results<T> {
    here: Vec<Result<T>>,
    awaited: VecDeque<Receiver<Result<T>>>,
}

impl<T> Results<T> {
    fn of(awaited: VecDeque<Receiver<Result<T>>>) -> Self {
        Self { here: Vec::new(), awaited }
    }

    /// Returns whether no task is to be waited for.
    fn are_here(&mut self) -> bool {
        while let Some(first) = self.awaited.front() {
            let result = match first.try_recv() {
                Ok(result) => result,
                Err(TryRecvError::Empty) => return false,
                Err(TryRecvError::Disconnected) => Self::given_up(),
            };
            self.here.push(result);
            self.awaited.pop_front();
        }
        true
    }

    /// Waits for the tasks; returns the error of the first that failed.
    fn all(self) -> Result<Vec<T>> {
        let wait = |result: Receiver<Result<T>>| result.recv().unwrap_or_else(|_| Self::given_up());
        self.here.into_iter().chain(self.awaited.into_iter().map(wait)).collect()
    }

    /// Creates the result of a task that was not begun, since an earlier frame has failed, whose error is reported. Or it has panicked,
    /// which the scope reports.
    fn given_up() -> Result<T> {
        bail!("a thread has given up")
    }
}

/// Images of a file; `None` for a damaged frame of a video that is to be left out.
type FileImages = Option<Vec<ViewImage>>;

/// Frames in flight.
#[derive(Default)]
struct Queues<'a> {
    /// Index in the sequence, outputs and files' images of those that are read.
    read: VecDeque<(usize, Cow<'a, FrameOutputs>, Results<FileImages>)>,
    /// Ends of encoding of the files of those whose pictures may still be held: the last of those that are written.
    encoded: VecDeque<Vec<Receiver<()>>>,
    /// Outputs, and a result for each file, of those that are written.
    written: VecDeque<(Cow<'a, FrameOutputs>, Results<()>)>,
}

/// Frames that are still to be read, each with its place among all, from 1.
type Upcoming<'a> = Peekable<Box<dyn Iterator<Item = (usize, Cow<'a, FrameOutputs>)> + 'a>>;

impl<'a> Sequence<'a> {
    /// Makes all frames. The first error ends the run: frames before it are finished, those behind it may be, and no other is begun.
    pub(crate) fn run(&self, watcher: &mut dyn Watcher) -> Result<Vec<InterpolationReport>> {
        let failure = &FirstFailure::none();
        let mut queues = Queues::default();
        self.disks.in_place_scope(|disk| {
            self.pool.in_place_scope(|work| {
                let made = self.make(Turn { work, disk, failure, place: 0 }, &mut queues, watcher);
                // Frames that are still being written come before the one that failed, so that their errors come first. If
                // one of them has failed, the error in `made` says only that files of a later frame were not read.
                let earlier = queues.finish_written(0, watcher);
                failure.end();
                earlier.and(made)
            })
        })
    }

    fn make<'s>(
        &self,
        turn: Turn<'_, 's, '_>,
        queues: &mut Queues<'a>,
        watcher: &mut dyn Watcher,
    ) -> Result<Vec<InterpolationReport>>
    where
        'a: 's,
    {
        let failure = turn.failure;
        let QueueDepth { read, written, .. } = self.engine.queue_depth();
        let waiting = self.disks.current_num_threads().div_ceil(self.job.target.files.len().max(1));
        let mut light = self.engine.frame_light();
        let frames = &self.job.outputs.frames;
        let mut between = Between::new(frames, self.job.lighting.as_ref().and_then(|light| light.every));
        let mut upcoming = self.upcoming(&between);
        let mut which = Which::All;
        loop {
            while queues.read.len() < read && self.is_next_here(&mut upcoming, queues, watcher)? {
                let Some((place, frame)) = upcoming.next() else { break };
                let results = self.have_read(turn.of(place), &frame, which);
                queues.read.push_back((place, frame, results));
                which = Which::Moving;
            }
            let Some((place, frame, results)) = queues.read.pop_front() else { return Ok(between.reports()) };
            if failure.is_before(place) {
                // The error is reported where that frame is awaited.
                return Ok(between.reports());
            }
            // Notes the failure, so that no files of later frames are read while earlier frames are written. Errors in
            // the frame's own files are noted by their tasks.
            let failed = |error| {
                failure.note(place);
                error
            };
            let images = results.all().at(|| named(&frame))?;
            let Some(images) = images.into_iter().collect::<Option<Vec<_>>>() else {
                self.engine.writer().leave_out(place - 1)?;
                watcher.left_out(&frame);
                continue;
            };
            let mut images: Vec<ViewImage> = images.into_iter().flatten().collect();
            let memory = self.engine.pool();
            let read = (&mut images[..], Spent::Kept);
            let filled = self.pool.install(|| light.fill(self.job, frame.frame, read, (self.stages, memory)));
            filled.at(|| named(&frame)).map_err(failed)?;
            images.into_iter().for_each(|image| memory.give(image.image.into_samples()));
            watcher.look(&frame, &light);
            queues.make_room((written - 1, waiting), watcher)?;
            if failure.is_before(place) {
                return Ok(between.reports());
            }
            let made = watcher.render(&frame, &light);
            let pictures = made.at(|| named(&frame)).map_err(failed)?;
            if !between.is_key(place) {
                between.compare(place, &pictures);
                continue;
            }
            let interpolated = between.up_to(place, &pictures).into_iter();
            let interpolated = interpolated.map(|(place, maps)| (place, Cow::Borrowed(&frames[place - 1]), maps));
            for (place, frame, pictures) in interpolated.chain([(place, frame, pictures)]) {
                queues.make_room((written - 1, waiting), watcher)?;
                let (encoded, results) = self.have_written(turn.of(place), &frame, (pictures, &light))?;
                queues.encoded.push_back(encoded);
                queues.written.push_back((frame, results));
            }
        }
    }

    /// Returns the frames that are computed, in their order. Those of a stream go on until it ends.
    fn upcoming(&self, between: &Between<'a>) -> Upcoming<'a> {
        let (job, outputs) = (self.job, &self.job.outputs);
        let known = between.computed().into_iter().map(|place| (place, Cow::Borrowed(&outputs.frames[place - 1])));
        let last = outputs.frames.last().and_then(|frame| frame.frame).filter(|_| outputs.go_on);
        let further = last.into_iter().flat_map(|last| last + 1..=u64::MAX);
        let further = further.map(|number| Cow::Owned(Outputs::of_frame(Some(number), &job.target)));
        let all: Box<dyn Iterator<Item = _> + 'a> = Box::new(known.chain((outputs.frames.len() + 1..).zip(further)));
        all.peekable()
    }

    /// Returns whether the next frame can be read. A stream is waited for if there is nothing else to do, and all that is made is told
    /// of before. It is this thread that waits, so that threads of the pool stay free for the frames before.
    fn is_next_here(
        &self,
        upcoming: &mut Upcoming<'a>,
        queues: &mut Queues<'a>,
        watcher: &mut dyn Watcher,
    ) -> Result<bool> {
        let Some((_, frame)) = upcoming.peek() else { return Ok(false) };
        let mut coming = self.coming(frame, false)?;
        if coming == Coming::Later && queues.read.is_empty() {
            queues.finish_written(0, watcher)?;
            coming = self.coming(frame, true)?;
        }
        // Reading a frame that was asked for, and never comes, tells what is wrong.
        Ok(coming == Coming::Here || coming == Coming::Never && !self.job.outputs.go_on)
    }

    /// Tells whether a frame can be read at once.
    fn coming(&self, frame: &FrameOutputs, may_wait: bool) -> Result<Coming> {
        let (Some(videos), Some(number)) = (self.job.files.videos(), frame.frame) else { return Ok(Coming::Here) };
        let mut shown = self.job.input.present().filter_map(|(view, ..)| view.files.video());
        let Some(video) = shown.find(|video| self.job.files.live(video).is_some()) else { return Ok(Coming::Here) };
        Ok(videos.coming(&FrameName { video: video.to_owned(), frame: number }, may_wait)?)
    }

    /// Starts reading the files of a frame.
    fn have_read<'s>(&self, turn: Turn<'_, 's, '_>, frame: &FrameOutputs, which: Which) -> Results<FileImages>
    where
        'a: 's,
    {
        let Self { job, engine, stages, .. } = *self;
        let files = FrameFile::all(job, frame.frame, which).into_iter();
        // Maps of light are interpolated between frames, of which none may be missing.
        let may_lack = job.lighting.is_none();
        let read = |file: FrameFile<'a>| {
            let images = move || match file.read(job, engine.pool()) {
                Err(error) if may_lack && error.is_left_out() => Ok(None),
                images => images.map(Some),
            };
            turn.start(move || stages.beside(Stage::Decode, images))
        };
        Results::of(files.map(read).collect())
    }

    /// Has the pictures of a frame written. Returns the end of encoding, and the result, of each file.
    fn have_written<'s>(
        &self,
        turn: Turn<'_, 's, '_>,
        frame: &FrameOutputs,
        (mut pictures, light): (Vec<Levels>, &FrameLight),
    ) -> Result<(Vec<Receiver<()>>, Results<()>)>
    where
        'a: 's,
    {
        let Self { job, engine, stages, .. } = *self;
        let origin = job.origin_of(frame.frame)?.map(Arc::<str>::from);
        light.check_unchanged(job).at(|| named(frame))?;
        if pictures.iter().any(|levels| matches!(levels, Levels::Light(_))) {
            self.pool.install(|| engine.writer().encode_all(&mut pictures));
        }
        let words = FrameWords { place: turn.place - 1, carried: light.carried(), origin };
        let write = |((_, path), levels): (&(usize, PathBuf), Levels)| {
            let (path, words) = (path.clone(), words.clone());
            let save = move || engine.writer().save_hidden(words, levels, &path, Threads::One);
            turn.write(move || stages.beside(Stage::Encode, save))
        };
        let (encoded, results) = frame.files.iter().zip(pictures).map(write).unzip();
        Ok((encoded, Results::of(results)))
    }
}

impl Queues<'_> {
    /// Waits until at most `pictures` frames are being encoded, and at most `waiting` more are not on their disk. Tells of all that are.
    fn make_room(&mut self, (pictures, waiting): (usize, usize), watcher: &mut dyn Watcher) -> Result<()> {
        while self.encoded.len() > pictures {
            let Some(files) = self.encoded.pop_front() else { break };
            for file in files {
                // Its task is over. What became of it, the file's result says.
                let _ = file.recv();
            }
        }
        self.finish_written(pictures + waiting, watcher)?;
        while self.written.front_mut().is_some_and(|(_, results)| results.are_here()) {
            self.finish_written(self.written.len() - 1, watcher)?;
        }
        Ok(())
    }

    /// Waits until at most `most` frames are being written. After a failed frame, or one after which the watcher stops,
    /// nothing is awaited, because nobody reports on later frames.
    fn finish_written(&mut self, most: usize, watcher: &mut dyn Watcher) -> Result<()> {
        while self.written.len() > most {
            let Some((frame, results)) = self.written.pop_front() else { break };
            let written = results.all().at(|| named(&frame));
            written.and_then(|_| watcher.done(&frame)).inspect_err(|_| self.written.clear())?;
        }
        Ok(())
    }
}

/// Index of the first frame that failed, counted from one.
struct FirstFailure(AtomicUsize);

impl FirstFailure {
    fn none() -> Self {
        Self(AtomicUsize::new(usize::MAX))
    }

    fn note(&self, place: usize) {
        self.0.fetch_min(place, Ordering::Relaxed);
    }

    /// Cancels all further work.
    fn end(&self) {
        self.note(0);
    }

    /// Returns whether a frame before this one has failed, so that this one is no longer wanted.
    fn is_before(&self, place: usize) -> bool {
        self.0.load(Ordering::Relaxed) < place
    }
}

/// Threads for the tasks of a frame, the failure to observe, and the frame's index.
#[derive(Clone, Copy)]
struct Turn<'t, 's, 'd> {
    work: &'t Scope<'s>,
    disk: &'s Scope<'d>,
    failure: &'d FirstFailure,
    place: usize,
}

impl<'s, 'd> Turn<'_, 's, 'd> {
    fn of(self, place: usize) -> Self {
        Self { place, ..self }
    }

    /// Starts a task. It is skipped if an earlier frame has failed.
    fn start<T: Send + 's>(self, task: impl FnOnce() -> Result<T> + Send + 's) -> Receiver<Result<T>> {
        let (answer, receiver) = self.answer();
        self.work.spawn(move |_| {
            if !answer.is_late() {
                answer.give(task());
            }
        });
        receiver
    }

    /// Starts a task that writes a file. The file appears once it is on its disk. Returns the end of the task, and the file's result.
    fn write(self, task: impl FnOnce() -> Result<Option<Hidden>> + Send + 's) -> (Receiver<()>, Receiver<Result<()>>) {
        let ((answer, receiver), (end, encoded)) = (self.answer(), sync_channel(1));
        let disk = self.disk;
        self.work.spawn(move |_| {
            if answer.is_late() {
                return;
            }
            let written = task();
            drop(end);
            match written {
                Ok(Some(file)) => disk.spawn(move |_| {
                    // It may have waited for its turn.
                    if !answer.is_late() {
                        answer.give(file.appear().map_err(Into::into));
                    }
                }),
                written => answer.give(written.map(|_| ())),
            }
        });
        (encoded, receiver)
    }

    fn answer<T>(self) -> (Answer<'d, T>, Receiver<Result<T>>) {
        let (result, receiver): (SyncSender<Result<T>>, _) = sync_channel(1);
        (Answer { failure: self.failure, place: self.place, result }, receiver)
    }
}

/// Place for the result of a task.
struct Answer<'d, T> {
    failure: &'d FirstFailure,
    place: usize,
    result: SyncSender<Result<T>>,
}

impl<T> Answer<'_, T> {
    /// Returns whether an earlier frame has failed.
    fn is_late(&self) -> bool {
        self.failure.is_before(self.place)
    }

    fn give(self, done: Result<T>) {
        if done.is_err() {
            self.failure.note(self.place);
        }
        // Nobody may be waiting any more, if another task has failed.
        let _ = self.result.send(done);
    }
}
