//! Damage of a video's frames, as far as its decoders tell of it, and the frames that it reaches.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use cosmorama_video::{CutShort, Fault};

use super::FrameDamage;

/// First frames of faults, each with the number of frames and the reason.
pub(super) type Faults = BTreeMap<u64, (u64, String)>;

/// Damage of a video.
#[derive(Debug, Default)]
pub(super) struct Damage {
    /// Faults of frames that are left out, or in place of which others are shown.
    pub(super) faults: Faults,
    /// Damaged frames before those that were asked for, after which some of these take.
    pub(super) before: Faults,
    /// Frames of which a decoder said something.
    suspects: BTreeSet<u64>,
    /// Number of faults that the decoder at work has told of.
    told: usize,
    /// Frames that all of these reach.
    reached: Reached,
    /// Frames that were decoded and are not what they should be.
    frames: BTreeMap<u64, FrameDamage>,
}

/// Findings of a decoder.
pub(super) struct Told<'a> {
    /// Faults of the frames that are asked for.
    pub(super) faults: Vec<&'a Fault>,
    /// Faults before them.
    pub(super) before: Vec<&'a Fault>,
    /// Frames of which something was said last.
    pub(super) suspects: Vec<u64>,
}

/// Frames that damage reaches.
#[derive(Debug, Default)]
struct Reached {
    damaged: Vec<Range<u64>>,
    /// Frames that may show traces of it; `None` where the file does not tell: then all behind the first are meant.
    traced: Option<BTreeSet<u64>>,
}

impl Damage {
    /// Notes that another decoder begins, which may tell of the same.
    pub(super) fn begin(&mut self) {
        self.told = 0;
    }

    /// Notes what a decoder tells.
    pub(super) fn note(&mut self, Told { faults, before, suspects }: Told) {
        self.suspects.extend(suspects);
        if self.told == faults.len() + before.len() {
            return;
        }
        self.told = faults.len() + before.len();
        for (known, found) in [(&mut self.faults, faults), (&mut self.before, before)] {
            for Fault { frame, count, reason } in found {
                // Of two streams, or of two decoders, the longer gap.
                let known = known.entry(*frame).or_insert_with(|| (*count, reason.clone()));
                known.0 = known.0.max(*count);
            }
        }
    }

    /// Notes a frame that was decoded. By what is known then, so that it does not matter who asks for it, and when.
    pub(super) fn note_frame(
        &mut self,
        frame: u64,
        is_held: bool,
        traces: impl FnOnce(&[Range<u64>]) -> Option<BTreeSet<u64>>,
    ) {
        let damaged = ranges(self.faults.iter().chain(&self.before));
        let damaged: Vec<_> = damaged.chain(self.suspects.iter().map(|frame| *frame..frame + 1)).collect();
        if damaged != self.reached.damaged {
            self.reached = Reached { traced: traces(&damaged), damaged };
        }
        let found =
            if is_held { Some(FrameDamage::Held) } else { self.reached.has(frame).then_some(FrameDamage::Traces) };
        self.frames.extend(found.map(|found| (frame, found)));
    }

    /// Returns what is the matter with a frame that was decoded.
    pub(super) fn of_frame(&self, frame: u64) -> Option<FrameDamage> {
        self.frames.get(&frame).copied()
    }

    /// Returns the complaint about frames that were held or left out. `traces` counts the frames that take after some.
    pub(super) fn complaint(&self, is_left_out: bool, traces: impl Fn(&Faults) -> u64) -> Option<String> {
        let faults = &self.faults;
        let (first, (_, reason)) = faults.first_key_value()?;
        let count: u64 = faults.values().map(|(count, _)| count).sum();
        let instead = if is_left_out {
            "left out, so that what follows comes earlier than its sound"
        } else {
            "replaced by the one before"
        };
        let further = match traces(faults) {
            0 => String::new(),
            1 => "; 1 further frame may take after them, and show traces".to_owned(),
            traced => format!("; {traced} further frames may take after them, and show traces"),
        };
        Some(format!(
            "{count} {} damaged or missing, and {instead}; the first is frame {first} ({reason}){further}",
            if count == 1 { "frame is" } else { "frames are" }
        ))
    }

