//! Verification of the frames of a sequence or a video: which are missing, damaged, of another kind, black, frozen, or flash.

mod frame;
mod judge;
mod sheet;

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use cosmorama::raster::{Image, Rgba};
use cosmorama_io::{Choice, FrameList, Frames, IoError, Limits};
use cosmorama_spec::{Size, TimeRanges};
use rayon::prelude::*;

use super::check::frames_at_times;
use super::{Observer, Stop, threads};
use crate::diagnostic::{Code, ConvertError, Diagnostic, EVERY, FRAMES, Result, bail, usage};
use crate::input::is_one_file;
use crate::job::real_path;
use crate::settings::LimitSettings;
use crate::source::video::{DamagedFrames, Videos};
use crate::source::{ChosenFiles, Files, MemoryBudget, Name, ViewFiles, existing_frames, light_bytes, probe};
use frame::{Found, Frame};
use sheet::Shown;

pub use judge::{Fault, Faults};
pub use sheet::SheetLayout;

/// Sequence to verify.
#[derive(Clone, Debug)]
pub struct Verification<'a> {
    /// Pattern of the frames' names, such as `dome_####.png`, or a video.
    pub pattern: &'a Name,
    /// Frames that there should be; all from the first to the last, if not given.
    pub frames: Option<FrameList>,
    /// Times of a video, in place of numbers.
    pub times: Option<TimeRanges>,
    /// Size that they should have; that of most, if not given.
    pub size: Option<Size>,
    /// Threads, and memory for decoded frames and the contact sheet.
    pub limits: LimitSettings,
    /// Frames that a contact sheet shows; `None` without one.
    pub sheet: Option<SheetLayout>,
}

/// Result of a verification.
#[derive(Clone, Debug)]
pub struct Verified {
    /// Number of frames that there should be, with a further one where a video has more than it announces, or its file is cut.
    pub frames: usize,
    /// Faults of each frame that has some, in the order of the frames.
    pub faults: Vec<Faults>,
    /// Small pictures of the frames that were asked for, row by row, with their numbers: red where there is a fault.
    pub sheet: Option<Image<Rgba>>,
}

impl Verified {
    /// Returns the frames with a fault.
    pub fn faulty(&self) -> FrameList {
        FrameList::new(self.faults.iter().map(|of| of.frame))
    }
}

/// Greatest number of frames that are read together.
const AT_ONCE: usize = 64;

/// Places in a pattern where names stand that are no frame numbers.
const NAMES: [&str; 4] = ["{face}", "%c", "{eye}", "{level}"];

