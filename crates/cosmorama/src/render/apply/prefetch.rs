use std::ops::Range;

use super::texels;
use crate::render::plan::span::Run;
use crate::render::plan::symmetry::{Mirrors, exchanged};
use crate::render::plan::traversal::Pass;
use crate::render::scan::tile::SIDE;

/// Number of bytes in a cache line.
const LINE: usize = 64;

/// Columns and rows of the largest region that is prefetched as one. Runs farther apart share little.
const LARGEST: [usize; 2] = [64, 32];

/// Number of weights, headers included, that are prefetched ahead.
const NUMBERS_AHEAD: u32 = 192;

/// Prefetches the texels that a pass will read. Otherwise the loads of cache lines, one after the other as they are
/// needed, take most of the time.
#[inline(always)]
pub(crate) fn prefetch_pass<T>(texels: &[T], mirrors: &Mirrors, pass: &Pass) {
    let mut rest = pass.group;
    while let Some((run, others)) = rest.split_first() {
        rest = others;
        let mut region = Region::of(run);
        // Runs below each other share most of their texels, which are requested once.
        while let Some((joint, others)) = region.joined(rest) {
            (region, rest) = (joint, others);
        }
        region.prefetch(texels, mirrors, pass.ways.clone());
    }
}

/// Prefetches about a patch's runs, from this one on, before [`prefetch_pass`] reads them.
#[inline(always)]
pub(crate) fn prefetch_runs(runs: &[Run], first: usize) {
    prefetch_lines(runs, first as u32, SIDE as u32);
}

/// Prefetches the weights of a dozen windows later, so that reading them in order does not wait for memory.
#[inline(always)]
pub(crate) fn prefetch_weights(numbers: &[u32]) {
    texels::prefetch(numbers, NUMBERS_AHEAD);
}

/// Prefetches each cache line in which an item begins, from `first` to the item `last` items after it.
#[inline(always)]
pub(crate) fn prefetch_lines<T>(items: &[T], first: u32, last: u32) {
    for at in (0..last).step_by(per_line::<T>() as usize) {
        texels::prefetch(items, first.wrapping_add(at));
    }
    texels::prefetch(items, first.wrapping_add(last));
}

/// Prefetches a rectangle of texels: `rows` rows, each of at most `LINES + 1` cache lines. The next row begins `down`
/// texels after the one before it.
///
/// The loop over lines has a constant length, so that the compiler unrolls it: a counted loop would cost more than the
/// prefetches.
#[inline(always)]
fn prefetch_rows<T, const LINES: u32>(texels: &[T], [mut left, last]: [u32; 2], rows: usize, down: i32) {
    for _ in 0..rows {
        for line in 0..LINES {
            texels::prefetch(texels, left.wrapping_add(line * per_line::<T>()));
        }
        texels::prefetch(texels, left.wrapping_add(last));
        left = left.wrapping_add_signed(down);
    }
}

/// Returns the number of items in a cache line, at least one.
const fn per_line<T>() -> u32 {
    if size_of::<T>() < LINE { (LINE / size_of::<T>()) as u32 } else { 1 }
}

/// A rectangle of texels of a view.
#[derive(Clone, Copy)]
struct Region {
    view: usize,
    first: [usize; 2],
    end: [usize; 2],
}

impl Region {
    #[inline(always)]
    fn of(run: &Run) -> Self {
        Self { view: usize::from(run.view), first: run.corner(), end: run.end() }
    }

    /// Extends the region by the first of some runs. Returns the larger region and the remaining runs. `None` if there
    /// is no run, or if it lies in another view or too far away for one region.
    #[inline(always)]
    fn joined<'a>(&self, runs: &'a [Run]) -> Option<(Self, &'a [Run])> {
        let (run, others) = runs.split_first()?;
        let next = Self::of(run);
        let first = [self.first[0].min(next.first[0]), self.first[1].min(next.first[1])];
        let end = [self.end[0].max(next.end[0]), self.end[1].max(next.end[1])];
        let is_near = end[0] - first[0] <= LARGEST[0] && end[1] - first[1] <= LARGEST[1];
        (self.view == next.view && is_near).then_some((Self { first, end, ..*self }, others))
    }

    /// Prefetches the region in the mirror images of these traversals.
    #[inline(always)]
    fn prefetch<T>(&self, texels: &[T], mirrors: &Mirrors, ways: Range<usize>) {
        for &(image, _) in &mirrors.ways(self.view).order[ways] {
            let walk = mirrors.images[image].view(self.view).walk(self.first);
            let [columns, rows] = exchanged([self.end[0] - self.first[0], self.end[1] - self.first[1]], walk.is_turned);
            let last = (columns - 1) as u32;
            let mut left = if walk.is_reversed { walk.first.wrapping_sub(last) } else { walk.first };
            match last.div_ceil(per_line::<T>()) {
                0 | 1 => prefetch_rows::<T, 1>(texels, [left, last], rows, walk.down),
                2 => prefetch_rows::<T, 2>(texels, [left, last], rows, walk.down),
                3 => prefetch_rows::<T, 3>(texels, [left, last], rows, walk.down),
                _ => {
                    for _ in 0..rows {
                        prefetch_lines(texels, left, last);
                        left = left.wrapping_add_signed(walk.down);
                    }
                }
            }
        }
    }
}
