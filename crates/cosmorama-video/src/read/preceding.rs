//! Damage before the first frame that is asked for, and at the end of those that are.

use super::reader::MARGIN;
use super::{CodedOrder, Damaged, Fault, ReadOptions, VideoReader};
use crate::probe::CodedFrame;
use crate::{Ffmpeg, Timeline, VideoError, VideoInfo};

/// A video in which damage is looked for.
#[derive(Clone, Copy)]
pub(super) struct Looked<'a> {
    pub(super) ffmpeg: &'a Ffmpeg,
    pub(super) info: &'a VideoInfo,
    pub(super) timeline: &'a Timeline,
    pub(super) options: &'a ReadOptions,
}

/// Damage up to a frame, found by decoding once more. Messages alone do not tell: decoders complain of frames that lack others before the
/// place where they began, too, and of frames that come later.
pub(super) struct Damage {
    /// Frame from which was decoded: a key frame, if the file tells of any.
    pub(super) start: u64,
    /// Damaged frames from there on.
    pub(super) faults: Vec<Fault>,
    /// Coded frames around the frame.
    coded: Vec<CodedFrame>,
}

/// Damaged frames before the first that is asked for, and the first frame after it that may show traces of them.
pub(super) struct Before {
    pub(super) faults: Vec<Fault>,
    pub(super) traced: u64,
}

impl Looked<'_> {
    /// Decodes from the second key frame before a frame up to the last one, by one thread, so that messages come before their frames. What
    /// is heard before the first of them is not: damage of that key frame reaches to the next one.
    pub(super) fn damage(self, (frame, last): (u64, u64)) -> Result<Damage, VideoError> {
        let Self { ffmpeg, info, options, .. } = self;
        let mut coded = self.around(frame)?;
        let mut keys = self.keys_before(&coded, frame);
        if keys.len() < 2 && self.timeline.time(0) != coded.iter().map(|coded| coded.time).min() {
            coded = ffmpeg.coded_frames(&info.path, info.stream, &[])?;
            keys = self.keys_before(&coded, frame);
        }
        let start = if keys.len() < 2 { 0 } else { keys[keys.len() - 2] };
        let options = ReadOptions { frames: Some(start..=last), damaged: Damaged::Skip, threads: 1, ..options.clone() };
        let mut reader = VideoReader::looking_no_further(ffmpeg, info, options)?;
        while reader.next_frame()?.is_some() {}
        Ok(Damage { start, faults: reader.faults().to_vec(), coded })
    }

    /// Reads what is said of the coded frames around one, from a while before.
    fn around(self, frame: u64) -> Result<Vec<CodedFrame>, VideoError> {
        /// Seconds behind it, within which frames that are decoded before it are shown.
        const BEHIND: f64 = 2.0;
        /// Seconds before it: the seek ends at a key frame before that.
        const BEFORE: f64 = 2.0;
        let Some(time) = self.timeline.time(frame) else { return Ok(Vec::new()) };
        let seconds = time as f64 * self.info.time_base.to_f64();
        let part = format!("{:.3}%{:.3}", (seconds - MARGIN - BEFORE).max(0.0), (seconds + BEHIND).max(0.0));
        self.ffmpeg.coded_frames(&self.info.path, self.info.stream, &["-read_intervals", &part])
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

    /// Returns the damage before a frame, if a frame that is looked at may show traces of it.
    pub(super) fn before(self, frame: u64, looked: Looked) -> Option<Before> {
        let Looked { info, timeline, options, .. } = looked;
        let part = |fault: &Fault| Fault { count: fault.count.min(frame - fault.frame), ..fault.clone() };
        let faults: Vec<Fault> = self.faults.iter().filter(|fault| fault.frame < frame).map(part).collect();
        let damaged: Vec<_> = faults.iter().map(|fault| fault.frame..fault.frame + fault.count).collect();
        let all = if self.coded.is_empty() && !faults.is_empty() {
            vec![frame]
        } else {
            CodedOrder::new(self.coded, timeline.clone(), info).traces(&damaged)
        };
        let traced = all.into_iter().find(|traced| *traced >= frame && options.looks_at(*traced))?;
        Some(Before { faults, traced })
    }
}