impl Verification<'_> {
    /// Reads every frame, and judges it by itself and beside its neighbours.
    ///
    /// # Errors
    /// When the pattern is a folder, is no video and has no frame marker, or leaves a face, an eye or a level open; its folder or all its frames are
    /// missing; the first and the last are too far apart; a video has no frame at the times; a frame may not be read or needs more memory than permitted, or the sheet does;
    /// [`ConvertError::Stopped`] if the observer ends it.
    pub fn run(&self, files: Arc<dyn Files>, observer: &mut dyn Observer) -> Result<Verified> {
        // A decoder goes on after a frame that it leaves out.
        let files = &ChosenFiles::new(files, Choice::default(), DamagedFrames::Skip);
        let Some(times) = &self.times else { return self.verified(files, observer) };
        let frames = Some(frames_at_times(times, self.pattern, files)?);
        Self { frames, ..self.clone() }.verified(files, observer)
    }

    fn verified(&self, files: &ChosenFiles, observer: &mut dyn Observer) -> Result<Verified> {
        let series = series(self.pattern, files)?;
        let wanted = self.wanted(&series, files)?;
        let video = series.video().zip(files.videos());
        let count = video.map_or(Ok(None), |(video, videos)| videos.count(video))?;
        let decoding = video.map_or(Ok(0), |(video, videos)| videos.memory(video))?;
        let memory = self.memory_beside(wanted.len())?.beside_codecs(decoding, "")?;
        let (pool, limits) = (threads(self.limits.threads)?, Limits::memory(memory.bytes));
        if video.is_some() {
            self.tell_complaints(&series, &wanted, files, observer);
        }
        observer.begin(Some(wanted.len()));
        let mut frames: Vec<Frame> = Vec::with_capacity(wanted.len());
        let mut rest = &wanted[..];
        while !rest.is_empty() {
            let first = frames.len();
            let (some, later) = rest.split_at(fitting(files, &series, rest, memory)?);
            let read = |(index, number): (usize, &u64)| {
                if count.is_some_and(|count| *number >= count) {
                    return Ok(Frame { number: *number, found: Found::Nothing, thumbnail: None });
                }
                let is_shown = self.sheet.is_some_and(|sheet| sheet.shows(first + index));
                Frame::read(files, (*number, &series.path(Some(*number))), &limits, is_shown)
            };
            // All of them, so that the first in order is told of, whichever thread is the fastest.
            let found: Vec<Result<Frame>> = pool.install(|| some.par_iter().enumerate().map(read).collect());
            for (number, frame) in some.iter().zip(found) {
                frames.push(frame?);
                if observer.frame_done(Some(*number)) == ControlFlow::Break(Stop) {
                    return Err(ConvertError::Stopped { done: frames.len(), frames: Some(wanted.len()) });
                }
            }
            rest = later;
        }
        if let Some((video, videos)) = video {
            tell_reasons(&mut frames, video, videos)?;
        }
        let faults = judge::faults(&frames, self.size);
        let asked = &frames[..wanted.len()];
        let sheet = self.sheet.map(|layout| drawn(asked, &faults, layout));
        Ok(Verified { frames: frames.len(), faults, sheet })
    }

    /// Tells what is to be said of a video as a whole.
    fn tell_complaints(&self, series: &ViewFiles, wanted: &[u64], files: &dyn Files, observer: &mut dyn Observer) {
        let header = wanted.first().and_then(|first| probe(files, &series.path(Some(*first))).ok());
        for words in header.map_or_else(Vec::new, |header| header.metadata.complaints) {
            let told = Diagnostic::warning(Code::Metadata, format!("{}: {words}", self.pattern));
            observer.diagnostic(&told.about(self.pattern));
        }
    }

    /// Returns the frames that there should be, in order.
    fn wanted(&self, series: &ViewFiles, files: &dyn Files) -> Result<Vec<u64>> {
        let mut wanted = self.frames.as_ref().map_or_else(Vec::new, |frames| frames.frames().to_vec());
        wanted.sort_unstable();
        let ViewFiles::Sequence(pattern) = series else { return self.wanted_of_video(series, wanted, files) };
        let (folder, text) = (pattern.folder(), self.pattern);
        if !folder.is_dir() && !wanted.iter().any(|frame| files.holds(&pattern.path(*frame))) {
            bail!(NotFound: "{text}: there is no folder {}; name one that holds frames", folder.display());
        }
        if self.frames.is_some() {
            return Ok(wanted);
        }
        match existing_frames(series, files)?[..] {
            [first, .., last] if last - first >= Frames::MOST => {
                let far = IoError::FarFrames { pattern: text.to_string(), existing: (first, last) };
                Err(usage(far.to_string()))
            }
            [first, .., last] => Ok((first..=last).collect()),
            ref few => Ok(few.to_vec()),
        }
    }

    /// Returns the frames that a video should have, and says which will be read.
    fn wanted_of_video(&self, series: &ViewFiles, wanted: Vec<u64>, files: &dyn Files) -> Result<Vec<u64>> {
        let (Some(video), Some(videos)) = (series.video(), files.videos()) else { return Ok(wanted) };
        is_one_file(files, self.pattern, video)?;
        let there = existing_frames(series, files)?;
        let wanted = if self.frames.is_some() { wanted } else { there.clone() };
        videos.expect(video, wanted.iter().copied().filter(|frame| *frame < there.len() as u64))?;
        Ok(wanted)
    }

    /// Checks that what is kept of so many frames fits into memory, and returns what is left to read them.
    fn memory_beside(&self, frames: usize) -> Result<MemoryBudget> {
        let memory = MemoryBudget::new(self.limits.memory);
        let kept = Frame::BYTES.saturating_mul(frames as u64);
        memory.allow(kept, "what is kept of frames", &format!("; there are {frames}, and {FRAMES} chooses fewer"))?;
        let memory = memory.beside(kept);
        let Some(sheet) = self.sheet else { return Ok(memory) };
        let shown = sheet.count(frames);
        let bytes = sheet::bytes(shown);
        memory.allow(bytes, "the sheet", &format!("; it shows {shown} frames, and {EVERY} chooses fewer"))?;
        Ok(memory.beside(bytes))
    }
}

