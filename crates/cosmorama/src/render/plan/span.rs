use std::ops::Range;

use crate::render::batch::window::Windows;
use crate::render::scan::tile::{SIDE, lanes_of};

/// Up to [`SIDE`] neighbouring pixels of a row, whose windows have one size and lie in one view.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Run {
    /// First column of the leftmost window, and first row of the highest one.
    corner: [u32; 2],
    /// Offset of each window's first texel from `corner`.
    offsets: [[u8; 2]; SIDE],
    /// Index of the group's first weight among those of the band.
    pub(crate) weights: u32,
    /// Column of the first pixel.
    column: u32,
    /// Index of the view, in the world's order, that all windows of the run lie in.
    pub(crate) view: u16,
    /// Row in the band.
    row: u8,
    /// Pixels that the run makes, a bit for each.
    lanes: u8,
    pub(crate) width: u8,
    pub(crate) height: u8,
    /// First row of its windows that holds texels under a pixel, and the row after the last one.
    under: [u8; 2],
}

/// Column and row of the first texel of each lane's window, in the lanes that have one.
pub(crate) type Corners = [Option<[u32; 2]>; SIDE];

impl Run {
    /// Returns the pixels that the run makes, by lane.
    #[inline(always)]
    pub(crate) fn lanes(&self) -> impl Iterator<Item = usize> + use<> {
        let mut rest = self.lanes;
        std::iter::from_fn(move || {
            let lane = rest.trailing_zeros() as usize;
            rest &= rest.wrapping_sub(1);
            (lane < SIDE).then_some(lane)
        })
    }

    /// Returns the lanes that make a pixel, one bit for each.
    pub(crate) fn lane_bits(&self) -> u8 {
        self.lanes
    }

    /// Returns whether the run makes a pixel in each lane.
    #[inline(always)]
    pub(crate) fn is_whole(&self) -> bool {
        self.lanes == u8::MAX
    }

    /// Returns the leftmost column and the highest row of its windows' texels.
    #[inline(always)]
    pub(crate) fn corner(&self) -> [usize; 2] {
        self.corner.map(|at| at as usize)
    }

    /// Returns the column and the row after the last ones of its windows, to within a texel.
    #[inline(always)]
    pub(crate) fn end(&self) -> [usize; 2] {
        // Windows follow each other in one direction, and a lane without a window has the offset of a neighbour.
        let [first, last] = [self.offsets[0], self.offsets[SIDE - 1]];
        let end = |axis: usize, size: u8| {
            self.corner[axis] as usize + usize::from(first[axis].max(last[axis])) + usize::from(size)
        };
        [end(0, self.width), end(1, self.height)]
    }

    /// Returns the least column and row at which a window begins, and the greatest.
    #[inline(always)]
    pub(crate) fn corners(&self) -> ([u32; 2], [u32; 2]) {
        let farthest = self.offsets.iter().fold([0; 2], |all, offset| [all[0].max(offset[0]), all[1].max(offset[1])]);
        (self.corner, [0, 1].map(|axis| self.corner[axis].wrapping_add(u32::from(farthest[axis]))))
    }

    /// Returns the column and the row at which a lane's window begins.
    #[inline(always)]
    pub(crate) fn first(&self, lane: usize) -> [u32; 2] {
        let [column, row] = self.offsets[lane].map(u32::from);
        [self.corner[0].wrapping_add(column), self.corner[1].wrapping_add(row)]
    }

    /// Returns a run that makes these lanes, in the first patch of the first view.
    #[cfg(test)]
    pub(crate) fn of_lanes(lanes: u8, weights: u32) -> Self {
        let offsets = [[0; 2]; SIDE];
        Self { corner: [0; 2], offsets, weights, column: 0, view: 0, row: 0, lanes, width: 4, height: 4, under: [0; 2] }
    }

    /// Moves the run's windows to begin at this texel.
    #[cfg(test)]
    pub(crate) fn from(self, corner: [u32; 2]) -> Self {
        Self { corner, ..self }
    }

    /// Sets the offset of the last lane's window from the first, in columns and rows.
    #[cfg(test)]
    pub(crate) fn with_last(mut self, offset: [u8; 2]) -> Self {
        self.offsets[SIDE - 1] = offset;
        self
    }

    /// Moves the run to other pixels.
    #[cfg(test)]
    pub(crate) fn at(self, [column, row]: [usize; 2]) -> Self {
        Self { column: column as u32, row: row as u8, ..self }
    }

    /// Returns a lane's column, and the row in the band.
    #[inline(always)]
    pub(crate) fn pixel(&self, lane: usize) -> [usize; 2] {
        [self.column as usize + lane, usize::from(self.row)]
    }

    /// Returns the run's row in the patch.
    #[inline(always)]
    pub(crate) fn row_in_patch(&self) -> usize {
        usize::from(self.row) % SIDE
    }

    /// Returns whether a run that begins at this pixel belongs to the same patch.
    pub(crate) fn shares_patch(&self, [column, row]: [usize; 2]) -> bool {
        self.column as usize == column && usize::from(self.row) / SIDE == row / SIDE
    }

    /// Returns the rows of its windows that hold texels under a pixel.
    #[inline(always)]
    pub(crate) fn rows_under(&self) -> Range<usize> {
        usize::from(self.under[0])..usize::from(self.under[1])
    }

    /// Makes the run of windows that begin at these texels; `None` if its numbers do not fit.
    pub(crate) fn new(windows: &Windows, corners: &Corners, [column, row]: [usize; 2], weights: usize) -> Option<Self> {
        let lanes = lanes_of(|lane| corners[lane].is_some());
        // A lane without a window takes the place of the last one before it that has one, or of the first, so that
        // loops need no branches.
        let first = corners[lanes.trailing_zeros() as usize % SIDE]?;
        let corner = corners.map(|corner| corner.unwrap_or(first)).into_iter();
        let corner = corner.fold(first, |least, texel| [least[0].min(texel[0]), least[1].min(texel[1])]);
        let mut last = first;
        let offsets = corners.map(|texel| {
            last = texel.unwrap_or(last);
            [last[0] - corner[0], last[1] - corner[1]]
        });
        if offsets.as_flattened().iter().fold(0, |all, offset| all | offset) > u32::from(u8::MAX) {
            return None;
        }
        let offsets = offsets.map(|offset| offset.map(|texels| texels as u8));
        let under = windows.rows_under();
        Some(Self {
            corner,
            offsets,
            weights: u32::try_from(weights).ok()?,
            column: column as u32,
            view: u16::try_from(windows.view()).ok()?,
            row: row as u8,
            lanes,
            width: u8::try_from(windows.width()).ok()?,
            height: u8::try_from(windows.height()).ok()?,
            under: [under.start as u8, under.end as u8],
        })
    }
}
