//! Frames of videos that are read: decoded once each, in order as far as they are asked for so.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use cosmorama::raster::EncodedImage;
use cosmorama_io::{Format, Header, ImageFile, IoError, Limits};
use cosmorama_spec::{FrameRate, Spec};
use cosmorama_video::{Damaged, Fault, Ffmpeg, ReadOptions, VideoError, VideoInfo, VideoReader};

use super::{DamagedFrames, FrameName, described};

/// Videos among the inputs of a conversion. Each is opened when it is first asked for.
#[derive(Debug, Default)]
pub struct Videos {
    damaged: DamagedFrames,
    ffmpeg: OnceLock<Arc<Ffmpeg>>,
    sources: Mutex<BTreeMap<PathBuf, Arc<Source>>>,
}

/// A video whose frames are read.
#[derive(Debug)]
struct Source {
    ffmpeg: Arc<Ffmpeg>,
    info: VideoInfo,
    damaged: Damaged,
    count: u64,
    state: Mutex<State>,
}

/// Progress of a video's decoder.
#[derive(Debug, Default)]
struct State {
    /// Decoder, and the number of the frame that it gives next.
    reader: Option<(VideoReader, u64)>,
    /// Frames that will be asked for.
    wanted: BTreeSet<u64>,
    /// Whether it is known which frames will be asked for.
    is_expected: bool,
    /// Frames that were decoded before they were asked for.
    early: BTreeMap<u64, EncodedImage>,
    /// Frames that the decoder left out.
    left_out: BTreeSet<u64>,
    /// Faults of frames that are left out, or in place of which others are shown.
    faults: BTreeMap<u64, String>,
}

/// Frames at most that are held before they are asked for. Threads ask for few frames out of order; those that are dropped are
/// decoded again.
const MOST_EARLY: usize = 64;

impl Videos {
    /// Creates an empty list of videos.
    pub(crate) fn new(damaged: DamagedFrames) -> Self {
        Self { damaged, ..Self::default() }
    }

    /// Returns the header of a frame.
    pub(crate) fn header(&self, name: &FrameName) -> Result<Header, IoError> {
        Ok(described::header(&self.source(&name.video)?.info))
    }

    /// Decodes a frame.
    pub(crate) fn picture(&self, name: &FrameName, limits: &Limits) -> Result<ImageFile, IoError> {
        let source = self.source(&name.video)?;
        let image = source.frame(name.frame, limits).map_err(foreign)?;
        let image = image.ok_or_else(|| IoError::LeftOut { path: name.path() })?;
        Ok(ImageFile { format: Format::Video, image, metadata: described::metadata(&source.info), window: None })
    }

    /// Returns the number of frames.
    pub(crate) fn count(&self, video: &Path) -> Result<u64, IoError> {
        Ok(self.source(video)?.count)
    }

    /// Returns the rate; `None` if it varies.
    pub(crate) fn rate(&self, video: &Path) -> Result<Option<FrameRate>, IoError> {
        let info = &self.source(video)?.info;
        let rate = FrameRate { frames: info.rate.numerator(), seconds: info.rate.denominator() };
        Ok((!info.is_variable).then_some(rate))
    }

    /// Returns the projection that the spherical tags of a video name.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn spec(&self, video: &Path) -> Result<Option<Spec>, IoError> {
        Ok(described::spec(&self.source(video)?.info))
    }

    /// Returns what a video says of itself beside its pictures, each under a name, in the order of a report.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn facts(&self, video: &Path) -> Result<Vec<(&'static str, String)>, IoError> {
        Ok(described::facts(&self.source(video)?.info))
    }

    /// Says which frames will be asked for, so that they are kept if they are decoded before.
    pub(crate) fn expect(&self, video: &Path, frames: impl Iterator<Item = u64>) -> Result<(), IoError> {
        let source = self.source(video)?;
        let mut state = source.state();
        state.wanted.extend(frames);
        state.is_expected = true;
        Ok(())
    }

    /// Returns messages about frames that were damaged, and about frames that were not announced; an item for each video.
    pub(crate) fn complaints(&self) -> Vec<String> {
        self.sources().values().filter_map(|source| source.complaint()).collect()
    }

    /// Returns what a video is.
    pub(super) fn info(&self, video: &Path) -> Result<VideoInfo, IoError> {
        Ok(self.source(video)?.info.clone())
    }

    fn source(&self, video: &Path) -> Result<Arc<Source>, IoError> {
        let mut sources = self.sources();
        if let Some(source) = sources.get(video) {
            return Ok(Arc::clone(source));
        }
        // The error of a file that is not there is the same as for pictures.
        drop(cosmorama_io::open(video)?);
        let ffmpeg = match self.ffmpeg.get() {
            Some(ffmpeg) => Arc::clone(ffmpeg),
            None => Arc::clone(self.ffmpeg.get_or_init({
                let found = Arc::new(Ffmpeg::find().map_err(foreign)?);
                || found
            })),
        };
        let source = Arc::new(Source::open(ffmpeg, video, self.damaged).map_err(foreign)?);
        sources.insert(video.to_owned(), Arc::clone(&source));
        Ok(source)
    }

    fn sources(&self) -> MutexGuard<'_, BTreeMap<PathBuf, Arc<Source>>> {
        self.sources.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Wraps the error of a reader or writer of videos.
