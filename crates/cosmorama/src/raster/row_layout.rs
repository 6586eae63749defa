/// Place of a view's texels in a buffer of light: row by row, from top to bottom.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct RowLayout {
    /// Index of the first texel.
    pub(crate) offset: usize,
    /// Columns and rows of the view.
    pub(crate) size: [usize; 2],
    /// Texels from the start of one row to the start of the next: the row's width or more.
    pub(crate) pitch: usize,
}

impl RowLayout {
    /// Lays out views of these sizes one after the other; `pitch` maps a row's width to its pitch.
    pub(crate) fn of(sizes: impl IntoIterator<Item = [usize; 2]>, pitch: impl Fn(usize) -> usize) -> Vec<Self> {
        let mut offset = 0;
        let after = |size: [usize; 2]| {
            let view = Self { offset, size, pitch: pitch(size[0]) };
            offset = view.end();
            view
        };
        sizes.into_iter().map(after).collect()
    }

    /// Returns the index at which the next view begins.
    pub(crate) fn end(&self) -> usize {
        self.offset + self.pitch * self.size[1]
    }

    /// Returns the index of the texel in this column and row.
    #[inline(always)]
    pub(crate) fn index(&self, [column, row]: [usize; 2]) -> usize {
        self.offset + row * self.pitch + column
    }
}
