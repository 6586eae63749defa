use super::CompareError;
use super::mask::{Mask, common_size};
use crate::raster::{Image, Rgba};

/// Two pictures of one size, with the pixels to compare.
#[derive(Clone, Copy)]
pub(super) struct Pair<'a> {
    first: &'a Image<Rgba>,
    second: &'a Image<Rgba>,
    mask: &'a Mask,
}

/// A compared pixel: its column, and both values, which are finite.
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

    /// Returns the columns and rows.
    pub(super) fn size(&self) -> (usize, usize) {
        self.mask.size()
    }

    /// Visits the compared pixels of a row.
    pub(super) fn row(&self, j: usize) -> impl Iterator<Item = Site> {
        let values = self.first.row(j).iter().zip(self.second.row(j)).enumerate();
        values.zip(self.mask.row(j)).filter(|(_, counts)| **counts).map(|((column, (first, second)), _)| Site {
            column,
            first: first.finite(),
            second: second.finite(),
        })
    }
}
