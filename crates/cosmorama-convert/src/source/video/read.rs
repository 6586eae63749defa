//! Frames of videos that are read: decoded once each, in order as far as they are asked for so.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock};

use cosmorama::raster::{EncodedImage, FramePool};
use cosmorama_io::pending::Unfinished;
use cosmorama_io::{Header, ImageFile, IoError, Limits};
use cosmorama_spec::{FrameRate, Spec};
use cosmorama_video::{
    CodedOrder, CutShort, Damaged, Fault, Ffmpeg, FrameCondition, PairedReader, ReadOptions, SecondHalf, Timeline,
    VideoError, VideoFrame, VideoInfo, VideoReader,
};
use thiserror::Error;

use super::counted::count;
use super::damage::{Damage, Faults, Marks, Told, may_lack, more_than, ranges};
use super::live::Live;
use super::raw::{RawInfo, RawReader, aside, foreign};
use super::{Coming, DamagedFrames, FrameDamage, FrameName, RawBytes, RawFiles, RawKind, described};
use crate::source::lock;

/// Videos among the inputs of a conversion. Each is opened when it is first asked for.
#[derive(Debug)]
pub struct Videos {
    damaged: DamagedFrames,
    files: Arc<dyn RawFiles>,
    ffmpeg: OnceLock<Arc<Ffmpeg>>,
    unfinished: Unfinished,
    sources: Mutex<BTreeMap<PathBuf, Arc<Source>>>,
}

/// A video whose frames are read.
#[derive(Debug)]
struct Source {
    name: PathBuf,
    content: Content,
    /// Header that all frames share.
    header: Header,
    damaged: Damaged,
    /// Threads of the decoder; 0 for all.
    threads: usize,
    /// Number of frames; of a stream that is read as it comes, as many as there can be.
    count: u64,
    /// Order in which the frames of its streams are coded, once it is needed; `None` where the file does not tell.
    orders: OnceLock<Option<Vec<CodedOrder>>>,
    /// Marks of frames under an answer to damage. Whoever looks does not wait for the decoder.
    marks: Mutex<Marks>,
    state: Mutex<State>,
}

/// Content of a video's file.
#[derive(Debug)]
enum Content {
    /// A video that ffmpeg decodes, or two streams of it that are halves of its pictures.
    Film { ffmpeg: Arc<Ffmpeg>, info: Box<VideoInfo>, half: Option<Box<SecondHalf>> },
    /// A stream of raw pictures.
    Raw { kind: RawKind, files: Arc<dyn RawFiles>, rate: Option<FrameRate> },
    /// A stream of raw pictures that is read as it comes.
    Live { pictures: Mutex<Live>, rate: Option<FrameRate> },
}

/// Decoder of a video.
#[derive(Debug)]
enum Decoder {
    Film(Box<VideoReader>),
    Pair(Box<PairedReader>),
    Raw(RawReader),
}

/// Progress of a video's decoder.
#[derive(Debug, Default)]
struct State {
    /// Decoder, and the number of the frame that it gives next.
    reader: Option<(Decoder, u64)>,
    /// Frames that will be asked for.
    wanted: BTreeSet<u64>,
    /// Whether it is known which frames will be asked for.
    is_expected: bool,
    /// Rows of frames of which pictures are made.
    rows: Option<Range<usize>>,
    /// Frames that were decoded before they were asked for.
    early: BTreeMap<u64, EncodedImage>,
    /// Frames that the decoder left out.
    left_out: BTreeSet<u64>,
    /// Frames that were asked for.
    asked: BTreeSet<u64>,
    /// Whether there are more frames than are announced.
    has_more: bool,
    /// Error after which there are no more frames.
    failure: Option<Shared>,
    /// Damage of which its decoders told.
    damage: Damage,
}

/// Frames at most that are held before they are asked for. Threads ask for few frames out of order; those that are dropped are
/// decoded again.
const MOST_EARLY: usize = 64;

impl Videos {
    /// Creates an empty list of videos. Streams of raw pictures come from `files`.
    pub(crate) fn new(damaged: DamagedFrames, files: Arc<dyn RawFiles>) -> Self {
        let (ffmpeg, unfinished) = (OnceLock::new(), Unfinished::default());
        Self { damaged, files, ffmpeg, unfinished, sources: Mutex::default() }
    }

    /// Has programs end with unfinished files when the job is interrupted.
    pub(crate) fn ending_with(self, unfinished: &Unfinished) -> Self {
        Self { unfinished: unfinished.clone(), ..self }
    }

