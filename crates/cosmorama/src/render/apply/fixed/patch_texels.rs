//! Texels of a patch's small windows, copied once into the order in which windows read them.
//!
//! Each texel of a patch is in a dozen windows. In the light, each mirror image of a patch lies on memory pages of its
//! own, forward or reversed. Here a texel's mirror images are adjacent, in the order in which products consume them.

use fearless_simd::{Simd, prelude::*};

use super::blocks::{Blocks, Mirrored};
use super::weights::{HIGHEST, WIDEST};
use crate::render::apply::texels::Texels;
use crate::render::plan::span::Run;
use crate::render::plan::symmetry::{TOGETHER, exchanged};

/// Number of columns, and of rows, that fit. The small windows of a patch hardly ever span more.
const ROOM: usize = 21;

/// Number of samples of a pair of texels.
const PAIR: usize = 8;

/// Number of texels that are read at once.
const READ: usize = 4;

/// Pairs of neighbouring texels: one begins in each texel of a rectangle, row by row. A pair holds two samples of each
/// channel. The pairs of all mirror images follow each other, and run from left to right in all of them.
pub(crate) struct PatchTexels {
    pairs: Box<Pairs>,
    /// Column and row of the first texel.
    first: [u32; 2],
    held: Held,
}

/// Small windows of a group that are held.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Held {
    None,
    All,
    /// Only the window that was asked for last, since not all fit.
    Last,
}

/// Room for the pairs, aligned to cache lines.
#[repr(C, align(64))]
struct Pairs([i16; ROOM * ROOM * TOGETHER * PAIR]);

/// A rectangle of columns and rows, from a texel on.
#[derive(Clone, Copy)]
struct Rectangle {
    first: [u32; 2],
    size: [usize; 2],
}

impl Default for PatchTexels {
    fn default() -> Self {
        Self { pairs: Box::new(Pairs([0; ROOM * ROOM * TOGETHER * PAIR])), first: [0; 2], held: Held::None }
    }
}

impl PatchTexels {
    /// Drops the texels that are held.
    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        self.held = Held::None;
    }

    /// Copies the texels of a small window that begins at `window`, and of all others of its group if these fit.
    #[inline(always)]
    pub(crate) fn hold<S: Mirrored<N>, const N: usize, const R: usize, const TURNED: bool>(
        &mut self,
        simd: S,
        texels: &Texels<i16, N, R>,
        group: &[Run],
        window: [u32; 2],
    ) {
        let view = exchanged(texels.size(), TURNED);
        let one = || Rectangle::of_windows(window, window, view);
        let rectangle = match self.held {
            Held::All => return,
            Held::Last => one(),
            Held::None => {
                let all = Rectangle::of(group, view);
                let has_room = all.size.iter().all(|length| *length <= ROOM);
                self.held = if has_room { Held::All } else { Held::Last };
                if has_room { all } else { one() }
            }
        };
        self.first = rectangle.first;
        if TURNED {
            self.fill_turned::<S, N, R>(simd, texels, rectangle);
        } else {
            self.fill_upright::<S, N, R>(simd, texels, rectangle);
        }
    }

    /// Returns the pairs of a window that is held, for each row and for each column in which a pair begins.
    #[inline(always)]
    pub(crate) fn window<const N: usize, const WIDTH: usize, const HEIGHT: usize>(
        &self,
        first: [u32; 2],
    ) -> Window<'_, N, WIDTH, HEIGHT> {
        let [column, row] = [0, 1].map(|axis| first[axis].wrapping_sub(self.first[axis]) as usize);
        assert!(column + WIDTH <= ROOM && row + HEIGHT <= ROOM, "a window within the room");
        let pair = N * PAIR;
        Window { pairs: &self.pairs.0[(row * ROOM + column) * pair..][..((HEIGHT - 1) * ROOM + WIDTH - 1) * pair] }
    }

    #[inline(always)]
    fn fill_upright<S: Mirrored<N>, const N: usize, const R: usize>(
        &mut self,
        simd: S,
        texels: &Texels<i16, N, R>,
        Rectangle { first, size: [columns, rows] }: Rectangle,
    ) {
        let pair = N * PAIR;
        for column in (0..columns - 1).step_by(READ - 1) {
            let column = column.min(columns - READ);
            let mut into = &mut self.pairs.0[column * pair..];
            for texels in texels.strips::<READ, 16>([first[0] + column as u32, first[1]], rows) {
                // Unrolled by hand: vectors from an iterator would lie in memory.
                let [first, second, third] = S::Blocks::three_pairs::<R>(simd, texels);
                first.store_slice(&mut into[..pair]);
                second.store_slice(&mut into[pair..][..pair]);
                third.store_slice(&mut into[2 * pair..][..pair]);
                into = into.get_mut(ROOM * pair..).unwrap_or_default();
            }
        }
    }

    #[inline(always)]
    fn fill_turned<S: Mirrored<N>, const N: usize, const R: usize>(
        &mut self,
        simd: S,
        texels: &Texels<i16, N, R>,
        Rectangle { first, size: [columns, rows] }: Rectangle,
    ) {
        let pair = N * PAIR;
        for row in (0..rows).step_by(READ) {
            let row = row.min(rows - READ);
            let mut into = &mut self.pairs.0[row * ROOM * pair..];
            let mut strips = texels.strips::<READ, 16>([first[1] + row as u32, first[0]], columns);
            let Some(mut left) = strips.next() else { return };
            for right in strips {
                let [first, second, third, fourth] = S::Blocks::four_upright::<R>(simd, [left, right]);
                first.store_slice(&mut into[..pair]);
                second.store_slice(&mut into[ROOM * pair..][..pair]);
                third.store_slice(&mut into[2 * ROOM * pair..][..pair]);
                fourth.store_slice(&mut into[3 * ROOM * pair..][..pair]);
                left = right;
                into = into.get_mut(pair..).unwrap_or_default();
            }
        }
    }
}

