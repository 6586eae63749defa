use rayon::prelude::*;

use super::tile::SIDE;

/// Which patches of the pixels that a conversion computes are wanted.
#[derive(Clone, Debug)]
pub(crate) struct Wanted {
    columns: usize,
    patches: Vec<bool>,
}

impl Wanted {
    /// Of so many columns and rows, those patches of which `is_wanted` says so, given their first pixel.
    pub(crate) fn new([columns, rows]: [usize; 2], is_wanted: impl Fn([usize; 2]) -> bool + Sync) -> Self {
        let (columns, rows) = (columns.div_ceil(SIDE), rows.div_ceil(SIDE));
        let patch = |at: usize| is_wanted([at % columns * SIDE, at / columns * SIDE]);
        Self { columns, patches: (0..columns * rows).into_par_iter().map(patch).collect() }
    }

    /// Whether any is.
    pub(crate) fn any(&self) -> bool {
        self.patches.contains(&true)
    }

    /// Whether the patch of which this is the first pixel is.
    pub(crate) fn holds(&self, [left, top]: [usize; 2]) -> bool {
        self.patches[top / SIDE * self.columns + left / SIDE]
    }
}
