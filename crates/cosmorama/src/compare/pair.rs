use thiserror::Error;

use super::Mask;
use crate::raster::{Image, Rgba};

/// Reason why two pictures cannot be compared.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum CompareError {
    /// The pictures are not of one size.
    #[error(
        "the first picture is {}x{}, the second {}x{}: only pictures of one size can be compared",
        first.0, first.1, second.0, second.1
    )]
    SizesDiffer {
        /// Columns and rows of the first.
        first: (usize, usize),
        /// Columns and rows of the second.
        second: (usize, usize),
    },
    /// The mask is not of the pictures' size.
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

/// Two pictures of one size and the pixels that count in them.
#[derive(Clone, Copy)]
pub(super) struct Pair<'a> {
    first: &'a Image<Rgba>,
    second: &'a Image<Rgba>,
    mask: &'a Mask,
}

/// A pixel that counts: its column and both values, finite.
pub(super) struct Site {
    pub(super) column: usize,
    pub(super) first: Rgba,
    pub(super) second: Rgba,
}

impl<'a> Pair<'a> {
    pub(super) fn new(first: &'a Image<Rgba>, second: &'a Image<Rgba>, mask: &'a Mask) -> Result<Self, CompareError> {
        let size = common_size(first, second)?;
        if mask.size() != size {
            return Err(CompareError::MaskSize { mask: mask.size(), pictures: size });
        }
        Ok(Self { first, second, mask })
    }

    pub(super) fn first(&self) -> &'a Image<Rgba> {
        self.first
    }

    pub(super) fn second(&self) -> &'a Image<Rgba> {
        self.second
    }

    pub(super) fn mask(&self) -> &'a Mask {
        self.mask
    }

    /// Columns and rows.
    pub(super) fn size(&self) -> (usize, usize) {
        self.mask.size()
    }

    /// The pixels of a row that count.
    pub(super) fn row(&self, j: usize) -> impl Iterator<Item = Site> {
        let values = self.first.row(j).iter().zip(self.second.row(j)).enumerate();
        values.zip(self.mask.row(j)).filter(|(_, counts)| **counts).map(|((column, (first, second)), _)| Site {
            column,
            first: first.finite(),
            second: second.finite(),
        })
    }
}

/// The size that both pictures have.
pub(super) fn common_size(first: &Image<Rgba>, second: &Image<Rgba>) -> Result<(usize, usize), CompareError> {
    let [first, second] = [first, second].map(|picture| (picture.width(), picture.height()));
    if first == second { Ok(first) } else { Err(CompareError::SizesDiffer { first, second }) }
}
