use std::collections::BTreeSet;
use std::ops::Range;

use crate::probe::{CodedFrame, shown_times};
use crate::{Ffmpeg, Timeline, VideoError, VideoInfo};

/// Frames of a video in the order in which they are coded, by which damage of one reaches others.
#[derive(Clone, Debug)]
pub struct CodedOrder {
    frames: Vec<CodedFrame>,
    timeline: Timeline,
    /// Whether decoders hold a frame back that others may take after, and lose it when the next such frame is damaged; that one they
    /// paint over and give.
    is_held_back: bool,
}

impl Ffmpeg {
    /// Reads the order in which a video's frames are coded, from the whole file without decoding it; `None` where the file does not tell
    /// the times of its frames.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn coded_order(&self, info: &VideoInfo) -> Result<Option<CodedOrder>, VideoError> {
        let frames = self.coded_frames(info, &[])?;
        let timeline = if info.is_variable {
            Timeline::Listed { times: shown_times(&frames), time_base: info.time_base }
        } else {
            self.timeline(info)?
        };
        Ok((!frames.is_empty()).then(|| CodedOrder::new(frames, timeline, info)))
    }
}

impl CodedOrder {
    pub(super) fn new(frames: Vec<CodedFrame>, timeline: Timeline, info: &VideoInfo) -> Self {
        let is_held_back = match info.codec.as_str() {
            "mpeg1video" | "mpeg2video" => true,
            // Without B frames, its decoder has no delay.
            "mpeg4" => !frames.is_sorted_by_key(|frame| frame.time),
            _ => false,
        };
        Self { frames, timeline, is_held_back }
    }

    /// Returns the numbers of frames that may show traces of damaged ones: those that are decoded after them, up to the next key frame,
    /// of which decoders say nothing. A damaged frame that a decoder painted over in the place of one that it lost counts, too.
    pub fn traces(&self, damaged: &[Range<u64>]) -> Vec<u64> {
        let Self { frames, timeline, is_held_back } = self;
        let apart = disjoint(damaged);
        let painted = if *is_held_back { painted(frames, timeline, &apart) } else { Vec::new() };
        let meant: Vec<_> = painted.iter().map(|frame| *frame..frame + 1).chain(apart.iter().cloned()).collect();
        let mut found: BTreeSet<u64> = traces(frames, timeline, &meant).into_iter().chain(painted).collect();
        found.retain(|frame| holding(&apart, *frame).is_none());
        found.into_iter().collect()
    }
}

/// Returns the frames behind damaged ones that a decoder may have painted over, while it lost those: the next that are no B frames. A B
/// frame, which is shown before one that is decoded before it, is never held back.
fn painted(coded: &[CodedFrame], timeline: &Timeline, damaged: &[Range<u64>]) -> Vec<u64> {
    let mut latest = i64::MIN;
    // Before the first key frame, nothing is decoded that could be held back.
    let (mut is_after_damaged, mut has_key) = (false, false);
    let mut found = Vec::new();
    for frame in coded {
        if frame.time < latest {
            continue;
        }
        latest = frame.time;
        let number = timeline.frame(frame.time);
        let is_damaged = holding(damaged, number).is_some();
        found.extend((is_after_damaged && !is_damaged && frame.is_shown).then_some(number));
        has_key |= frame.is_key;
        is_after_damaged = is_damaged && has_key;
    }
    found
}

/// Frames among those that follow in the order of decoding that may show traces of damage.
#[derive(Clone, Copy, Debug)]
enum Doubtful {
    None,
    UpToKey,
    /// Frames that are decoded behind the last key frame and shown before it, at this time: they may still use frames before it.
    Before(i64),
}

/// Returns the frames that may show traces of damaged ones, from all in the order of decoding.
fn traces(coded: &[CodedFrame], timeline: &Timeline, damaged: &[Range<u64>]) -> Vec<u64> {
    let numbers: Vec<u64> = coded.iter().map(|frame| timeline.frame(frame.time)).collect();
    let damaged = disjoint(damaged);
    let lost = begins_behind_lost(&numbers, &damaged);
    let mut doubtful = Doubtful::None;
    let mut found = Vec::new();
    for (index, (frame, number)) in coded.iter().zip(numbers).enumerate() {
        if frame.is_shown && holding(&damaged, number).is_some() {
            // Those that are decoded behind a key frame and shown before it are of no use to later ones.
            if !matches!(doubtful, Doubtful::Before(time) if frame.time < time) {
                doubtful = Doubtful::UpToKey;
            }
            continue;
        }
        if lost.contains(&index) {
            doubtful = Doubtful::UpToKey;
        }
        doubtful = match doubtful {
            Doubtful::UpToKey if frame.is_key => Doubtful::Before(frame.time),
            _ if frame.is_key => Doubtful::None,
            same => same,
        };
        let is_doubtful = match doubtful {
            Doubtful::None => false,
            Doubtful::UpToKey => true,
            Doubtful::Before(time) => frame.time < time,
        };
        found.extend((is_doubtful && frame.is_shown).then_some(number));
    }
    found.sort_unstable();
    found
}

