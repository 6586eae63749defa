//! Halving of a world: a pyramid level with half the columns and rows.

use std::sync::Arc;

use super::{Source, ViewMask, World, WorldView};
use crate::camera::View;

impl World {
    /// Returns the world of the same views with half the columns and rows, rounded up; `None` where nothing is left to
    /// halve.
    ///
    /// The picture keeps its edges, its field stop and its period. A texel of a mask counts if any of the texels that
    /// it replaces does.
    pub(crate) fn halved(&self) -> Option<Self> {
        let views = || self.sources().iter().map(|source| &source.view);
        if views().all(|view| view.width().max(view.height()) < SMALLEST) {
            return None;
        }
        Self::blended(self.sources().iter().map(Source::halved)).ok()
    }
}

/// Least length of the longer side of a picture that is worth halving. A cube with faces of 2 × 2 would represent half
/// of the world by twelve directions, which is too few for its mean.
const SMALLEST: usize = 8;

impl Source {
    fn halved(&self) -> WorldView {
        let columns = self.columns();
        let grid = self.view.grid.halved(columns);
        let view = View { grid, ..self.view.clone() };
        let mask = self.mask.as_ref().map(|mask| Arc::new(mask.halved(columns)));
        WorldView { name: self.name.clone(), view, blend: self.blend, mask }
    }

    /// Returns the picture's geometry with half as many texels each way; `None` where nothing is left to halve. It has
    /// no solid angles, because it only serves to measure the size of texels.
    pub(crate) fn coarser(&self) -> Option<Self> {
        if self.view.width().max(self.view.height()) < SMALLEST {
            return None;
        }
        let view = View { grid: self.view.grid.halved(self.columns()), ..self.view.clone() };
        Some(self.with_geometry_of(view))
    }

    /// Returns the columns of the picture, without those that repeat the first ones.
    pub(crate) fn columns(&self) -> usize {
        self.period.map_or(self.view.width(), |period| period.min(self.view.width()))
    }
}

impl ViewMask {
    /// Returns the mask of the first columns at half the columns and rows.
    fn halved(&self, columns: usize) -> Self {
        let (_, rows) = self.size();
        let (width, height) = (columns.div_ceil(2), rows.div_ceil(2));
        Self::new(width, height, |i, j| {
            let across = held(columns, width, i);
            held(rows, height, j).any(|row| across.clone().any(|column| self.counts(column, row)))
        })
    }
}

/// Returns the range of `size` texels that lie, wholly or in part, in texel `index` of `half` as many.
pub(crate) fn held(size: usize, half: usize, index: usize) -> std::ops::Range<usize> {
    index * size / half..((index + 1) * size).div_ceil(half)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::PixelPoint;
    use crate::world::panorama;

    fn world(view: View, mask: Option<ViewMask>) -> World {
        let view = WorldView { name: "all".to_owned(), view, blend: Default::default(), mask: mask.map(Arc::new) };
        World::blended([view]).expect("a view makes a world")
    }

    #[test]
    fn a_panorama_still_goes_round() {
        for width in [64, 65, 99] {
            let halved = world(panorama(width, 31), None).halved().expect("not small");
            let view = halved.sources()[0].view.clone();
            assert_eq!((view.width(), view.height(), view.period()), (width.div_ceil(2), 16, Some(width.div_ceil(2))));
            let corner = view.grid.to_plane(PixelPoint::new(0.0, 16.0));
            assert!((corner.x + std::f64::consts::PI).abs() < 1e-12);
            assert!((corner.y + std::f64::consts::FRAC_PI_2).abs() < 1e-12);
        }
    }

    #[test]
    fn a_column_that_is_there_twice_is_dropped() {
        // Samples on the edges: the last column shows what the first does.
        let whole = panorama(64, 32);
        let twice = View { grid: whole.grid.window(65, 32, 0.0, 0.0), ..whole };
        let halved = world(twice, None).halved().expect("not small");
        assert_eq!((halved.sources()[0].view.width(), halved.sources()[0].period), (32, Some(32)));
    }

    #[test]
    fn a_texel_is_left_of_a_mask_that_holds_one_which_counts() {
        let mask = ViewMask::new(9, 5, |i, j| i == 4 && j == 2);
        let halved = world(panorama(9, 5), Some(mask)).halved().expect("not small");
        let mask = halved.sources()[0].mask.as_ref().expect("there was one");
        let counting: Vec<_> =
            (0..3).flat_map(|j| (0..5).map(move |i| (i, j))).filter(|&(i, j)| mask.counts(i, j)).collect();
        // The middle column of nine lies in the middle one of five, the middle row of five in that of three.
        assert_eq!(counting, [(2, 1)]);
    }

    #[test]
    fn halving_ends() {
        let mut world = world(panorama(64, 32), None);
        let mut sizes = Vec::new();
        while let Some(halved) = world.halved() {
            sizes.push(halved.sources()[0].view.width());
            world = halved;
        }
        assert_eq!(sizes, [32, 16, 8, 4]);
    }
}