    /// Returns the header of a frame.
    pub(crate) fn header(&self, name: &FrameName) -> Result<Header, IoError> {
        Ok(self.source(&name.video)?.header.clone())
    }

    /// Decodes a frame, into memory of a pool.
    pub(crate) fn picture(&self, name: &FrameName, limits: &Limits, pool: &FramePool) -> Result<ImageFile, IoError> {
        let source = self.source(&name.video)?;
        let image = source.frame(name.frame, limits, pool)?;
        let image = image.ok_or_else(|| IoError::LeftOut { path: name.path() })?;
        let Header { format, metadata, .. } = source.header.clone();
        Ok(ImageFile { format, image, metadata, window: None })
    }

    /// Returns the number of frames; `None` for a stream that is read as it comes.
    pub(crate) fn count(&self, video: &Path) -> Result<Option<u64>, IoError> {
        let source = self.source(video)?;
        Ok((!matches!(source.content, Content::Live { .. })).then_some(source.count))
    }

    /// Tells whether a frame can be read at once, and waits for it if that is wanted. No thread of a pool should wait in its place, since
    /// others may have to finish frames before it.
    pub(crate) fn coming(&self, name: &FrameName, may_wait: bool) -> Result<Coming, IoError> {
        let source = self.source(&name.video)?;
        let Content::Live { pictures, .. } = &source.content else { return Ok(Coming::Here) };
        Ok(lock(pictures).coming(name.frame, may_wait))
    }

    /// Returns the answer to damaged frames.
    pub(crate) fn answer(&self) -> DamagedFrames {
        self.damaged
    }

    /// Returns what is the matter with a frame that was decoded.
    pub(crate) fn damage(&self, name: &FrameName) -> Option<FrameDamage> {
        let source = self.sources().get(&name.video).cloned()?;
        lock(&source.marks).of_frame(name.frame, |damaged| source.traced(damaged))
    }

    /// Returns the bytes of memory that ffmpeg holds to read a video, about.
    pub(crate) fn memory(&self, video: &Path) -> Result<u64, IoError> {
        let source = self.source(video)?;
        let Content::Film { info, half, .. } = &source.content else { return Ok(0) };
        let infos = std::iter::once(&**info).chain(half.iter().map(|half| &half.info));
        Ok(infos.map(|info| info.decoding_bytes(source.threads)).fold(0, u64::saturating_add))
    }

    /// Returns the rate; `None` if it varies, or none is said.
    pub(crate) fn rate(&self, video: &Path) -> Result<Option<FrameRate>, IoError> {
        Ok(match &self.source(video)?.content {
            Content::Film { info, .. } => {
                let rate = FrameRate { frames: info.rate.numerator(), seconds: info.rate.denominator() };
                (!info.is_variable).then_some(rate)
            }
            Content::Raw { rate, .. } | Content::Live { rate, .. } => *rate,
        })
    }

    /// Returns the nanoseconds from the first frame to the beginning of each, where the rate varies.
    pub(crate) fn begins(&self, video: &Path) -> Result<Option<Vec<u64>>, IoError> {
        let source = self.source(video)?;
        let Content::Film { ffmpeg, info, .. } = &source.content else { return Ok(None) };
        Ok(match ffmpeg.timeline(info).map_err(foreign)? {
            Timeline::Even { .. } => None,
            Timeline::Listed { times, time_base } => {
                let first = times.first().copied().unwrap_or_default();
                let nanoseconds = |time: &i64| (time.abs_diff(first) as f64 * time_base.to_f64() * 1e9).round() as u64;
                Some(times.iter().map(nanoseconds).take(source.count as usize).collect())
            }
        })
    }

