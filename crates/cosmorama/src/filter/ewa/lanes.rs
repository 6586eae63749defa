use fearless_simd::{Simd, f32x8, f32x16, prelude::*};

/// A number for each pixel of the rows of a patch that are processed together.
pub(crate) trait Lanes<S: Simd>: SimdFloat<S, Element = f32> {
    const ROWS: usize;

    /// Combines the numbers of two rows; a type of one row takes the first alone.
    fn of_rows(rows: [f32x8<S>; 2]) -> Self;

    /// Returns the numbers of one row.
    fn row(self, row: usize) -> f32x8<S>;
}

/// Weight of texels by squared distance, in lanes.
pub(crate) trait Falloff<V> {
    /// Returns the weights at squared distances `q`; they are zero from the kernel's edge on.
    fn weight<S: Simd>(&self, q: V) -> V
    where
        V: Lanes<S>;
}

impl<S: Simd> Lanes<S> for f32x8<S> {
    const ROWS: usize = 1;

    #[inline(always)]
    fn of_rows([first, _]: [Self; 2]) -> Self {
        first
    }

    #[inline(always)]
    fn row(self, _: usize) -> Self {
        self
    }
}

impl<S: Simd> Lanes<S> for f32x16<S> {
    const ROWS: usize = 2;

    #[inline(always)]
    fn of_rows([first, second]: [f32x8<S>; 2]) -> Self {
        first.combine(second)
    }

    #[inline(always)]
    fn row(self, row: usize) -> f32x8<S> {
        let (first, second) = self.split();
        if row == 0 { first } else { second }
    }
}
