//! Unchecked reads of texels: a window is checked once. This file and `output_region.rs` are the only ones that do not
//! check each index.
#![allow(unsafe_code)]

use std::marker::PhantomData;

use crate::render::plan::symmetry::Walk;

/// Number of samples of a texel.
const SAMPLES: usize = 4;

/// Texels of a view in N mirror images. In the last R of them, texels run from right to left.
#[derive(Clone, Copy)]
pub(crate) struct Texels<'a, T, const N: usize, const R: usize> {
    /// First sample of the texel in the first column and row.
    first: [*const T; N],
    /// Number of samples from one row to the next, in even and in odd mirror images.
    down: [isize; 2],
    size: [u32; 2],
    samples: PhantomData<&'a [T]>,
}

impl<'a, T: Copy, const N: usize, const R: usize> Texels<'a, T, N, R> {
    /// Checks the texels of a view of this size against their buffer, along the walk of each mirror image.
    ///
    /// # Panics
    /// If they are not all among the samples, or a walk differs from the expected one.
    #[inline(always)]
    pub(crate) fn new(samples: &'a [T], walks: [Walk; N], size: [usize; 2]) -> Self {
        const { assert!(N > 0 && R <= N) };
        let [columns, rows] = size.map(|length| i32::try_from(length).expect("a view's texels are counted in 32 bits"));
        let down = [walks[0].down, walks[1 % N].down];
        let mut first = [samples.as_ptr(); N];
        for image in 0..N {
            let walk = walks[image];
            assert!(walk.is_reversed == (image >= N - R) && walk.down == down[image % 2], "a way through the texels");
            // Products and sums of 32-bit numbers do not overflow 64 bits.
            let (across, along) = (i64::from(columns - 1), i64::from(rows - 1) * i64::from(walk.down));
            let left = i64::from(walk.first) - if walk.is_reversed { across } else { 0 };
            let end = left + across + along.max(0);
            assert!(left + along.min(0) >= 0 && end < (samples.len() / SAMPLES) as i64, "a view lies among its texels");
            first[image] = samples.as_ptr().wrapping_add(SAMPLES * walk.first as usize);
        }
        // In a view of one row this may be any number, since no window has a second row.
        let down = down.map(|down| (SAMPLES as isize).wrapping_mul(down as isize));
        Self { first, down, size: [columns as u32, rows as u32], samples: PhantomData }
    }

    /// Returns the window that begins in this column and row, in each mirror image.
    ///
    /// # Panics
    /// If it is not all within the view.
    #[inline(always)]
    pub(crate) fn windows<const COLUMNS: usize, const HEIGHT: usize>(
        &self,
        corner: [u32; 2],
    ) -> [Window<'a, T, COLUMNS, HEIGHT>; N] {
        const { assert!(0 < COLUMNS && COLUMNS <= 256 && 0 < HEIGHT && HEIGHT <= 256) };
        self.check(corner, [COLUMNS, HEIGHT]);
        let window = |image: usize| Window {
            first: self.leftmost(image, corner, COLUMNS),
            down: self.down[image % 2],
            samples: PhantomData,
        };
        let mut windows = [window(0); N];
        for (image, of_image) in windows.iter_mut().enumerate().skip(1) {
            *of_image = window(image);
        }
        windows
    }

    /// Returns the samples of this number of texels of a row, from this column on, in one mirror image, as they lie in
    /// memory.
    ///
    /// # Panics
    /// If they are not all within the view.
    #[inline(always)]
    pub(crate) fn row(&self, image: usize, corner: [u32; 2], texels: usize) -> &'a [T] {
        self.check(corner, [texels, 1]);
        let first = self.leftmost(image, corner, texels);
        // SAFETY: `check` makes sure that these are texels of the view, all of which `new` has found among the samples.
        unsafe { std::slice::from_raw_parts(first, SAMPLES * texels) }
    }

    /// Returns the columns and rows of the view, as these mirror images traverse it.
    #[inline(always)]
    pub(crate) fn size(&self) -> [usize; 2] {
        self.size.map(|length| length as usize)
    }

    /// Visits `COLUMNS` texels (`LENGTH` samples) of this number of rows, from this texel on, row by row, in each
    /// mirror image.
    ///
    /// # Panics
    /// If they are not all within the view.
    #[inline(always)]
    pub(crate) fn strips<const COLUMNS: usize, const LENGTH: usize>(
        &self,
        corner: [u32; 2],
        rows: usize,
    ) -> Strips<'a, T, N, LENGTH> {
        const { assert!(LENGTH == SAMPLES * COLUMNS) };
        self.check(corner, [COLUMNS, rows]);
        let mut first = self.first;
        for (image, first) in first.iter_mut().enumerate() {
            *first = self.leftmost(image, corner, COLUMNS);
        }
        Strips { first, down: self.down, rows, samples: PhantomData }
    }

    #[inline(always)]
    fn check(&self, corner: [u32; 2], size: [usize; 2]) {
        // A sum must not wrap to zero.
        let end = |axis: usize| u64::from(corner[axis]).saturating_add(size[axis] as u64);
        let fits = |axis: usize| end(axis) <= u64::from(self.size[axis]);
        assert!(fits(0) && fits(1), "a window lies within its view");
    }

    /// Returns the first sample in memory of this number of texels, from this column of a row on.
    #[inline(always)]
    fn leftmost(&self, image: usize, [column, row]: [u32; 2], texels: usize) -> *const T {
        let column = column as isize;
        let columns = if image < N - R { column } else { 1 - column - texels as isize };
        self.first[image].wrapping_offset(self.down[image % 2] * row as isize + SAMPLES as isize * columns)
    }
}