impl Rectangle {
    /// Returns the rectangle that holds all windows of a group in a view of this size, as if all windows were small.
    #[inline(always)]
    fn of(group: &[Run], view: [usize; 2]) -> Self {
        let (mut first, mut last) = ([u32::MAX; 2], [0; 2]);
        for run in group {
            let (corner, farthest) = run.corners();
            for axis in 0..2 {
                first[axis] = first[axis].min(corner[axis]);
                last[axis] = last[axis].max(farthest[axis]);
            }
        }
        Self::of_windows(first, last, view)
    }

    /// Finds the rectangle of texels that windows may read whose first texels lie between `first` and `last`.
    #[inline(always)]
    fn of_windows(first: [u32; 2], last: [u32; 2], view: [usize; 2]) -> Self {
        let largest = [2 * WIDEST, HIGHEST];
        let end = |axis: usize| view[axis].min(last[axis] as usize + largest[axis]);
        Self { first, size: [0, 1].map(|axis| end(axis) - first[axis] as usize) }
    }
}

/// Pairs of a window of WIDTH columns and HEIGHT rows, in N mirror images.
#[derive(Clone, Copy)]
pub(crate) struct Window<'a, const N: usize, const WIDTH: usize, const HEIGHT: usize> {
    pairs: &'a [i16],
}

impl<const N: usize, const WIDTH: usize, const HEIGHT: usize> Window<'_, N, WIDTH, HEIGHT> {
    /// Returns the pair that begins in a column of a row, in all mirror images.
    #[inline(always)]
    pub(crate) fn pair<S: Simd, V: Blocks<S, N>>(&self, simd: S, row: usize, column: usize) -> V {
        V::from_slice(simd, &self.pairs[(row * ROOM + column) * N * PAIR..][..N * PAIR])
    }
}

#[cfg(test)]
mod tests {
    use fearless_simd::{dispatch, i16x8, i16x16, i16x32, prelude::*};

    use super::*;
    use crate::filter::rim::simd_levels::levels;
    use crate::render::plan::symmetry::Walk;

    /// Size of a view in which each sample's value is its index.
    const SIZE: [usize; 2] = [40, 30];

    fn samples() -> Vec<i16> {
        (0..SIZE[0] * SIZE[1] * 4).map(|sample| sample as i16).collect()
    }

    /// Returns the walks of four mirror images: as the view lies, upside down, and both of these from right to left.
    fn ways() -> [Walk; 4] {
        let [columns, rows] = SIZE.map(|length| length as u32);
        let walk = |first, is_reversed, down: i32| Walk { first, is_turned: false, is_reversed, down };
        let (last, down) = (columns * (rows - 1), columns as i32);
        [
            walk(0, false, down),
            walk(last, false, -down),
            walk(columns - 1, true, down),
            walk(last + columns - 1, true, -down),
        ]
    }

    /// Returns the sample that a mirror image shows in a column and row, in a channel. If `TURNED`, rows and columns
    /// are exchanged.
    fn sample<const TURNED: bool>(walk: Walk, place: [usize; 2], channel: usize) -> i16 {
        let walk = Walk { is_turned: TURNED, ..walk };
        (4 * walk.texel(place) as usize + channel) as i16
    }