    /// Returns the projection that a video names, and what names it: its spherical tags, or its two streams.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn spec(&self, video: &Path) -> Result<Option<(Spec, &'static str)>, IoError> {
        Ok(match &self.source(video)?.content {
            Content::Film { half: Some(half), .. } => described::paired(half.place).map(|spec| (spec, "two streams")),
            Content::Film { info, .. } => described::spec(info).map(|spec| (spec, "spherical tags")),
            Content::Raw { .. } | Content::Live { .. } => None,
        })
    }

    /// Returns what a video says of itself beside its pictures, each under a name, in the order of a report.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn facts(&self, video: &Path) -> Result<Vec<(&'static str, String)>, IoError> {
        if let Content::Film { info, half, .. } = &self.source(video)?.content {
            return Ok(described::facts(info, half.as_ref().map(|half| half.place)));
        }
        let rate = self.rate(video)?;
        Ok(rate.map(|rate| ("frame_rate", rate.to_string())).into_iter().collect())
    }

    /// Says which frames will be asked for, so that they are kept if they are decoded before.
    pub(crate) fn expect(&self, video: &Path, frames: impl Iterator<Item = u64>) -> Result<(), IoError> {
        let source = self.source(video)?;
        let mut state = source.state();
        state.wanted.extend(frames);
        state.is_expected = true;
        Ok(())
    }

    /// Says of which rows of its frames pictures are made, so that others need not be decoded.
    pub(crate) fn expect_rows(&self, video: &Path, rows: Range<usize>) {
        if let Some(source) = self.sources().get(video) {
            source.state().rows = Some(rows);
        }
    }

    /// Reads videos to their ends if all of their frames have been read.
    ///
    /// # Errors
    /// When a decoder says at its end that something was damaged.
    pub(crate) fn end(&self) -> Result<(), IoError> {
        self.sources().values().try_for_each(|source| source.end()).map_err(foreign)
    }

    /// Ends the decoder of a video, and returns the frames that were damaged, missing or not announced, with the reasons.
    pub(crate) fn faults(&self, video: &Path) -> Result<Vec<(Range<u64>, String)>, IoError> {
        let source = self.source(video)?;
        let mut state = source.state();
        state.close();
        let ranged = |fault: &Fault| (fault.frame..fault.frame + fault.count, fault.reason.clone());
        let announced = source.count;
        let (faults, beside) = (&state.damage.faults, &state.damage.beside);
        let further = state.has_more.then(|| more_than(announced));
        // Frames that a cut file lacks may be counted by nobody.
        let cut = source.untold_cut(faults).map(|CutShort { expected, found }| {
            VideoError::Cut { path: video.to_owned(), expected, found, is_described: true }.to_string()
        });
        let further = further.or(cut);
        let behind = further.map(|reason| (announced..announced + 1, reason));
        let (traced, reason) = source.traces(&state, &[faults, beside]);
        let traced = traced.into_iter().map(|frames| (frames, reason.to_owned()));
        Ok(faults.values().map(ranged).chain(traced).chain(behind).collect())
    }

    /// Returns messages about frames that were damaged, and about frames that were not announced.
    pub(crate) fn complaints(&self, makes_film: bool) -> Vec<String> {
        self.sources().values().flat_map(|source| source.complaints(makes_film)).collect()
    }

    /// Returns whether the rate of a film varies.
    pub(crate) fn varies(&self, video: &Path) -> Result<bool, IoError> {
        Ok(self.info(video)?.is_some_and(|info| info.is_variable))
    }

    /// Returns what a video is; `None` for a stream of raw pictures.
    pub(super) fn info(&self, video: &Path) -> Result<Option<VideoInfo>, IoError> {
        Ok(match &self.source(video)?.content {
            Content::Film { info, .. } => Some((**info).clone()),
            Content::Raw { .. } | Content::Live { .. } => None,
        })
    }

    fn source(&self, video: &Path) -> Result<Arc<Source>, IoError> {
        let mut sources = self.sources();
        if let Some(source) = sources.get(video) {
            return Ok(Arc::clone(source));
        }
        let source = Arc::new(match RawKind::of(video) {
            Some(kind) => Source::raw(kind, video, &self.files)?,
            None => {
                // The error of a file that is not there is the same as for pictures; a picture is no film, whatever its name.
                if let Ok(Header { format, .. }) = cosmorama_io::probe_from(cosmorama_io::open(video)?, video) {
                    return Err(IoError::PictureContent { path: video.to_owned(), format });
                }
                Source::film(self.ffmpeg()?, video, self.damaged).map_err(foreign)?
            }
        });
        sources.insert(video.to_owned(), Arc::clone(&source));
        Ok(source)
    }

    /// Finds the installed programs, once.
    pub(super) fn ffmpeg(&self) -> Result<Arc<Ffmpeg>, IoError> {
        if let Some(ffmpeg) = self.ffmpeg.get() {
            return Ok(Arc::clone(ffmpeg));
        }
        let found = Arc::new(Ffmpeg::find().map_err(foreign)?.ending_with(&self.unfinished));
        Ok(Arc::clone(self.ffmpeg.get_or_init(|| found)))
    }

    fn sources(&self) -> MutexGuard<'_, BTreeMap<PathBuf, Arc<Source>>> {
        lock(&self.sources)
    }
}

