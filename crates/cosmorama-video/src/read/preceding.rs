//! Damage around a frame of which something was heard, found by decoding once more.

use std::ops::Range;

use cosmorama::raster::EncodedImage;

use super::decoder::MARGIN;
use super::{CodedOrder, Damaged, Fault, ReadOptions, VideoReader};
use crate::probe::{AVI, CodedFrame};
use crate::{AnnouncedBy, Ffmpeg, Timeline, VideoError, VideoInfo};

/// A video in which damage is looked for.
#[derive(Clone, Copy)]
pub(super) struct Looked<'a> {
    pub(super) ffmpeg: &'a Ffmpeg,
    pub(super) info: &'a VideoInfo,
    pub(super) timeline: &'a Timeline,
    pub(super) options: &'a ReadOptions,
}

/// B frames that follow each other at most.
const MOST_B_FRAMES: u64 = 16;

/// Damage around a frame, found by decoding once more. Messages alone do not tell: decoders complain of frames that lack others before the
/// place where they began, too, and of frames that come later.
pub(super) struct Damage {
    /// The frame.
    pub(super) frame: u64,
    /// Frame from which was decoded: a key frame, if the file tells of any.
    pub(super) start: u64,
    /// Frame up to which was decoded.
    pub(super) last: u64,
    /// Whether the decoder gave the frame itself, whatever it said of it.
    pub(super) is_given: bool,
    /// Damaged frames from there on.
    pub(super) faults: Vec<Fault>,
    /// Coded frames around the frame.
    coded: Vec<CodedFrame>,
}

/// Damaged frames beside those that are looked at, and the first of these that may show traces of them.
pub(super) struct Beside {
    pub(super) faults: Vec<Fault>,
    pub(super) traced: u64,
}

/// Frames beyond one of which something was heard within which the damaged one is: decoders work on as many at a time.
pub(super) const PATIENCE: u64 = 64;

/// Frames at the end of a look of which messages may be about later ones: one thread works on no more at a time.
pub(super) const DELAY: u64 = 17;

impl Looked<'_> {
    /// Decodes from the second key frame before a frame to some behind it, by one thread, so that messages come before their frames. What
    /// is heard before the first of them is not: damage of that key frame reaches to the next one.
    pub(super) fn damage(self, frame: u64) -> Result<Damage, VideoError> {
        let Self { ffmpeg, info, options, .. } = self;
        // The time of a damaged picture may be wrong.
        let frame = self.sure_last().map_or(frame, |last| frame.min(last));
        let (start, coded) = self.start_before(frame)?;
        let last = self.last().map_or(frame, |last| last.min(frame + PATIENCE)).max(frame);
        let frames = Some(start..=last);
        let damaged = Damaged::Skip;
        let options = ReadOptions { frames, looked_at: None, damaged, threads: 1, ..options.clone() };
        let mut reader = VideoReader::looking_no_further(ffmpeg, info, options)?;
        let mut is_given = false;
        loop {
            match reader.next_frame() {
                Ok(Some(given)) => is_given |= given.index == frame,
                // There may be fewer than are announced.
                Ok(None) | Err(VideoError::NoSuchFrame { .. }) => break,
                Err(error) => return Err(error),
            }
        }
        Ok(Damage { frame, start, last, is_given, faults: reader.faults().to_vec(), coded })
    }

    /// Decodes the frame that is shown before one, with others in the places of damaged ones; `None` if there is none.
    pub(super) fn shown_before(self, frame: u64) -> Result<Option<EncodedImage>, VideoError> {
        let Some(before) = frame.checked_sub(1) else { return Ok(None) };
        let (start, _) = self.start_before(frame)?;
        let frames = Some(start..=before);
        let damaged = Damaged::Hold;
        let options = ReadOptions { frames, looked_at: None, damaged, threads: 1, ..self.options.clone() };
        let mut reader = VideoReader::looking_no_further(self.ffmpeg, self.info, options)?;
        let mut shown = None;
        while let Some(frame) = reader.next_frame()? {
            shown = Some(frame.image);
        }
        Ok(shown)
    }

    /// Returns whether frames that are missing would be decoded behind the last that the file has: where a film was cut out without coding it
    /// anew, the end of its last group lacks them. They are not damaged, and players show the frame before on.
    pub(super) fn lacks_from_its_end(self, missing: &Range<u64>) -> Result<bool, VideoError> {
        let Self { info, timeline, .. } = self;
        if info.is_variable
            || info.cut.is_some()
            || info.container == AVI
            || missing.end - missing.start > MOST_B_FRAMES
        {
            return Ok(false);
        }
        let numbers: Vec<u64> = self.around(missing.end)?.into_iter().map(|coded| timeline.frame(coded.time)).collect();
        let mut behind = numbers.iter().skip_while(|number| **number != missing.end).peekable();
        let is_last =
            behind.peek().is_some() && behind.all(|number| *number <= missing.end && !missing.contains(number));
        Ok(is_last && ends_as_it_began(&numbers))
    }

    /// Returns the number of the last frame, if the file lists or counts them: a duration may be rounded.
    pub(super) fn sure_last(self) -> Option<u64> {
        let counted = self.info.announced.filter(|announced| announced.by == AnnouncedBy::Count);
        self.timeline.frames().or(counted.map(|announced| announced.frames))?.checked_sub(1)
    }

    /// Returns the number of the last frame, as far as it is known.
    pub(super) fn last(self) -> Option<u64> {
        let announced = self.info.announced.map(|announced| announced.frames);
        self.timeline.frames().or(announced)?.checked_sub(1)
    }

    /// Returns the second key frame before a frame, or the first frame, with the coded frames around.
    fn start_before(self, frame: u64) -> Result<(u64, Vec<CodedFrame>), VideoError> {
        let Self { ffmpeg, info, .. } = self;
        let mut coded = self.around(frame)?;
        let mut keys = self.keys_before(&coded, frame);
        if keys.len() < 2 && self.timeline.time(0) != coded.iter().map(|coded| coded.time).min() {
            coded = ffmpeg.coded_frames(info, &[])?;
            keys = self.keys_before(&coded, frame);
        }
        Ok((if keys.len() < 2 { 0 } else { keys[keys.len() - 2] }, coded))
    }

    /// Reads what is said of the coded frames around one, from a while before.
    fn around(self, frame: u64) -> Result<Vec<CodedFrame>, VideoError> {
        /// Seconds behind it, within which frames that are decoded before it are shown; and frames, where these are slow.
        const BEHIND: (f64, f64) = (4.0, 40.0);
        /// Seconds before it: the seek ends at a key frame before that.
        const BEFORE: f64 = 2.0;
        let Some(time) = self.timeline.time(frame).filter(|_| !self.info.is_bare()) else {
            return Ok(Vec::new());
        };
        let seconds = time as f64 * self.info.time_base.to_f64();
        let behind = BEHIND.0.max(BEHIND.1 / self.info.rate.to_f64());
        let part = format!("{:.3}%{:.3}", (seconds - MARGIN - BEFORE).max(0.0), (seconds + behind).max(0.0));
        self.ffmpeg.coded_frames(self.info, &["-read_intervals", &part])
    }

    /// Returns the numbers of the key frames before a frame, in order.
    fn keys_before(self, coded: &[CodedFrame], frame: u64) -> Vec<u64> {
        let keys = coded.iter().filter(|coded| coded.is_key).map(|coded| self.timeline.frame(coded.time));
        let mut keys: Vec<u64> = keys.filter(|key| *key < frame).collect();
        keys.sort_unstable();
        keys.dedup();
        keys
    }
}

