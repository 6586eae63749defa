use std::ops::Range;

use super::span::Run;
use super::symmetry::TOGETHER;

/// Windows that are processed together: a patch's runs that lie in one view, in some of its mirror images.
#[derive(Clone, Debug)]
pub(crate) struct Pass<'a> {
    pub(crate) group: &'a [Run],
    /// Range of the view's traversals.
    pub(crate) ways: Range<usize>,
}

/// Returns the passes through each group, in [`TOGETHER`] of `count` mirror images at once. Each comes with the next
/// pass, whose texels can be prefetched meanwhile. What a patch reads and writes in eight mirror images fills the
/// first-level cache of most processors.
pub(crate) fn passes<'a>(
    groups: impl Iterator<Item = &'a [Run]> + Clone,
    count: usize,
) -> impl Iterator<Item = (Pass<'a>, Option<Pass<'a>>)> {
    let all = groups.flat_map(move |group| {
        let firsts = (0..count).step_by(TOGETHER);
        firsts.map(move |first| Pass { group, ways: first..count.min(first + TOGETHER) })
    });
    let next = all.clone().skip(1).map(Some).chain(std::iter::once(None));
    all.zip(next)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_group_is_passed_through_in_all_mirrors() {
        let runs = [Run::of_lanes(1, 0), Run::of_lanes(2, 0), Run::of_lanes(4, 1)];
        let found = |count: usize| -> Vec<(u8, Range<usize>)> {
            let told = |pass: &Pass| (pass.group[0].lane_bits(), pass.ways.clone());
            let all: Vec<_> = passes([&runs[..2], &runs[2..]].into_iter(), count).collect();
            let next: Vec<_> = all.iter().filter_map(|(_, next)| next.as_ref().map(told)).collect();
            let all: Vec<_> = all.iter().map(|(pass, _)| told(pass)).collect();
            assert_eq!(all[1..], next);
            all
        };
        assert_eq!(found(8), [(1, 0..4), (1, 4..8), (4, 0..4), (4, 4..8)]);
        assert_eq!(found(2), [(1, 0..2), (4, 0..2)]);
        assert_eq!(found(1), [(1, 0..1), (4, 0..1)]);
    }
}