impl Source {
    fn film(ffmpeg: Arc<Ffmpeg>, video: &Path, damaged: DamagedFrames) -> Result<Self, VideoError> {
        let mut info = ffmpeg.probe(video)?;
        let mut half = ffmpeg.second_half(&info)?;
        // Several threads would not always make the same of what takes after damaged frames, nor tell of the same frames.
        let (damaged, threads) = match damaged {
            DamagedFrames::Error => (Damaged::Error, 0),
            DamagedFrames::Hold => (Damaged::Hold, 1),
            DamagedFrames::Skip => (Damaged::Skip, 1),
        };
        let (mut frames, mut header) = (count(&ffmpeg, &mut info, damaged)?, described::header(&info));
        if let Some(half) = &mut half {
            let others = count(&ffmpeg, &mut half.info, damaged)?;
            if others != frames {
                let (all, both) = (frames.max(others), frames.min(others));
                header.metadata.notes.push(format!(
                    "one of its two streams has {all} frames, the other {both}; only frames that both have are read"
                ));
                frames = both;
            }
            (header.width, header.height) = half.place.whole((header.width, header.height));
            // It is no stream beside the video.
            info.others.retain(|other| other.index != half.info.stream);
        }
        let content = Content::Film { ffmpeg, info: Box::new(info), half: half.map(Box::new) };
        Ok(Self::new(video, (content, header), (damaged, threads), frames))
    }

    fn new(
        video: &Path,
        (content, header): (Content, Header),
        (damaged, threads): (Damaged, usize),
        count: u64,
    ) -> Self {
        let (orders, marks, state) = (OnceLock::new(), Mutex::default(), Mutex::default());
        Self { name: video.to_owned(), content, header, damaged, threads, count, orders, marks, state }
    }

    /// Returns how a video's file is cut, unless its faults tell of all that it lacks.
    fn untold_cut(&self, faults: &Faults) -> Option<CutShort> {
        let Content::Film { info, .. } = &self.content else { return None };
        info.cut.filter(|_| faults.is_empty() || info.announced.is_none())
    }

    fn raw(kind: RawKind, video: &Path, files: &Arc<dyn RawFiles>) -> Result<Self, IoError> {
        let (RawInfo { header, .. }, content, count) = match files.open(video)? {
            RawBytes::Kept(bytes) => {
                let (info, count) = RawInfo::read(kind, bytes, &video.display().to_string()).map_err(foreign)?;
                let content = Content::Raw { kind, files: Arc::clone(files), rate: info.rate };
                (info, content, count)
            }
            RawBytes::Live(bytes) => {
                let (pictures, info) = Live::open(kind, bytes, video)?;
                let content = Content::Live { pictures: Mutex::new(pictures), rate: info.rate };
                (info, content, u64::MAX)
            }
        };
        Ok(Self::new(video, (content, header), (Damaged::Error, 0), count))
    }