pub(super) fn foreign(error: VideoError) -> IoError {
    match error {
        VideoError::Output(error) => error,
        error => IoError::Video(Box::new(error)),
    }
}

impl Source {
    fn open(ffmpeg: Arc<Ffmpeg>, video: &Path, damaged: DamagedFrames) -> Result<Self, VideoError> {
        let info = ffmpeg.probe(video)?;
        let damaged = match damaged {
            DamagedFrames::Error => Damaged::Error,
            DamagedFrames::Hold => Damaged::Hold,
            DamagedFrames::Skip => Damaged::Skip,
        };
        let count = match info.announced {
            Some(announced) => announced.frames,
            None => counted(&ffmpeg, &info, damaged)?,
        };
        Ok(Self { ffmpeg, info, damaged, count, state: Mutex::default() })
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns a frame; `None` if it is left out. Nobody waits for another frame to be asked for, so that no two threads can wait for
    /// each other.
    fn frame(&self, number: u64, limits: &Limits) -> Result<Option<EncodedImage>, VideoError> {
        let mut state = self.state();
        state.wanted.remove(&number);
        if let Some(image) = state.early.remove(&number) {
            return Ok(Some(image));
        }
        if state.left_out.contains(&number) {
            return Ok(None);
        }
        if state.reader.as_ref().is_none_or(|(_, next)| *next > number) {
            state.close();
            state.reader = Some((self.reader(number, limits)?, number));
        }
        loop {
            let Some((reader, next)) = &mut state.reader else { return Err(self.without(number)) };
            let first = *next;
            let Some(frame) = reader.next_frame()? else {
                return if self.damaged == Damaged::Skip { Ok(None) } else { Err(self.without(number)) };
            };
            *next = frame.index + 1;
            state.left_out.extend(first..frame.index);
            if frame.index == number {
                if state.is_expected && state.wanted.is_empty() && number + 1 < self.count {
                    state.close();
                }
                return Ok(Some(frame.image));
            }
            let is_left_out = frame.index > number;
            if state.wanted.contains(&frame.index) && state.early.len() < MOST_EARLY {
                state.early.insert(frame.index, frame.image);
            }
            if is_left_out {
                return Ok(None);
            }
        }
    }

    /// Starts a decoder at a frame. Started at the first, it tells whether there are more frames than are announced.
    fn reader(&self, first: u64, limits: &Limits) -> Result<VideoReader, VideoError> {
        let frames = (first > 0).then(|| first..=self.count.saturating_sub(1).max(first));
        VideoReader::open(
            &self.ffmpeg,
            &self.info,
            ReadOptions { frames, damaged: self.damaged, memory: limits.memory, threads: 0 },
        )
    }

    fn without(&self, asked: u64) -> VideoError {
        let last = self.count.saturating_sub(1);
        VideoError::NoSuchFrame { path: self.info.path.clone(), asked, last }
    }

    fn complaint(&self) -> Option<String> {
        let mut state = self.state();
        let path = self.info.path.display();
        if let Some((reader, next)) = &mut state.reader
            && *next == self.count
            && reader.next_frame().is_ok_and(|frame| frame.is_some())
        {
            return Some(format!(
                "{path}: there are more frames than the {} that it announces; they are left out, so write it again by a program that \
                 counts them",
                self.count
            ));
        }
        state.close();
        let (first, reason) = state.faults.first_key_value()?;
        let count = state.faults.len();
        let instead = if self.damaged == Damaged::Skip { "left out" } else { "replaced by the one before" };
        Some(format!(
            "{path}: {count} {} damaged or missing, and {instead}; the first is frame {first} ({reason})",
            if count == 1 { "frame is" } else { "frames are" }
        ))
    }
}

impl State {
    /// Ends the decoder, and notes its faults.
    fn close(&mut self) {
        let Some((reader, _)) = self.reader.take() else { return };
        self.faults.extend(reader.faults().iter().map(|Fault { frame, reason }| (*frame, reason.clone())));
    }
}

/// Counts the frames of a video that announces none, by decoding it.
fn counted(ffmpeg: &Ffmpeg, info: &VideoInfo, damaged: Damaged) -> Result<u64, VideoError> {
    let mut reader = VideoReader::open(ffmpeg, info, ReadOptions { damaged, ..ReadOptions::default() })?;
    let mut count = 0;
    while let Some(frame) = reader.next_frame()? {
        count = frame.index + 1;
    }
    Ok(count)
}
