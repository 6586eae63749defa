//! The one door behind which indices are not checked each time: a window of texels is looked at once.
#![allow(unsafe_code)]

use std::marker::PhantomData;

/// Samples of a texel.
const SAMPLES: usize = 4;

/// A window of integers, `PAIRS` pairs of texels across and `HEIGHT` rows.
pub(super) type Texels<'a, const PAIRS: usize, const HEIGHT: usize> = Window<'a, i16, 2, PAIRS, HEIGHT>;

/// A window of floats.
pub(super) type FloatTexels<'a, const WIDTH: usize, const HEIGHT: usize> = Window<'a, f32, 1, WIDTH, HEIGHT>;

/// A window of `COLUMNS` columns of `TEXELS` texels each and `HEIGHT` rows, all of it among the samples given.
#[derive(Clone, Copy)]
pub(super) struct Window<'a, T, const TEXELS: usize, const COLUMNS: usize, const HEIGHT: usize> {
    /// The first sample of the first row.
    first: *const T,
    /// Samples from one row to the next.
    down: isize,
    samples: PhantomData<&'a [T]>,
}

impl<'a, T, const TEXELS: usize, const COLUMNS: usize, const HEIGHT: usize> Window<'a, T, TEXELS, COLUMNS, HEIGHT> {
    /// The window whose first row begins at this texel, each row `down` texels after the one before.
    ///
    /// # Panics
    /// If it is not all among the samples.
    #[inline(always)]
    pub(super) fn new(samples: &'a [T], first: u32, down: i32) -> Self {
        // So small that neither the product nor the sums below overflow 64 bits.
        const { assert!(0 < TEXELS && TEXELS <= 2 && 0 < COLUMNS && COLUMNS <= 256 && 0 < HEIGHT && HEIGHT <= 256) };
        let (top, down) = (i64::from(first), i64::from(down));
        let bottom = top + (HEIGHT as i64 - 1) * down;
        let end = top.max(bottom) + (TEXELS * COLUMNS) as i64;
        assert!(bottom >= 0 && end <= (samples.len() / SAMPLES) as i64, "a window lies among its texels");
        // SAFETY: the first texel is between zero and `end`, which is among the samples.
        let first = unsafe { samples.as_ptr().add(SAMPLES * first as usize) };
        Self { first, down: SAMPLES as isize * down as isize, samples: PhantomData }
    }

    /// So many samples of a row, from the first of a column on.
    ///
    /// # Panics
    /// If the window has no such row, or not so many samples in it.
    #[inline(always)]
    pub(super) fn samples<const LENGTH: usize>(&self, row: usize, column: usize) -> &'a [T; LENGTH] {
        let is_within = row < HEIGHT && column < COLUMNS && LENGTH <= SAMPLES * TEXELS * (COLUMNS - column);
        assert!(is_within, "samples of the window");
        let offset = row as isize * self.down + (SAMPLES * TEXELS * column) as isize;
        // SAFETY: `new` made sure that the first row and the last one, and so those between, lie among the samples from their
        // first texel to the last of `COLUMNS` columns, and the assertion that these are some of them; they are borrowed as
        // long as the result; arrays need no more alignment than one of their elements.
        unsafe { &*self.first.offset(offset).cast() }
    }
}

impl<'a, const PAIRS: usize, const HEIGHT: usize> Texels<'a, PAIRS, HEIGHT> {
    /// The samples of a pair.
    ///
    /// # Panics
    /// If there is no such row or pair.
    #[inline(always)]
    pub(super) fn pair(&self, row: usize, pair: usize) -> &'a [i16; 2 * SAMPLES] {
        self.samples(row, pair)
    }
}

/// Asks memory for a texel that will be read soon; any number will do.
#[inline(always)]
pub(super) fn prefetch<T>(texels: &[T], texel: u32) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        let address = texels.as_ptr().wrapping_add(texel as usize);
        // SAFETY: a hint reads nothing, whatever the address.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(address.cast()) }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (texels, texel);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_are_found_downwards_and_upwards() {
        let samples: Vec<i16> = (0..10 * 7 * 4).collect();
        let down = Texels::<2, 4>::new(&samples, 12, 10);
        let up = Texels::<2, 4>::new(&samples, 42, -10);
        for row in 0..4 {
            for pair in 0..2 {
                let first = 4 * (12 + 10 * row + 2 * pair) as i16;
                assert_eq!(*down.pair(row, pair), std::array::from_fn(|k| first + k as i16));
                assert_eq!(up.pair(3 - row, pair), down.pair(row, pair));
            }
        }
    }

    #[test]
    fn no_window_reaches_beyond_the_samples() {
        let samples = vec![0; 10 * 7 * 4];
        let is_window = |first, down| std::panic::catch_unwind(|| Texels::<2, 4>::new(&samples, first, down)).is_ok();
        assert!(is_window(0, 10) && is_window(36, 10) && is_window(66, -10) && is_window(30, -10));
        assert!(!is_window(37, 10) && !is_window(67, -10) && !is_window(29, -10) && !is_window(u32::MAX, 1));
        assert!(!is_window(0, i32::MAX) && !is_window(69, i32::MIN) && !is_window(70, 0));
        let window = Texels::<2, 4>::new(&samples, 0, 10);
        for (row, pair) in [(4, 0), (0, 2), (usize::MAX, 0)] {
            assert!(std::panic::catch_unwind(|| window.pair(row, pair)).is_err());
        }
    }

    #[test]
    fn a_row_of_floats_ends_where_the_window_does() {
        let samples: Vec<f32> = (0..10 * 7 * 4).map(|k| k as f32).collect();
        let window = FloatTexels::<5, 4>::new(&samples, 63, -20);
        assert_eq!(*window.samples::<16>(1, 1), std::array::from_fn(|k| (4 * 44 + k) as f32));
        assert_eq!(*window.samples::<4>(3, 4), std::array::from_fn(|k| (4 * 7 + k) as f32));
        for (row, column) in [(0, 2), (4, 0), (0, 5), (0, usize::MAX)] {
            assert!(std::panic::catch_unwind(|| window.samples::<16>(row, column)).is_err());
        }
        assert!(std::panic::catch_unwind(|| FloatTexels::<5, 4>::new(&samples, 66, 0)).is_err());
    }
}
