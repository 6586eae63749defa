use thiserror::Error;

/// Reason why two pictures cannot be compared.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum CompareError {
    /// The pictures differ in size.
    #[error(
        "the first picture is {}x{}, the second {}x{}: only pictures of one size can be compared",
        first.0, first.1, second.0, second.1
    )]
    SizesDiffer {
        /// Columns and rows of the first picture.
        first: (usize, usize),
        /// Columns and rows of the second picture.
        second: (usize, usize),
    },
    /// The mask's size differs from the pictures'.
    #[error("the mask is {}x{}, the pictures are {}x{}", mask.0, mask.1, pictures.0, pictures.1)]
    MaskSize {
        /// Columns and rows of the mask.
        mask: (usize, usize),
        /// Columns and rows of the pictures.
        pictures: (usize, usize),
    },
    /// The mask leaves no pixel to compare.
    #[error("no pixel is left to compare: the mask leaves out all of the {}x{} picture", size.0, size.1)]
    NothingCounts {
        /// Columns and rows of the pictures.
        size: (usize, usize),
    },
}
