use rayon::prelude::*;

use super::block::{Block, Sums};
use crate::lighting::prefilter::LitView;

/// The blocks of a view: finest first, down to a single one.
pub(super) struct Pyramid {
    pub(super) levels: Vec<Level>,
}

/// Blocks of one size, row by row.
pub(super) struct Level {
    columns: usize,
    blocks: Vec<Block>,
}

/// Place of a block in a pyramid.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub(super) level: usize,
    pub(super) column: usize,
    pub(super) row: usize,
}

/// Texels along a side of the smallest block.
pub(super) const SIDE: usize = 4;

impl Pyramid {
    pub(super) fn new(view: LitView) -> Self {
        let mut levels = vec![Level::finest(view)];
        while let Some(last) = levels.last().filter(|level| level.blocks.len() > 1) {
            levels.push(last.coarser());
        }
        Self { levels }
    }

    /// Returns the place of the block that holds all others.
    pub(super) fn top(&self) -> Place {
        Place { level: self.levels.len() - 1, column: 0, row: 0 }
    }

    pub(super) fn block(&self, place: Place) -> &Block {
        let level = &self.levels[place.level];
        &level.blocks[place.row * level.columns + place.column]
    }

    /// Returns the places of the four blocks, or fewer, of which a block is made.
    pub(super) fn parts(&self, place: Place) -> impl Iterator<Item = Place> {
        let level = place.level - 1;
        let (columns, rows) = self.levels[level].size();
        let part = move |k: usize| Place { level, column: 2 * place.column + k % 2, row: 2 * place.row + k / 2 };
        (0..4).map(part).filter(move |part| part.column < columns && part.row < rows)
    }
}

impl Level {
    fn size(&self) -> (usize, usize) {
        (self.columns, self.blocks.len() / self.columns)
    }

    /// Gathers texels.
    fn finest(view: LitView) -> Self {
        let (width, height) = view.size();
        let columns = width.div_ceil(SIDE);
        let mut blocks = vec![Block::default(); columns * height.div_ceil(SIDE)];
        blocks.par_chunks_mut(columns).enumerate().for_each(|(row, blocks)| {
            let mut sums: Vec<Option<Sums>> = vec![None; columns];
            for j in row * SIDE..(row * SIDE + SIDE).min(height) {
                let (texels, angles) = view.row(j);
                view.source.view.row_directions(j, 0..width, |i, direction| {
                    let angle = f64::from(angles[i]);
                    if angle > 0.0 {
                        let light = texels[i].0.map(|channel| f64::from(channel) * angle);
                        let direction = direction.vector();
                        sums[i / SIDE].get_or_insert_with(|| Sums::about(direction)).add_texel(direction, light);
                    }
                });
            }
            let found = blocks.iter_mut().zip(&sums);
            found.for_each(|(block, sums)| *block = sums.as_ref().map(Sums::block).unwrap_or_default());
        });
        Self { columns, blocks }
    }

    /// Gathers blocks, two by two.
    fn coarser(&self) -> Self {
        let (columns, rows) = self.size();
        let half = columns.div_ceil(2);
        let block = |k: usize| {
            let (i, j) = (2 * (k % half), 2 * (k / half));
            let row = |j: usize| &self.blocks[j * columns + i..j * columns + (i + 2).min(columns)];
            let parts = (j..(j + 2).min(rows)).flat_map(row).filter(|block| block.shows());
            let mut sums: Option<Sums> = None;
            for part in parts {
                sums.get_or_insert_with(|| Sums::about(part.middle())).add_block(part);
            }
            sums.as_ref().map(Sums::block).unwrap_or_default()
        };
        Self { columns: half, blocks: (0..half * rows.div_ceil(2)).into_par_iter().map(block).collect() }
    }
}