    /// Returns runs of one group whose windows begin at these columns and rows. The last place is that of the last
    /// run's last lane.
    fn group(corners: &[[u32; 2]]) -> Vec<Run> {
        let run = |corner: &[u32; 2]| Run::of_lanes(1, 0).from(*corner);
        let mut runs: Vec<Run> = corners.iter().map(run).collect();
        if let [.., first, last] = corners
            && first[0] <= last[0]
            && first[1] <= last[1]
        {
            let offset = [0, 1].map(|axis| (last[axis] - first[axis]) as u8);
            runs.truncate(corners.len() - 2);
            runs.push(run(first).with_last(offset));
        }
        runs
    }

    /// Checks that windows of the largest small size are held as expected.
    fn assert_held<const TURNED: bool>(corners: &[[u32; 2]], held: Held) {
        let (samples, ways, group) = (samples(), ways(), group(corners));
        let all = Texels::<i16, 4, 2>::new(&samples, ways, SIZE);
        let two = Texels::<i16, 2, 1>::new(&samples, [ways[0], ways[2]], SIZE);
        let one = Texels::<i16, 1, 1>::new(&samples, [ways[3]], SIZE);
        for level in levels() {
            let [mut patch, mut patch_of_two, mut patch_of_one] = std::array::from_fn(|_| PatchTexels::default());
            for &corner in corners {
                dispatch!(level, simd => {
                    patch.hold::<_, 4, 2, TURNED>(simd, &all, &group, corner);
                    patch_of_two.hold::<_, 2, 1, TURNED>(simd, &two, &group, corner);
                    patch_of_one.hold::<_, 1, 1, TURNED>(simd, &one, &group, corner);
                });
                assert_eq!(patch.held, held, "{corners:?}");
                let size = [0, 1].map(|axis| exchanged(SIZE, TURNED)[axis] - corner[axis] as usize);
                let (columns, rows) = (size[0].min(2 * WIDEST), size[1].min(HIGHEST));
                for (row, column) in (0..rows).flat_map(|row| (0..columns - 1).map(move |column| (row, column))) {
                    let pairs: [i16; 32] = dispatch!(level, simd => {
                        let pairs: i16x32<_> = patch.window::<4, 6, 5>(corner).pair(simd, row, column);
                        pairs.to_array()
                    });
                    let place = |at: usize| [corner[0] as usize + column + at % 2, corner[1] as usize + row];
                    let expected = |walk, at: usize| sample::<TURNED>(walk, place(at), at % 8 / 2);
                    assert_eq!(
                        pairs,
                        std::array::from_fn(|at| expected(ways[at / 8], at)),
                        "{corner:?} {row} {column}"
                    );
                    let pairs: [i16; 16] = dispatch!(level, simd => {
                        let pairs: i16x16<_> = patch_of_two.window::<2, 6, 5>(corner).pair(simd, row, column);
                        pairs.to_array()
                    });
                    assert_eq!(
                        pairs,
                        std::array::from_fn(|at| expected(ways[at / 8 * 2], at)),
                        "{corner:?} {row} {column}"
                    );
                    let pairs: [i16; 8] = dispatch!(level, simd => {
                        let pairs: i16x8<_> = patch_of_one.window::<1, 6, 5>(corner).pair(simd, row, column);
                        pairs.to_array()
                    });
                    assert_eq!(pairs, std::array::from_fn(|at| expected(ways[3], at)), "{corner:?} {row} {column}");
                }
            }
        }
    }

    #[test]
    fn pairs_of_windows_near_each_other_are_held_together() {
        assert_held::<false>(&[[3, 5], [7, 5], [8, 14]], Held::All);
        // With columns and rows exchanged.
        assert_held::<true>(&[[3, 5], [7, 5], [8, 14]], Held::All);
    }

    #[test]
    fn pairs_of_windows_at_the_edge_are_held() {
        assert_held::<false>(&[[36, 26], [30, 20]], Held::All);
        assert_held::<true>(&[[26, 36], [20, 30]], Held::All);
    }

    #[test]
    fn pairs_of_windows_far_from_each_other_are_held_one_by_one() {
        assert_held::<false>(&[[0, 0], [36, 26], [1, 3]], Held::Last);
        assert_held::<true>(&[[0, 0], [26, 36], [1, 3]], Held::Last);
    }

    #[test]
    fn pairs_of_windows_that_just_have_room_are_held() {
        for (last, held) in [([15, 16], Held::All), ([16, 16], Held::Last), ([15, 17], Held::Last)] {
            assert_held::<false>(&[[0, 0], last], held);
            assert_held::<true>(&[[0, 0], last], held);
        }
    }

    #[test]
    fn no_window_is_found_beyond_the_room() {
        let patch = PatchTexels::default();
        let is_found = |corner| std::panic::catch_unwind(|| _ = patch.window::<4, 6, 5>(corner)).is_ok();
        assert!(is_found([15, 16]) && !is_found([16, 16]) && !is_found([15, 17]) && !is_found([u32::MAX, 0]));
    }
}
