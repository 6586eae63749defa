//! Order of the windows of a patch's runs in one view.
//!
//! Each window shape has its own code path. Unsorted, 60 % of these branches are mispredicted; sorted by shape within a
//! patch, 9 %. Sorting saves a tenth of an 8-bit frame's time.

use super::span::Run;
use crate::render::scan::tile::SIDE;

/// Returns the number of windows in a group.
#[inline(always)]
pub(crate) fn window_count(group: &[Run]) -> u32 {
    group.iter().map(|run| run.lane_bits().count_ones()).sum()
}

/// Greatest number of shapes.
const SHAPES: usize = 8;

/// Sorts the windows of each group by shape. All groups keep their place.
///
/// `told` takes a run, and its numbers from one window on. It returns the index of the window's shape, and how many
/// numbers the window takes.
pub(crate) fn sort<'a>(
    numbers: &mut Vec<u32>,
    groups: impl Iterator<Item = &'a [Run]>,
    told: impl Fn(&Run, &[u32]) -> (u32, usize),
) {
    let mut sorted = Vec::with_capacity(numbers.len());
    // For each shape, where each window's numbers begin and end, and how many windows there are.
    let (mut windows, mut counts) = ([[[0; 2]; SIDE * SIDE]; SHAPES], [0; SHAPES]);
    for group in groups {
        counts.fill(0);
        let mut at = group[0].weights as usize;
        for run in group {
            for _ in run.lanes() {
                let (shape, length) = told(run, &numbers[at..]);
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

    /// Returns a window's numbers: its header, with the shape in its last bits, and as many more as the shape needs.
    fn window(number: u32, shape: u32) -> Vec<u32> {
        std::iter::once(number << 3 | shape).chain((0..shape).map(|number| number + 100)).collect()
    }

    fn told(_: &Run, numbers: &[u32]) -> (u32, usize) {
        (numbers[0] & 7, 1 + (numbers[0] & 7) as usize)
    }

    #[test]
    fn windows_of_a_shape_follow_each_other() {
        let runs = [Run::of_lanes(0b101, 0), Run::of_lanes(0b10, 0), Run::of_lanes(0b1, 11)];
        let groups = || [&runs[..2], &runs[2..]].into_iter();
        let mut numbers = [window(0, 5), window(2, 0), window(9, 3), window(4, 1)].concat();
        sort(&mut numbers, groups(), told);
        assert_eq!(numbers, [window(2, 0), window(9, 3), window(0, 5), window(4, 1)].concat());
    }
}