/// Returns the files of a pattern, or the video that it names.
fn series(pattern: &Name, files: &dyn Files) -> Result<ViewFiles> {
    pattern.check()?;
    if let Some(name) = NAMES.into_iter().find(|name| pattern.contains(name)) {
        return Err(usage(format!(
            "{pattern} has {name}, but a sequence has one file for each frame; write a name there, and verify each by itself"
        )));
    }
    match ViewFiles::new(Path::new(pattern)) {
        ViewFiles::One(path) => {
            if path.is_dir() {
                // It tells which sequences are in the folder.
                is_one_file(files, pattern, &path)?;
            }
            Err(usage(format!(
                "{pattern} has no frame marker such as #### or %04d; write one where the frame number stands"
            )))
        }
        series => Ok(series),
    }
}

/// Puts what the decoder of a video says of frames into their places, when it has said all: of those that it left out, and of those that
/// it handed out and complained of later. Frames after all that were announced count as a further one.
fn tell_reasons(frames: &mut Vec<Frame>, video: &Path, videos: &Videos) -> Result<()> {
    videos.end()?;
    let faults = videos.faults(video)?;
    for frame in frames.iter_mut() {
        let reason = faults.iter().find(|(range, _)| range.contains(&frame.number)).map(|(_, reason)| reason);
        if let Some(reason) = reason {
            frame.found = Found::Damage(reason.clone());
        }
    }
    let after = videos.count(video)?.filter(|after| frames.last().is_some_and(|last| last.number < *after));
    let further = faults.into_iter().filter(|(range, _)| Some(range.start) == after);
    let further = further.take(1).map(|(range, reason)| (range.start, Found::Damage(reason)));
    frames.extend(further.map(|(number, found)| Frame { number, found, thumbnail: None }));
    Ok(())
}

/// Draws the contact sheet.
fn drawn(frames: &[Frame], faults: &[Faults], layout: SheetLayout) -> Image<Rgba> {
    let shown = frames.iter().enumerate().filter(|(index, _)| layout.shows(*index)).map(|(_, frame)| Shown {
        number: frame.number,
        picture: frame.thumbnail.as_ref(),
        is_faulty: faults.binary_search_by_key(&frame.number, |of| of.frame).is_ok(),
    });
    sheet::of(&shown.collect::<Vec<_>>())
}

/// Returns how many of the next frames fit into memory at once when decoded.
fn fitting(files: &dyn Files, series: &ViewFiles, next: &[u64], memory: MemoryBudget) -> Result<usize> {
    let mut left = memory.bytes;
    for (count, frame) in next.iter().take(AT_ONCE).enumerate() {
        let path = series.path(Some(*frame));
        // Nothing is decoded of a frame that is missing or damaged.
        let Ok(header) = probe(files, &path) else { continue };
        let bytes = light_bytes(&header);
        memory.allow(
            bytes,
            &path.display().to_string(),
            &format!("; it has {}x{} pixels", header.width, header.height),
        )?;
        match left.checked_sub(bytes) {
            Some(rest) => left = rest,
            None => return Ok(count),
        }
    }
    Ok(next.len().min(AT_ONCE))
}

/// Refuses a contact sheet in the place of a frame, whether that exists or not.
///
/// # Errors
/// When the sheet's name is one of the sequence's, or leads to the file of a frame.
pub fn check_sheet(pattern: &Name, sheet: &Path) -> Result<()> {
    let place = real_path(sheet);
    let refused = || Err(usage(format!("{}: the sheet would replace a frame; choose another name", sheet.display())));
    let frames = match ViewFiles::new(pattern.path()) {
        ViewFiles::Sequence(frames) => frames,
        other => return if real_path(&other.path(None)) == place { refused() } else { Ok(()) },
    };
    let named = place.strip_prefix(real_path(&frames.folder())).ok().and_then(|below| frames.frame_at(below));
    // A frame may be a link to what is elsewhere.
    let leads = |frame: u64| real_path(&frames.path(frame)) == place;
    if named.is_some() || frames.existing().is_ok_and(|existing| existing.into_iter().any(leads)) {
        return refused();
    }
    Ok(())
}
