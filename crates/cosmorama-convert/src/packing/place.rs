/// A place in an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// First column and row.
    pub corner: (usize, usize),
    /// Columns and rows of the image.
    pub of: (usize, usize),
}

impl Place {
    /// Returns the place that is all of an image.
    pub(crate) fn whole(size: (usize, usize)) -> Self {
        Self { corner: (0, 0), of: size }
    }

    /// Returns whether this is all of a picture of that size.
    pub(crate) fn is_whole(self, size: (usize, usize)) -> bool {
        self == Self::whole(size)
    }
}
