use rayon::prelude::*;

use super::tile::SIDE;

/// Patches of the target that a conversion has to compute.
#[derive(Clone, Debug)]
pub(crate) struct Wanted {
    columns: usize,
    patches: Vec<bool>,
}

impl Wanted {
    /// Tests all patches of this many columns and rows of pixels by `is_wanted`, which takes the first pixel of each
    /// patch.
    pub(crate) fn new([columns, rows]: [usize; 2], is_wanted: impl Fn([usize; 2]) -> bool + Sync) -> Self {
        let (columns, rows) = (columns.div_ceil(SIDE), rows.div_ceil(SIDE));
        let patch = |at: usize| is_wanted([at % columns * SIDE, at / columns * SIDE]);
        Self { columns, patches: (0..columns * rows).into_par_iter().map(patch).collect() }
    }

    /// Returns whether any patch is wanted.
    pub(crate) fn any(&self) -> bool {
        self.patches.contains(&true)
    }

    /// Returns whether the patch with this first pixel is wanted.
    pub(crate) fn holds(&self, [left, top]: [usize; 2]) -> bool {
        self.patches[top / SIDE * self.columns + left / SIDE]
    }
}