impl Damage {
    /// Returns the fault of a frame, if it is damaged.
    pub(super) fn of(&self, frame: u64) -> Option<&Fault> {
        self.faults.iter().find(|fault| (fault.frame..fault.frame + fault.count).contains(&frame))
    }

    /// Returns the first fault of a frame that is looked at.
    pub(super) fn of_looked_at(&self, options: &ReadOptions) -> Option<&Fault> {
        self.faults.iter().find(|fault| options.looks_at_any(&frames(fault)))
    }

    /// Returns the damage beside the frames that are looked at, if one of these may show traces of it.
    pub(super) fn beside(&self, looked: Looked) -> Option<Beside> {
        let Looked { info, timeline, options, .. } = looked;
        let is_beside = |fault: &&Fault| !options.looks_at_any(&frames(fault));
        let faults: Vec<Fault> = self.faults.iter().filter(is_beside).cloned().collect();
        let damaged: Vec<_> = faults.iter().map(frames).collect();
        let all = if self.coded.is_empty() && !faults.is_empty() {
            vec![self.frame]
        } else {
            CodedOrder::new(self.coded.clone(), timeline.clone(), info).traces(&damaged)
        };
        let traced = all.into_iter().find(|traced| options.looks_at(*traced))?;
        Some(Beside { faults, traced })
    }
}

/// Returns whether the last frames, by their numbers in the order in which they are decoded, are the first of such as came before: of one frame,
/// and those that are shown between it and the one shown last. Where one is lost from among them, they are not.
fn ends_as_it_began(numbers: &[u64]) -> bool {
    let mut groups: Vec<(u64, Vec<u64>)> = Vec::new();
    for number in numbers {
        match groups.last_mut() {
            Some((end, group)) if number <= end => group.push(*end - number),
            _ => groups.push((*number, Vec::new())),
        }
    }
    let mut before: Vec<_> = groups.windows(2).map(|pair| (pair[1].0 - pair[0].0, &pair[1].1)).collect();
    let Some((size, end)) = before.pop() else { return true };
    before.retain(|(other, group)| *other == size && group.len() as u64 + 1 == size);
    before.is_empty() || before.iter().any(|(_, group)| group.starts_with(end))
}

/// Returns the frames of a fault.
fn frames(fault: &Fault) -> Range<u64> {
    fault.frame..fault.frame.saturating_add(fault.count)
}
