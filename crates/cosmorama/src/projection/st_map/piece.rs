use rayon::prelude::*;

use super::lattice::{Links, Samples};

/// Side of a leaf, in squares of the lattice.
pub(crate) const LEAF: usize = 8;

/// Greatest number of pieces of a leaf. A tear makes two, or three beside its end; more come of holes here and there, whose
/// pieces lie near each other, and need no box each.
pub(crate) const MOST_PIECES: usize = 4;

/// A block of the lattice, in columns and rows from its corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Leaf {
    pub(crate) column: usize,
    pub(crate) row: usize,
}

impl Leaf {
    /// Returns the corners of the leaf's squares, least and greatest.
    pub(crate) fn rectangle(self, samples: &Samples) -> [(f64, f64); 2] {
        let (left, top) = (self.column * LEAF, self.row * LEAF);
        let (right, bottom) = ((left + LEAF).min(samples.width), (top + LEAF).min(samples.height));
        [(left as f64, top as f64), (right as f64, bottom as f64)]
    }

    /// Returns the rectangle, extended by `beyond` past each end of the table that it touches.
    pub(crate) fn rectangle_with(self, samples: &Samples, beyond: f64) -> [(f64, f64); 2] {
        let [(left, top), (right, bottom)] = self.rectangle(samples);
        let low = |at: f64| if at == 0.0 { -beyond } else { at };
        let high = |at: f64, size: usize| if at == size as f64 { at + beyond } else { at };
        [(low(left), low(top)), (high(right, samples.width), high(bottom, samples.height))]
    }

    /// Returns whether the table ends beside the leaf.
    pub(crate) fn is_outer(self, samples: &Samples) -> bool {
        self.rectangle_with(samples, 1.0) != self.rectangle(samples)
    }

    /// Returns the column and row of the first of its cells.
    fn first_cell(self) -> [usize; 2] {
        [self.column, self.row].map(|at| (at * LEAF).saturating_sub(1))
    }

    /// Visits the upper left corners of the cells between the leaf's samples and those beside them, as far as its
    /// cubics reach.
    fn cells(self, width: usize, height: usize) -> impl Iterator<Item = (usize, usize)> {
        let [left, top] = self.first_cell();
        let columns = left..(self.column * LEAF + LEAF).min(width - 1);
        let rows = top..(self.row * LEAF + LEAF).min(height - 1);
        rows.flat_map(move |j| columns.clone().map(move |i| (i, j)))
    }
}

/// The connected part of a leaf and of the samples beside it. A leaf across a tear has a piece on each side; one box
/// around both would be far too large.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Piece {
    pub(crate) leaf: Leaf,
    /// Columns and rows of its cells, from the leaf's first cell; `None` if it has all cells of a leaf that is not torn.
    torn: Option<Vec<[u8; 2]>>,
}

impl Piece {
    /// Returns the pieces of a lattice, leaf by leaf.
    pub(crate) fn all(links: &Links) -> Vec<Self> {
        let (columns, rows) = (links.width.div_ceil(LEAF), links.height.div_ceil(LEAF));
        let leaf = |k: usize| Leaf { column: k % columns, row: k / columns };
        (0..columns * rows).into_par_iter().flat_map_iter(|k| Self::of(leaf(k), links)).collect()
    }

    /// Finds the pieces of a leaf: sets of cells connected by common samples. The last of [`MOST_PIECES`] has all that is
    /// left.
    fn of(leaf: Leaf, links: &Links) -> Vec<Self> {
        let all = leaf.cells(links.width, links.height);
        let mut remaining: Vec<_> = all.filter(|&(i, j)| links.is_whole(i as i64, j as i64)).collect();
        if !remaining.is_empty() && remaining.len() == leaf.cells(links.width, links.height).count() {
            return vec![Self { leaf, torn: None }];
        }
        let [left, top] = leaf.first_cell();
        let mut pieces = Vec::new();
        while let Some(first) = remaining.pop() {
            let mut cells = vec![first];
            if pieces.len() + 1 == MOST_PIECES {
                cells.append(&mut remaining);
            }
            let mut seen = 0;
            while let Some(&(i, j)) = cells.get(seen) {
                seen += 1;
                let touches = |&(a, b): &(usize, usize)| a.abs_diff(i) <= 1 && b.abs_diff(j) <= 1;
                let (near, far): (Vec<_>, Vec<_>) = remaining.iter().partition(|cell| touches(cell));
                remaining = far;
                cells.extend(near);
            }
            let torn = cells.into_iter().map(|(i, j)| [(i - left) as u8, (j - top) as u8]).collect();
            pieces.push(Self { leaf, torn: Some(torn) });
        }
        pieces
    }

    /// Returns whether the piece is the leaf's only one, because nothing is torn.
    pub(crate) fn is_whole(&self) -> bool {
        self.torn.is_none()
    }

    /// Visits the upper left corners of the cells between four of its samples, in a lattice of this size.
    pub(crate) fn cells(&self, width: usize, height: usize) -> impl Iterator<Item = (usize, usize)> {
        let all = self.is_whole().then(|| self.leaf.cells(width, height));
        let [left, top] = self.leaf.first_cell();
        let torn = self.torn.iter().flatten().map(move |[i, j]| (left + usize::from(*i), top + usize::from(*j)));
        torn.chain(all.into_iter().flatten())
    }
}
