//! Damage of a video's frames, as far as its decoders tell of it, and the frames that it reaches.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use cosmorama_io::FrameList;
use cosmorama_video::{CutShort, Damaged, Fault};

use super::FrameDamage;

/// Faults by their first frames.
pub(super) type Faults = BTreeMap<u64, Fault>;

/// Damage of a video.
#[derive(Debug, Default)]
pub(super) struct Damage {
    /// Faults of frames that were asked for.
    pub(super) faults: Faults,
    /// Damaged frames beside those that were asked for, after which some of these take.
    pub(super) beside: Faults,
}

/// Findings of a decoder.
#[derive(Default)]
pub(super) struct Told<'a> {
    /// Faults of the frames that are asked for.
    pub(super) faults: Vec<&'a Fault>,
    /// Faults of others.
    pub(super) beside: Vec<&'a Fault>,
    /// Faults of either, some of which are to come.
    pub(super) foreseen: Vec<&'a Fault>,
}

/// Frames that damage has reached.
#[derive(Debug, Default)]
pub(super) struct Marks {
    /// Damaged frames, in the order in which they became known.
    known: Vec<Range<u64>>,
    /// Beginnings and ends of these.
    ends: BTreeSet<[u64; 2]>,
    /// Frames that were decoded after some was known.
    frames: BTreeMap<u64, Mark>,
    /// Frames that the first so many of these reach.
    reached: (usize, Reached),
}

/// Mark of a frame that was decoded.
#[derive(Clone, Copy, Debug)]
enum Mark {
    /// Another one stands in its place.
    Held,
    /// So many damaged frames were known by then.
    Knowing(usize),
}

/// Frames that damage reaches.
#[derive(Debug, Default)]
struct Reached {
    damaged: Vec<Range<u64>>,
    /// Frames that may show traces of it; `None` where the file does not tell: then all behind the first are meant.
    traced: Option<BTreeSet<u64>>,
}

impl Marks {
    /// Marks a frame that was just decoded, by what is known then: so that it does not matter who asks for it, and when.
    pub(super) fn mark(&mut self, frame: u64, is_held: bool, told: &Told) {
        for fault in told.faults.iter().chain(&told.beside).chain(&told.foreseen) {
            let range = fault.frame..fault.frame.saturating_add(fault.count);
            if self.ends.insert([range.start, range.end]) {
                self.known.push(range);
            }
        }
        let mark = if is_held { Mark::Held } else { Mark::Knowing(self.known.len()) };
        if !self.known.is_empty() {
            self.frames.insert(frame, mark);
        }
    }

    /// Returns what is the matter with a frame that was decoded. `traces` finds the frames that take after others.
    pub(super) fn of_frame(
        &mut self,
        frame: u64,
        traces: impl FnOnce(&[Range<u64>]) -> Option<BTreeSet<u64>>,
    ) -> Option<FrameDamage> {
        let count = match self.frames.get(&frame)? {
            Mark::Held => return Some(FrameDamage::Held),
            Mark::Knowing(count) => *count,
        };
        if self.reached.0 != count {
            let damaged = self.known[..count].to_vec();
            self.reached = (count, Reached { traced: traces(&damaged), damaged });
        }
        self.reached.1.has(frame).then_some(FrameDamage::Traces)
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

impl Damage {
    /// Notes what a decoder has told by its end.
    pub(super) fn note(&mut self, Told { faults, beside, .. }: Told) {
        for (known, found) in [(&mut self.faults, faults), (&mut self.beside, beside)] {
            for fault in found {
                // Of two streams, or of two decoders, the longer gap.
                let known = known.entry(fault.frame).or_insert_with(|| fault.clone());
                known.count = known.count.max(fault.count);
                known.is_given &= fault.is_given;
            }
        }
    }

    /// Returns the complaint about frames that were held or left out, perhaps of a film, and about those that may be damaged. `traces`
    /// counts the frames that take after some.
    pub(super) fn complaint(
        &self,
        (answer, makes_film): (Damaged, bool),
        traces: impl Fn(&Faults) -> u64,
    ) -> Option<String> {
        let instead = match (answer, makes_film) {
            (Damaged::Skip, true) => {
                "damaged or missing, and left out, so that what follows comes earlier than its sound"
            }
            (Damaged::Skip, false) => "damaged or missing, and left out",
            _ => "damaged or missing, and replaced by the one before (at the beginning, by the first whole one)",
        };
        let (given, lost): (Vec<&Fault>, Vec<&Fault>) = self.faults.values().partition(|fault| fault.is_given);
        let told = [complaint_of(&lost, instead), complaint_of(&given, "perhaps damaged, and passed on")];
        let told: Vec<String> = told.into_iter().flatten().collect();
        let further = match traces(&self.faults) {
            0 => String::new(),
            1 => "; 1 further frame may take after them, and show traces".to_owned(),
            traced => format!("; {traced} further frames may take after them, and show traces"),
        };
        (!told.is_empty()).then(|| told.join("; ") + &further)
    }

    /// Returns the complaint about frames that may take after one that was not asked for.
    pub(super) fn complaint_beside(&self, traces: impl Fn(&Faults) -> u64) -> Option<String> {
        let (damaged, Fault { reason, .. }) = self.beside.first_key_value()?;
        let traced = traces(&self.beside);
        (traced > 0).then(|| {
            let frames = if traced == 1 { "frame may" } else { "frames may" };
            format!("{traced} {frames} take after frame {damaged}, which is damaged ({reason}) though it is not asked for, and show traces")
        })
    }
}

/// Returns the complaint about the frames of faults; `None` if there are none.
fn complaint_of(faults: &[&Fault], what: &str) -> Option<String> {
    let Fault { frame, reason, .. } = faults.first()?;
    let count: u64 = faults.iter().map(|fault| fault.count).sum();
    let are = if count == 1 { "frame is" } else { "frames are" };
    let all = if count == 1 { String::new() } else { format!("; all: {}", list(faults)) };
    Some(format!("{count} {are} {what}; the first is frame {frame} ({reason}){all}"))
}

/// Returns the frames of faults as a list that `--frames` takes, at most the first thousand.
fn list(faults: &[&Fault]) -> String {
    const SHOWN: usize = 1000;
    let frames: Vec<u64> = ranges(faults.iter().copied()).flatten().take(SHOWN + 1).collect();
    let more = if frames.len() > SHOWN { " and more" } else { "" };
    format!("{}{more}", FrameList::new(frames.into_iter().take(SHOWN)))
}

/// Returns the frames of faults.
pub(super) fn ranges<'a>(faults: impl IntoIterator<Item = &'a Fault>) -> impl Iterator<Item = Range<u64>> {
    faults.into_iter().map(|fault| fault.frame..fault.frame.saturating_add(fault.count))
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
        Fault { frame, count, reason: "it is bad".to_owned(), is_given: false }
    }