    fn state(&self) -> MutexGuard<'_, State> {
        lock(&self.state)
    }

    /// Returns a frame; `None` if it is left out. Nobody waits for another frame to be asked for, so that no two threads can wait for
    /// each other.
    fn frame(&self, number: u64, limits: &Limits, pool: &FramePool) -> Result<Option<EncodedImage>, IoError> {
        if let Content::Live { pictures, .. } = &self.content {
            return lock(pictures).take(number).map(Some);
        }
        let mut state = self.state();
        state.wanted.remove(&number);
        state.asked.insert(number);
        if let Some(image) = state.early.remove(&number) {
            return Ok(Some(image));
        }
        if state.left_out.contains(&number) {
            return Ok(None);
        }
        if let Some(failure) = &state.failure {
            return Err(IoError::Video(Box::new(failure.clone())));
        }
        self.decoded(number, (limits, pool), &mut state).map_err(|error| {
            // Whoever asks for this frame, or a later one, is told of the same fault.
            let failure = Shared(Arc::new(error));
            state.failure = Some(failure.clone());
            IoError::Video(Box::new(failure))
        })
    }

    /// Decodes up to a frame; `None` if it is left out.
    fn decoded(
        &self,
        number: u64,
        (limits, pool): (&Limits, &FramePool),
        state: &mut State,
    ) -> Result<Option<EncodedImage>, VideoError> {
        if state.reader.as_ref().is_none_or(|(_, next)| *next > number) {
            state.close();
            state.reader = Some(self.reader((state.start(number), number), state, limits)?);
        }
        loop {
            let Some((reader, next)) = &mut state.reader else { return Err(self.without(number)) };
            let first = *next;
            let Some(VideoFrame { index, image, condition, .. }) = reader.next((&self.name, first), pool)? else {
                return if self.damaged == Damaged::Skip { Ok(None) } else { Err(self.without(number)) };
            };
            *next = index + 1;
            if self.damaged != Damaged::Error {
                lock(&self.marks).mark(index, condition == FrameCondition::Held, &reader.told());
            }
            state.left_out.extend(first..index.min(self.count));
            if index == number {
                if state.is_expected && state.wanted.is_empty() && number + 1 < self.count {
                    state.close();
                }
                return Ok(Some(image));
            }
            let is_left_out = index > number;
            if state.wanted.contains(&index) && state.early.len() < MOST_EARLY {
                state.early.insert(index, image);
            }
            if is_left_out {
                return Ok(None);
            }
        }
    }

    /// Starts a decoder that goes from a frame to the one that is asked for, and returns it with the number of its first frame. Of a whole
    /// file it goes on to the file's end, where it tells whether there are more frames than are announced. Of a file that is cut it takes
    /// the frames that are wanted, so that the first that is missing is named.
    fn reader(&self, (first, asked): (u64, u64), state: &State, limits: &Limits) -> Result<(Decoder, u64), VideoError> {
        let (ffmpeg, info, half) = match &self.content {
            Content::Film { ffmpeg, info, half } => (ffmpeg, info, half),
            Content::Raw { kind, files, .. } => {
                let (RawBytes::Kept(bytes) | RawBytes::Live(bytes)) = files.open(&self.name)?;
                let reader = RawReader::open(*kind, bytes, &self.name.display().to_string(), limits.memory)?;
                return Ok((Decoder::Raw(reader), 0));
            }
            Content::Live { .. } => return Err(self.without(asked)),
        };
        let last = state.wanted.last().copied().unwrap_or(0).max(asked);
        let last = if state.is_expected { last } else { last.max(self.count.saturating_sub(1)) };
        let is_all = first == 0 && info.cut.is_none();
        let frames = (!is_all).then_some(first..=last);
        let rows = state.rows.clone().filter(|_| half.is_none());
        let (damaged, memory, threads) = (self.damaged, limits.memory, self.threads);
        let looked_at = state.is_expected.then(|| state.wanted.range(first..).copied().chain([asked]).collect());
        let options = ReadOptions { frames, looked_at, rows, damaged, memory, threads };
        let decoder = match half {
            Some(half) => Decoder::Pair(Box::new(PairedReader::open(ffmpeg, info, half, options)?)),
            None => Decoder::Film(Box::new(VideoReader::open(ffmpeg, info, options)?)),
        };
        Ok((decoder, first))
    }

    fn without(&self, asked: u64) -> VideoError {
        let (path, announced) = (self.name.clone(), self.count);
        match &self.content {
            Content::Film { .. } if asked < announced => VideoError::FewerFrames { path, found: asked, announced },
            _ => VideoError::NoSuchFrame { path, asked, last: announced.saturating_sub(1) },
        }
    }

    /// Reads to the end of the video if all frames have been read, so that what its decoder says last is heard.
    fn end(&self) -> Result<(), VideoError> {
        let mut state = self.state();
        if let Some((reader, next)) = &mut state.reader
            && *next == self.count
        {
            state.has_more = reader.next((&self.name, self.count), &FramePool::default())?.is_some();
        }
        Ok(())
    }

    /// Returns messages about frames that were damaged, and about those that were not announced, or may be lacking.
    fn complaints(&self, makes_film: bool) -> Vec<String> {
        let mut state = self.state();
        let further = state.has_more.then(|| more_than(self.count));
        state.close();
        let cut = self.untold_cut(&state.damage.faults).filter(|_| self.damaged != Damaged::Error);
        let cut = cut.filter(|_| further.is_none()).map(|cut| may_lack(cut, state.asked.len()));
        let (damage, count) = (&state.damage, |faults: &Faults| self.count_traces(&state, faults));
        let of_faults = damage.complaint((self.damaged, makes_film), count);
        let found = [further, of_faults, damage.complaint_beside(count), cut].into_iter().flatten();
        found.map(|found| format!("{}: {found}", self.name.display())).collect()
    }

    fn count_traces(&self, state: &State, faults: &Faults) -> u64 {
        self.traces(state, &[faults]).0.iter().map(|range| range.end - range.start).sum()
    }

    /// Returns the frames that may show traces of damaged ones; `None` where the file's own order cannot be read.
    fn traced(&self, damaged: &[Range<u64>]) -> Option<BTreeSet<u64>> {
        let Content::Film { ffmpeg, info, half } = &self.content else { return Some(BTreeSet::new()) };
        let orders = self.orders.get_or_init(|| {
            let streams = std::iter::once(&**info).chain(half.iter().map(|half| &half.info));
            streams.map(|info| ffmpeg.coded_order(info).ok().flatten()).collect()
        });
        Some(orders.as_ref()?.iter().flat_map(|order| order.traces(damaged)).collect())
    }

    /// Returns the frames that may show traces of damaged ones, of those that were asked for, with the reason: all behind the first one
    /// where the file's own order cannot be read.
    fn traces(&self, state: &State, faults: &[&Faults]) -> (Vec<Range<u64>>, &'static str) {
        let damaged: Vec<_> = ranges(faults.iter().flat_map(|faults| faults.values())).collect();
        let Some(first) = damaged.iter().min_by_key(|range| range.start) else { return (Vec::new(), TRACES) };
        let (traced, reason) = match self.traced(&damaged) {
            Some(traced) => (traced, TRACES),
            None => (state.asked.range(first.end..).copied().collect(), UNSURE),
        };
        let mut found: Vec<Range<u64>> = Vec::new();
        for frame in traced.intersection(&state.asked).copied() {
            match found.last_mut() {
                Some(last) if last.end == frame => last.end += 1,
                _ => found.push(frame..frame + 1),
            }
        }
        (found, reason)
    }
}

