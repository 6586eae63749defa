//! A world's light on its way into a grid.

use std::f64::consts::PI;
use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use super::grid::{Channels, GridSize, Spread, Taps};
use super::points::{BrightPoints, brightness};
use crate::camera::PixelPoint;
use crate::lighting::prefilter::{LitTexels, LitView};
use crate::raster::Rgba;
use crate::sphere::Direction;

/// Pieces of a view whose rows are rings, and of any other view. They do not depend on the number of threads.
const RING_PIECES: usize = 16;
const PIECES: usize = 4;

/// Blocks of texels, taken as points, in a step of the grid along a side, at least.
const BLOCKS: f64 = 2.5;

/// Grid that takes light, and how coarsely.
#[derive(Clone, Copy)]
pub(super) struct Taker {
    pub(super) size: GridSize,
    /// Angle over which light may be taken together.
    pub(super) grain: f64,
    /// Mean radiance of the world.
    pub(super) mean: f64,
    /// Light of each texel that is not taken ([`Totals::least`](super::points::Totals::least)).
    pub(super) least: Channels,
}

/// Gives a grid the light of all texels but bright points.
pub(super) fn gather(lit: &LitTexels, bright: &BrightPoints, taker: Taker) -> Vec<Vec<Channels>> {
    let Taker { size, grain, mean, least } = taker;
    let most = grain.min(PI / size.rows as f64 / BLOCKS);
    let mut all = Spread::new(size);
    for (view, taken) in lit.views().zip(&bright.taken) {
        let side = (most / view.source.texel_pitch) as usize;
        let piece = Piece { view, taken, side: side.max(1), mean: mean as f32, least };
        let columns = piece.columns(size);
        let (height, pieces) = (view.size().1, if columns.is_some() { RING_PIECES } else { PIECES });
        let rows = height.div_ceil(pieces).next_multiple_of(piece.side);
        let spread = |first: usize| {
            let mut spread = Spread::new(size);
            let rows = first..(first + rows).min(height);
            match &columns {
                Some(columns) => piece.give_rings(rows, columns, &mut spread),
                None => piece.give_blocks(rows, &mut spread),
            }
            spread
        };
        let firsts: Vec<usize> = (0..height).step_by(rows.max(1)).collect();
        let pieces: Vec<Spread> = firsts.into_par_iter().map(spread).collect();
        pieces.into_iter().for_each(|piece| all.merge(piece));
    }
    for point in &bright.corrections {
        all.add(size.windows(point.direction), point.light);
    }
    all.into_rows()
}

/// A view whose light is given away.
#[derive(Clone, Copy)]
struct Piece<'a> {
    view: LitView<'a>,
    /// Texels that are bright points.
    taken: &'a [usize],
    /// Texels along a side of a block.
    side: usize,
    /// Mean radiance of the world.
    mean: f32,
    least: Channels,
}

/// Light of texels with the sum of their directions, weighted.
#[derive(Clone, Copy, Default)]
struct Block {
    light: Channels,
    middle: DVec3,
}

impl Piece<'_> {
    /// Returns the windows across of each block of columns in an upright panorama, whose rows are rings of one colatitude; `None` for
    /// any other view.
    fn columns(&self, size: GridSize) -> Option<Vec<Taps>> {
        let view = &self.view.source.view;
        let turn = view.upright_cylinder()?;
        let longitude = |first: usize| {
            let middle = 0.5 * (first + (first + self.side).min(view.width())) as f64;
            view.grid.to_plane(PixelPoint::new(middle, 0.5)).x + turn
        };
        Some((0..view.width()).step_by(self.side).map(|first| size.across(longitude(first))).collect())
    }

    /// Gives the light of rings.
    fn give_rings(&self, rows: Range<usize>, columns: &[Taps], spread: &mut Spread) {
        let size = spread.size();
        let mut ring = spread.ring();
        let mut light = vec![Channels::default(); self.view.size().0];
        for first in rows.clone().step_by(self.side) {
            let together = first..(first + self.side).min(rows.end);
            light.fill([0.0; 4]);
            together.clone().for_each(|j| self.add_row(j, &mut light));
            for (taps, lights) in columns.iter().zip(light.chunks(self.side)) {
                let sum = |channel: usize| lights.iter().map(|light| light[channel]).sum();
                ring.add(taps, std::array::from_fn(sum));
            }
            let count = together.len() as f64;
            let colatitude = together.filter_map(|j| self.colatitude(j)).sum::<f64>() / count;
            spread.add_ring(size.down(colatitude), &mut ring);
        }
    }

    /// Adds the light of a row to that of rows above it.
    fn add_row(&self, j: usize, light: &mut [Channels]) {
        let (texels, angles) = self.view.row(j);
        for columns in untaken(self.taken, j * texels.len(), texels.len()) {
            let texels = texels[columns.clone()].iter().zip(&angles[columns.clone()]);
            for ((Rgba(texel), angle), light) in texels.zip(&mut light[columns]) {
                (0..4).for_each(|channel| light[channel] += (texel[channel] - self.least[channel]) * angle);
            }
        }
    }

    /// Returns the colatitude of a row.
    fn colatitude(&self, j: usize) -> Option<f64> {
        let mut colatitude = None;
        self.view.source.view.row_directions(j, 0..1, |_, at| {
            let at = at.vector();
            colatitude = Some(at.x.hypot(at.z).atan2(at.y));
        });
        colatitude
    }

    /// Gives the light of blocks, each to the middle of its light.
    fn give_blocks(&self, rows: Range<usize>, spread: &mut Spread) {
        let size = spread.size();
        let mut blocks = vec![Block::default(); self.view.size().0.div_ceil(self.side)];
        for first in rows.clone().step_by(self.side) {
            (first..(first + self.side).min(rows.end)).for_each(|j| self.add_texels(j, &mut blocks));
            for block in &mut blocks {
                if let Some(middle) = Direction::new(block.middle) {
                    spread.add(size.windows(middle), block.light);
                }
                *block = Block::default();
            }
        }
    }

    /// Adds a row of texels to their blocks.
    fn add_texels(&self, j: usize, blocks: &mut [Block]) {
        let (texels, angles) = self.view.row(j);
        for columns in untaken(self.taken, j * texels.len(), texels.len()) {
            self.view.source.view.row_directions(j, columns, |i, direction| {
                let (Rgba(texel), angle) = (texels[i], angles[i]);
                let block = &mut blocks[i / self.side];
                (0..4).for_each(|channel| block.light[channel] += (texel[channel] - self.least[channel]) * angle);
                block.middle += direction.vector() * f64::from((brightness(texel) + self.mean) * angle);
            });
        }
    }
}

/// Returns the columns of a row, of so many texels from `first` on, without those that are taken.
fn untaken(taken: &[usize], first: usize, width: usize) -> impl Iterator<Item = Range<usize>> {
    let of_row = taken.partition_point(|texel| *texel < first)..taken.partition_point(|texel| *texel < first + width);
    let ends = taken[of_row.clone()].iter().map(move |texel| texel - first).chain([width]);
    let starts = std::iter::once(0).chain(taken[of_row].iter().map(move |texel| texel - first + 1));
    starts.zip(ends).map(|(start, end)| start..end)
}