    fn told<'a>(faults: &'a [Fault], foreseen: &'a [Fault]) -> Told<'a> {
        Told { faults: faults.iter().collect(), beside: Vec::new(), foreseen: foreseen.iter().collect() }
    }

    /// Frames up to the next multiple of ten take after damaged ones, and the two before.
    fn up_to_key(damaged: &[Range<u64>]) -> Option<BTreeSet<u64>> {
        let around = |range: &Range<u64>| range.start - 2..range.end.next_multiple_of(10);
        Some(damaged.iter().flat_map(around).collect())
    }

    #[test]
    fn frames_know_of_damage_by_the_time_they_are_decoded() {
        let (first, second) = ([fault(12, 2)], [fault(12, 2), fault(25, 1)]);
        let mut marks = Marks::default();
        for frame in 0..30 {
            // Of the first it is heard before its frame comes, of the second only then.
            let told = match frame {
                0..10 => told(&[], &[]),
                10..12 => told(&[], &first),
                12..25 => told(&first, &first),
                _ => told(&second, &first),
            };
            marks.mark(frame, [12, 13, 25].contains(&frame), &told);
        }
        let found: Vec<_> = (0..30).map(|frame| marks.of_frame(frame, up_to_key)).collect();
        let of = |wanted| (0..30).filter(|frame| found[*frame] == Some(wanted)).collect::<Vec<_>>();
        assert_eq!(of(FrameDamage::Held), [12, 13, 25]);
        assert_eq!(of(FrameDamage::Traces), [10, 11, 14, 15, 16, 17, 18, 19, 26, 27, 28, 29]);
        // In any other order, the same.
        assert!((0..30).rev().all(|frame| marks.of_frame(frame, up_to_key) == found[frame as usize]));
    }

    #[test]
    fn all_frames_behind_damage_are_meant_where_a_file_does_not_tell() {
        let (mut marks, faults) = (Marks::default(), [fault(5, 1)]);
        (3..8).for_each(|frame| marks.mark(frame, frame == 5, &told(&faults, &[])));
        let found = (3..8).map(|frame| marks.of_frame(frame, |_| None)).collect::<Vec<_>>();
        let traces = Some(FrameDamage::Traces);
        assert_eq!(found, [None, None, Some(FrameDamage::Held), traces, traces]);
    }

    #[test]
    fn decoders_that_tell_of_the_same_damage_are_told_of_once() {
        let mut damage = Damage::default();
        damage.note(told(&[fault(5, 1), fault(8, 2)], &[]));
        damage.note(told(&[fault(8, 4)], &[]));
        assert_eq!(ranges(damage.faults.values()).collect::<Vec<_>>(), [5..6, 8..12]);
    }

    #[test]
    fn frames_that_came_all_the_same_are_told_apart() {
        let mut damage = Damage::default();
        let doubtful = Fault { is_given: true, ..fault(8, 3) };
        damage.note(told(&[fault(5, 1), doubtful], &[]));
        let complaint = damage.complaint((Damaged::Skip, false), |_| 2).unwrap();
        let expected = "1 frame is damaged or missing, and left out; the first is frame 5 (it is bad); \
                        3 frames are perhaps damaged, and passed on; the first is frame 8 (it is bad); all: 8-10; \
                        2 further frames may take after them, and show traces";
        assert_eq!(complaint, expected);
        // Whoever lost them, they are lost.
        damage.note(told(&[fault(8, 3)], &[]));
        assert!(!damage.complaint((Damaged::Skip, false), |_| 0).unwrap().contains("perhaps"));
    }
}