/// A window of `COLUMNS` columns and `HEIGHT` rows, all of it among the samples given.
#[derive(Clone, Copy)]
pub(crate) struct Window<'a, T, const COLUMNS: usize, const HEIGHT: usize> {
    /// First sample of the first row.
    first: *const T,
    /// Number of samples from one row to the next.
    down: isize,
    samples: PhantomData<&'a [T]>,
}

impl<'a, T, const COLUMNS: usize, const HEIGHT: usize> Window<'a, T, COLUMNS, HEIGHT> {
    /// Returns `LENGTH` samples of a row, from the first of a column on.
    ///
    /// # Panics
    /// If the window has no such row, or fewer samples in it.
    #[inline(always)]
    pub(crate) fn samples<const LENGTH: usize>(&self, row: usize, column: usize) -> &'a [T; LENGTH] {
        let is_within = row < HEIGHT && column < COLUMNS && LENGTH <= SAMPLES * (COLUMNS - column);
        assert!(is_within, "samples of the window");
        let offset = row as isize * self.down + (SAMPLES * column) as isize;
        // SAFETY: `windows` made sure that `COLUMNS` columns of `HEIGHT` rows are texels of a view, all of which
        // `Texels::new` has found among the samples, and the assertion that these are some of them. They are borrowed
        // as long as the result. Arrays need no more alignment than one of their elements.
        unsafe { &*self.first.offset(offset).cast() }
    }
}

/// Some columns of a view's rows in each of N mirror images, all of them among the samples given.
pub(crate) struct Strips<'a, T, const N: usize, const LENGTH: usize> {
    /// First sample in memory of the next row.
    first: [*const T; N],
    /// Number of samples from one row to the next, in even and in odd mirror images.
    down: [isize; 2],
    /// Number of rows that are left.
    rows: usize,
    samples: PhantomData<&'a [T]>,
}

impl<'a, T, const N: usize, const LENGTH: usize> Iterator for Strips<'a, T, N, LENGTH> {
    type Item = [&'a [T; LENGTH]; N];

    #[inline(always)]
    fn next(&mut self) -> Option<Self::Item> {
        self.rows = self.rows.checked_sub(1)?;
        // SAFETY: `Texels::strips` made sure that as many rows of this length are texels of a view, all of which
        // `Texels::new` has found among the samples. They are borrowed as long as the result. Arrays need no more
        // alignment than their elements.
        let texels = |first: *const T| unsafe { &*first.cast() };
        let mut row = [texels(self.first[0]); N];
        for (image, row) in row.iter_mut().enumerate() {
            *row = texels(self.first[image]);
            // After the last row this may point anywhere: it is not read.
            self.first[image] = self.first[image].wrapping_offset(self.down[image % 2]);
        }
        Some(row)
    }
}

/// Requests one of some items from memory, a texel or a weight, that will be read soon; any index is allowed. The line
/// goes to the second-level cache. The first level is full of what is in use, and lines that wait there would be
/// evicted before they are read.
#[inline(always)]
pub(crate) fn prefetch<T>(items: &[T], item: u32) {
    let address = items.as_ptr().wrapping_add(item as usize);
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T1, _mm_prefetch};
        // SAFETY: a hint reads nothing, whatever the address.
        unsafe { _mm_prefetch::<_MM_HINT_T1>(address.cast()) }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = address;
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Size of a view in which each sample's value tells its place: ten columns and seven rows.
    const SIZE: [usize; 2] = [10, 7];

    fn samples<T>(of: impl Fn(i16) -> T) -> Vec<T> {
        (0..10 * 7 * 4).map(of).collect()
    }

    fn walk(first: u32, is_reversed: bool, down: i32) -> Walk {
        Walk { first, is_turned: false, is_reversed, down }
    }