    /// Returns the complaint about frames that may take after one that was not asked for.
    pub(super) fn complaint_before(&self, traces: impl Fn(&Faults) -> u64) -> Option<String> {
        let (damaged, (_, reason)) = self.before.first_key_value()?;
        let traced = traces(&self.before);
        (traced > 0).then(|| {
            let frames = if traced == 1 { "frame may" } else { "frames may" };
            format!("{traced} {frames} take after frame {damaged}, which is damaged ({reason}) though it is not asked for, and show traces")
        })
    }
}

impl Reached {
    fn has(&self, frame: u64) -> bool {
        let is_damaged = self.damaged.iter().any(|range| range.contains(&frame));
        let first = || self.damaged.iter().map(|range| range.start).min();
        is_damaged
            || match &self.traced {
                Some(traced) => traced.contains(&frame),
                None => first().is_some_and(|first| first < frame),
            }
    }
}

/// Returns the frames of faults.
pub(super) fn ranges<'a>(
    faults: impl IntoIterator<Item = (&'a u64, &'a (u64, String))>,
) -> impl Iterator<Item = Range<u64>> {
    faults.into_iter().map(|(first, (count, _))| *first..first.saturating_add(*count))
}

/// Returns the complaint about frames that a cut file may lack, when so many were read.
pub(super) fn may_lack(CutShort { expected, found }: CutShort, read: usize) -> String {
    format!(
        "the file is cut, with {found} of at least {expected} bytes; there may have been more frames than the {read} that are read"
    )
}

/// Returns the complaint about frames that were not announced.
pub(super) fn more_than(announced: u64) -> String {
    format!(
        "there are more frames than the {announced} that it announces; they are left out, so write it again by a program that counts them"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(frame: u64, count: u64) -> Fault {
        Fault { frame, count, reason: "it is bad".to_owned() }
    }

    fn told<'a>(faults: &'a [Fault], suspects: &[u64]) -> Told<'a> {
        Told { faults: faults.iter().collect(), before: Vec::new(), suspects: suspects.to_vec() }
    }

    /// Frames up to the next multiple of ten take after damaged ones.
    fn up_to_key(damaged: &[Range<u64>]) -> Option<BTreeSet<u64>> {
        Some(damaged.iter().flat_map(|range| range.end..range.end.next_multiple_of(10)).collect())
    }

    #[test]
    fn frames_know_of_damage_by_the_time_they_are_decoded() {
        let mut damage = Damage::default();
        for frame in 0..30 {
            match frame {
                12 => damage.note(told(&[fault(12, 2)], &[])),
                // A message that is of no frame that was missed is told of late.
                21..25 => damage.note(told(&[fault(12, 2)], &[21])),
                25.. => damage.note(told(&[fault(12, 2), fault(21, 1)], &[])),
                _ => {}
            }
            damage.note_frame(frame, (12..14).contains(&frame), up_to_key);
        }
        let of = |found| (0..30).filter(|frame| damage.of_frame(*frame) == found).collect::<Vec<_>>();
        assert_eq!(of(Some(FrameDamage::Held)), [12, 13]);
        assert_eq!(of(Some(FrameDamage::Traces)), [14, 15, 16, 17, 18, 19, 21, 22, 23, 24, 25, 26, 27, 28, 29]);
    }

    #[test]
    fn all_frames_behind_damage_are_meant_where_a_file_does_not_tell() {
        let mut damage = Damage::default();
        damage.note(told(&[fault(5, 1)], &[]));
        (3..8).for_each(|frame| damage.note_frame(frame, frame == 5, |_| None));
        let found = (3..8).map(|frame| damage.of_frame(frame)).collect::<Vec<_>>();
        let traces = Some(FrameDamage::Traces);
        assert_eq!(found, [None, None, Some(FrameDamage::Held), traces, traces]);
    }

    #[test]
    fn decoders_that_begin_anew_tell_of_the_same_damage_once() {
        let mut damage = Damage::default();
        damage.note(told(&[fault(5, 1), fault(8, 2)], &[]));
        damage.begin();
        damage.note(told(&[fault(8, 4)], &[]));
        assert_eq!(ranges(&damage.faults).collect::<Vec<_>>(), [5..6, 8..12]);
    }
}