/// Finding about a frame that may show traces of damaged ones.
const TRACES: &str = "it takes after a damaged frame, and may show traces of it";

/// Finding about a frame behind a damaged one, where it is not known which take after it.
const UNSURE: &str = "a frame before it is damaged, and the file does not tell which take after that";

impl Decoder {
    /// Returns the next frame; `None` after the last. The number of a stream's is counted.
    fn next(&mut self, (name, index): (&Path, u64), pool: &FramePool) -> Result<Option<VideoFrame>, VideoError> {
        let told = name.display().to_string();
        match self {
            Self::Film(reader) => aside(|| reader.next_frame_in(pool), &told),
            Self::Pair(reader) => aside(|| reader.next_frame_in(pool), &told),
            Self::Raw(reader) => {
                let picture = reader.next_picture(&told)?;
                Ok(picture.map(|image| VideoFrame { index, time: 0, image, condition: FrameCondition::Whole }))
            }
        }
    }

    /// Returns what it has told of damage so far.
    fn told(&self) -> Told<'_> {
        match self {
            Self::Film(reader) => Told {
                faults: reader.faults().iter().collect(),
                beside: reader.faults_beside().iter().collect(),
                foreseen: reader.foreseen().iter().collect(),
            },
            Self::Pair(reader) => Told {
                faults: reader.faults().collect(),
                beside: reader.faults_beside().collect(),
                foreseen: reader.foreseen().collect(),
            },
            Self::Raw(_) => Told::default(),
        }
    }
}

impl State {
    /// Returns the frame at which a decoder starts that is to give a frame: an earlier one that is wanted, too, if its thread merely
    /// asks later, so that which thread is first does not decide how much of a video is read.
    fn start(&self, number: u64) -> u64 {
        let first = self.wanted.first().copied().unwrap_or(number);
        if number.saturating_sub(first) < MOST_EARLY as u64 { first.min(number) } else { number }
    }

    /// Ends the decoder, and notes its faults.
    fn close(&mut self) {
        if let Some((reader, _)) = self.reader.take() {
            self.damage.note(reader.told());
        }
    }
}

/// Error that several threads are told of.
#[derive(Clone, Debug, Error)]
#[error(transparent)]
pub(super) struct Shared(pub(super) Arc<VideoError>);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decoders_start_at_the_first_frame_that_is_wanted_soon() {
        let wanting = |wanted: &[u64]| State { wanted: wanted.iter().copied().collect(), ..State::default() };
        for (wanted, asked, start) in [(&[0, 1][..], 2, 0), (&[3, 4], 2, 2), (&[], 5, 5), (&[7], 70, 7), (&[7], 71, 71)]
        {
            assert_eq!(wanting(wanted).start(asked), start, "frame {asked} of {wanted:?}");
        }
    }
}