    /// Returns the walks of texels as they lie, upside down, and both of these from right to left.
    fn ways() -> [Walk; 4] {
        [walk(0, false, 10), walk(60, false, -10), walk(9, true, 10), walk(69, true, -10)]
    }

    #[test]
    fn pairs_are_found_in_each_mirror() {
        let samples = samples(|sample| sample);
        let texels = Texels::<i16, 4, 2>::new(&samples, ways(), SIZE);
        let windows = texels.windows::<4, 4>([3, 1]);
        let pair = |first: i16| -> [i16; 8] { std::array::from_fn(|k| 4 * first + k as i16) };
        for row in 0..4 {
            for pair_at in 0..2 {
                let (below, across) = (10 * row as i16, 2 * pair_at as i16);
                let found = [0, 1, 2, 3].map(|image: usize| *windows[image].samples(row, 2 * pair_at));
                // Columns 3 to 6 of ten are the same columns from right to left.
                let expected = [13 + below, 53 - below, 13 + below, 53 - below].map(|first| pair(first + across));
                assert_eq!(found, expected);
            }
        }
        assert_eq!(texels.row(3, [0, 6], 2), &samples[32..40]);
        for image in 0..4 {
            let expected: Vec<_> = (1..4).map(|row| texels.row(image, [3, row], 4)).collect();
            let strips = texels.strips::<4, 16>([3, 1], 3).map(|rows| rows[image].as_slice());
            assert_eq!(strips.collect::<Vec<_>>(), expected);
        }
    }

    #[test]
    fn no_view_reaches_beyond_the_samples() {
        let samples = samples(|sample| sample);
        let is_view = |walk: Walk, size: [usize; 2]| {
            let made = std::panic::catch_unwind(|| {
                if walk.is_reversed {
                    Texels::<i16, 1, 1>::new(&samples, [walk], size).size
                } else {
                    Texels::<i16, 1, 0>::new(&samples, [walk], size).size
                }
            });
            made.is_ok()
        };
        assert!(ways().into_iter().all(|way| is_view(way, SIZE)));
        assert!(ways().into_iter().all(|way| !is_view(way, [11, 7]) && !is_view(way, [10, 8])));
        for (first, is_reversed, down) in [(1, false, 10), (59, false, -10), (8, true, 10), (u32::MAX, true, -10)] {
            assert!(!is_view(walk(first, is_reversed, down), SIZE), "{first} {is_reversed} {down}");
        }
        assert!(!is_view(walk(0, false, i32::MAX), [1, 2]) && !is_view(walk(69, false, i32::MIN), [1, 2]));
        assert!(!is_view(walk(70, false, 0), [1, 1]) && is_view(walk(69, false, 0), [1, 1]));
    }

    #[test]
    fn no_window_reaches_beyond_its_view() {
        let samples = samples(|sample| sample);
        let texels = Texels::<i16, 4, 2>::new(&samples, ways(), SIZE);
        let is_window = |corner| std::panic::catch_unwind(|| texels.windows::<4, 4>(corner)).is_ok();
        assert!(is_window([0, 0]) && is_window([6, 3]));
        assert!(!is_window([7, 3]) && !is_window([6, 4]) && !is_window([u32::MAX, 0]) && !is_window([0, u32::MAX]));
        for (column, count) in [(9, 2), (1, usize::MAX), (0, usize::MAX / 4 + 2)] {
            assert!(std::panic::catch_unwind(|| texels.row(2, [column, 0], count)).is_err());
        }
        for (corner, rows) in [([7, 3], 4), ([6, 4], 4), ([0, 0], usize::MAX), ([0, 7], 1), ([u32::MAX, 0], 1)] {
            assert!(std::panic::catch_unwind(|| texels.strips::<4, 16>(corner, rows).next()).is_err());
        }
        let [window, ..] = texels.windows::<4, 4>([0, 0]);
        for (row, column) in [(4, 0), (0, 3), (usize::MAX, 0)] {
            assert!(std::panic::catch_unwind(|| window.samples::<8>(row, column)).is_err());
        }
    }

    #[test]
    fn a_row_of_floats_ends_where_the_window_does() {
        let samples = samples(f32::from);
        let texels = Texels::<f32, 1, 0>::new(&samples, [walk(60, false, -20)], [10, 4]);
        let [window] = texels.windows::<5, 4>([3, 0]);
        assert_eq!(*window.samples::<16>(1, 1), std::array::from_fn(|k| (4 * 44 + k) as f32));
        assert_eq!(*window.samples::<4>(3, 4), std::array::from_fn(|k| (4 * 7 + k) as f32));
        for (row, column) in [(0, 2), (4, 0), (0, 5), (0, usize::MAX)] {
            assert!(std::panic::catch_unwind(|| window.samples::<16>(row, column)).is_err());
        }
    }
}