/// Returns the places of the first coded frames behind damaged ones that are not coded at all: they were lost with their place.
fn begins_behind_lost(numbers: &[u64], damaged: &[Range<u64>]) -> BTreeSet<usize> {
    let there: BTreeSet<usize> = numbers.iter().filter_map(|number| holding(damaged, *number)).collect();
    let highest: Vec<u64> = numbers
        .iter()
        .scan(0, |most, number| {
            *most = (*most).max(*number);
            Some(*most)
        })
        .collect();
    let lost = damaged.iter().enumerate().filter(|(at, _)| !there.contains(at));
    lost.map(|(_, range)| highest.partition_point(|most| *most < range.end)).collect()
}

/// Returns the same numbers in ranges that are in order and apart.
fn disjoint(ranges: &[Range<u64>]) -> Vec<Range<u64>> {
    let mut ranges = ranges.to_vec();
    ranges.sort_unstable_by_key(|range| range.start);
    let mut merged: Vec<Range<u64>> = Vec::new();
    for range in ranges {
        match merged.last_mut() {
            Some(last) if range.start <= last.end => last.end = last.end.max(range.end),
            _ => merged.push(range),
        }
    }
    merged
}

/// Returns which of the ranges holds a number.
fn holding(ranges: &[Range<u64>], number: u64) -> Option<usize> {
    let at = ranges.partition_point(|range| range.end <= number);
    ranges.get(at).filter(|range| range.contains(&number)).map(|_| at)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Ratio;

    #[test]
    fn traces_go_from_damage_to_the_next_key_frame() {
        let one = Ratio::parse("1/25").unwrap();
        let even = Timeline::Even { start: 0, time_base: one, rate: one.inverse() };
        // Key frames are 0 and 8; 6 and 7 are decoded after 8, and shown before it.
        let order = [0, 3, 1, 2, 5, 4, 8, 6, 7, 11, 9, 10, 12];
        let coded = order.map(|time| CodedFrame { time, is_key: time % 8 == 0, is_shown: true });
        let found = |coded: &[CodedFrame], damaged: &[u64]| {
            let damaged: Vec<_> = damaged.iter().map(|frame| *frame..frame + 1).collect();
            traces(coded, &even, &damaged)
        };
        assert!(found(&coded, &[]).is_empty());
        assert_eq!(found(&coded, &[3]), [1, 2, 4, 5, 6, 7]);
        assert_eq!(found(&coded, &[1, 2]), [4, 5, 6, 7]);
        assert_eq!(found(&coded, &[8]), [6, 7, 9, 10, 11, 12]);
        assert_eq!(found(&coded, &[4, 9]), [6, 7, 10, 12]);
        // Where all frames are key frames, damage is theirs alone.
        let keys = order.map(|time| CodedFrame { time, is_key: true, is_shown: true });
        assert!(found(&keys, &[3, 12]).is_empty());
        // A frame that is not even coded any more, and a key frame that is not shown.
        let without = |lost: i64| coded.iter().copied().filter(|frame| frame.time != lost).collect::<Vec<_>>();
        assert_eq!(found(&without(3), &[3]), [4, 5, 6, 7]);
        assert_eq!(found(&without(8), &[8]), [9, 10, 11, 12]);
        let hidden = coded.map(|frame| CodedFrame { is_shown: frame.time != 8, ..frame });
        assert_eq!(found(&hidden, &[3]), [1, 2, 4, 5, 6, 7]);
    }

    #[test]
    fn a_frame_that_was_painted_over_is_the_next_that_others_take_after() {
        let one = Ratio::parse("1/25").unwrap();
        let even = Timeline::Even { start: 0, time_base: one, rate: one.inverse() };
        // Key frames are 0 and 6; 4 and 5 are decoded after 6.
        let order = [0, 3, 1, 2, 6, 4, 5, 9, 7, 8];
        let frames = order.map(|time| CodedFrame { time, is_key: time % 6 == 0, is_shown: true }).to_vec();
        let order = |is_held_back| CodedOrder { frames: frames.clone(), timeline: even.clone(), is_held_back };
        let found_by =
            |is_held_back, damaged: u64| order(is_held_back).traces(std::slice::from_ref(&(damaged..damaged + 1)));
        let found = |damaged| found_by(true, damaged);
        assert_eq!(found(3), [1, 2, 4, 5, 6, 7, 8, 9], "6 was painted over");
        assert_eq!(found(0), [1, 2, 3, 4, 5]);
        assert_eq!(found(2), [4, 5], "no frame is lost with a B frame");
        assert_eq!(found_by(false, 3), [1, 2, 4, 5]);
    }

    #[test]
    fn ranges_are_put_in_order() {
        let apart = disjoint(&[5..6, 1..3, 2..5, 9..10]);
        assert_eq!(apart, [1..6, 9..10]);
        assert_eq!([0, 1, 5, 6, 9].map(|number| holding(&apart, number)), [None, Some(0), Some(0), None, Some(1)]);
    }
}
