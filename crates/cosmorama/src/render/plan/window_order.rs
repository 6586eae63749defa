//! Order of the windows of a patch's runs in one view.
//!
//! Each window shape has its own code path. Unsorted, 60 % of these branches are mispredicted; sorted by shape within a patch,
//! 9 %. Sorting saves a tenth of an 8-bit frame's time.

use super::span::Run;
use crate::render::scan::tile::SIDE;

/// Where a window belongs: to which run of its group, and in which lane. Headers of all kinds leave room for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    pub(crate) run: usize,
    pub(crate) lane: usize,
}

impl Place {
    const RUN: u32 = 29;
    const LANE: u32 = 12;

    /// That which a header tells.
    #[inline(always)]
    pub(crate) fn of(header: u32) -> Self {
        let part = |first: u32| (header >> first) as usize % SIDE;
        Self { run: part(Self::RUN), lane: part(Self::LANE) }
    }

    /// The bits of a header that tell it.
    #[inline(always)]
    pub(crate) const fn bits(self) -> u32 {
        ((self.run % SIDE) << Self::RUN | (self.lane % SIDE) << Self::LANE) as u32
    }
}

/// How many windows a group has.
#[inline(always)]
pub(crate) fn window_count(group: &[Run]) -> u32 {
    group.iter().map(|run| run.lane_bits().count_ones()).sum()
}

/// What a header tells of its window.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Told {
    /// An index less than [`SHAPES`].
    pub(crate) shape: u32,
    /// How many numbers there are of it, the header among them.
    pub(crate) length: usize,
}

/// How many shapes there may be.
const SHAPES: usize = 8;

/// Sorts the windows of each group by shape, given what the header of a run's window tells. All groups keep their place.
pub(crate) fn sort<'a>(
    numbers: &mut Vec<u32>,
    groups: impl Iterator<Item = &'a [Run]>,
    told: impl Fn(&Run, u32) -> Told,
) {
    let mut sorted = Vec::with_capacity(numbers.len());
    // Where each window's numbers begin and end, by shape, and how many windows these are.
    let (mut windows, mut counts) = ([[[0; 2]; SIDE * SIDE]; SHAPES], [0; SHAPES]);
    for group in groups {
        counts.fill(0);
        let mut at = group[0].weights as usize;
        for run in group {
            for _ in run.lanes() {
                let Told { shape, length } = told(run, numbers[at]);
                let shape = shape as usize % SHAPES;
                windows[shape][counts[shape]] = [at, at + length];
                (counts[shape], at) = (counts[shape] + 1, at + length);
            }
        }
        let windows = windows.iter().zip(counts).flat_map(|(windows, count)| &windows[..count]);
        windows.for_each(|&[from, to]| sorted.extend_from_slice(&numbers[from..to]));
    }
    *numbers = sorted;
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A window's numbers: its header, which tells its shape in its last bits, and as many more as that says.
    fn window(run: usize, lane: usize, shape: u32) -> Vec<u32> {
        std::iter::once(Place { run, lane }.bits() | shape).chain((0..shape).map(|number| number + 100)).collect()
    }

    fn told(_: &Run, header: u32) -> Told {
        Told { shape: header & 7, length: 1 + (header & 7) as usize }
    }

    #[test]
    fn windows_of_a_shape_follow_each_other() {
        let runs = [Run::of_lanes(0b101, 0), Run::of_lanes(0b10, 0), Run::of_lanes(0b1, 11)];
        let groups = || [&runs[..2], &runs[2..]].into_iter();
        let mut numbers = [window(0, 0, 5), window(0, 2, 0), window(1, 1, 3), window(0, 0, 1)].concat();
        sort(&mut numbers, groups(), told);
        assert_eq!(numbers, [window(0, 2, 0), window(1, 1, 3), window(0, 0, 5), window(0, 0, 1)].concat());
    }
}
