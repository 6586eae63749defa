pub(crate) mod lattice;
pub(crate) mod patch;
pub(crate) mod patch_interpolation;
pub(crate) mod sampling;
#[cfg(test)]
mod tests;
pub(crate) mod tile;
pub(crate) mod wanted;

use std::ops::Range;

use super::Resampler;
use super::batch::weights::Weigher;
use super::batch::window::{Level, Windows};
use super::scan::lattice::Lattice;
use super::scan::patch::Patch;
use super::scan::sampling::Sampling;
use super::scan::tile::{HALF, SIDE};
use crate::camera::{PixelRect, ScreenPixel};
use crate::filter::gather::pixel_taps::PixelTaps;
use crate::filter::kernel::KernelTable;
use crate::filter::taps::Taps;

/// Number of columns that are scanned together: pixels above each other share texels, which are still in the cache.
const TILE: usize = 8 * SIDE;

/// Scan of a target's pixels, which gives the taps of each to a [`Sink`]: patch by patch where the geometry is smooth,
/// one by one elsewhere.
pub(crate) struct Scan<'a> {
    resampler: &'a Resampler<'a>,
    pixels: PixelTaps<'a>,
    /// Weigher, for filters that work in windows.
    weigher: Option<Weigher>,
    lattice: Lattice<'a>,
    sampling: Sampling<'a>,
}

/// A part of a target.
pub(crate) struct Area {
    /// Number of columns, from the first on.
    pub(crate) columns: usize,
    pub(crate) rows: Range<usize>,
    /// Whether patches to the left of the diagonal through the first column and row of the target are left out.
    pub(crate) skips_left_of_diagonal: bool,
}

/// Receiver of the pixels of a [`Scan`], each with its column in the target and its row among those of the scan.
pub(crate) trait Sink {
    /// Takes a single pixel, and the part of it inside the field of view.
    fn pixel(&mut self, pixel: [usize; 2], coverage: f32, taps: &Taps);

    /// Takes neighbouring pixels, all wholly inside the field of view, in the lanes whose bit is set. Pixels whose
    /// windows do not fit come singly.
    fn windows(&mut self, pixel: [usize; 2], lanes: u8, windows: &Windows);
}

impl<'a> Scan<'a> {
    /// Prepares a scan; `table` belongs to the filter's kernel.
    pub(crate) fn new(
        (resampler, sampling): (&'a Resampler<'a>, Sampling<'a>),
        table: &'a KernelTable,
        level: Level,
    ) -> Self {
        let Resampler { world, target, filter } = resampler;
        let weigher = filter.kind.is_elliptical().then(|| Weigher::new(&filter.kernel, level)).flatten();
        let pixels = PixelTaps::new(world, target, filter, table);
        Self { resampler, pixels, weigher, lattice: Lattice::new((target, sampling), &filter.kernel), sampling }
    }

    /// Scans all pixels of a part that show something.
    pub(crate) fn pixels(&mut self, Area { columns, rows, skips_left_of_diagonal }: &Area, sink: &mut impl Sink) {
        for tile in (0..*columns).step_by(TILE) {
            // Patches lie on a fixed grid whatever the first row, so that pixels do not depend on it.
            for top in (rows.start / SIDE * SIDE..rows.end).step_by(SIDE) {
                let from = if *skips_left_of_diagonal { tile.max(top) } else { tile };
                for left in (from..(tile + TILE).min(*columns)).step_by(SIDE) {
                    self.patch([left, top], *columns, rows, sink);
                }
            }
        }
    }

    /// Returns whether a great circle that ends the field of view surely hides the patch with this first pixel. If it
    /// does not hide the patch's middle, nothing more is tested.
    fn is_cut_off(&mut self, first: [usize; 2]) -> bool {
        let target = self.resampler.target;
        let Some(side) = target.stop.half_space else { return false };
        let middle = self.lattice.footprint(first.map(|at| at + HALF));
        middle.is_some_and(|middle| side.dot(target.orientation.to_view(middle.direction)) < 0.0)
            && self.lattice.cap(first).is_some_and(|cap| cap.is_below(side, target))
    }

    fn patch(&mut self, [left, top]: [usize; 2], columns: usize, rows: &Range<usize>, sink: &mut impl Sink) {
        if self.sampling.wanted.is_some_and(|wanted| !wanted.holds([left, top])) {
            return;
        }
        let first = rows.start;
        let target = self.resampler.target;
        let rows = top.max(rows.start)..rows.end.min(top + SIDE);
        let count = SIDE.min(columns - left);
        let (all, right) = (u8::MAX >> (SIDE - count), left + count);
        let rect = PixelRect { left, top: rows.start, right, bottom: rows.end };
        if target.outline_hides(rect) || self.is_cut_off([left, top]) {
            return;
        }
        let gather = self.pixels.gather();
        let patch = self.weigher.as_ref().and_then(|_| Patch::new(gather, &mut self.lattice, [left, top]));
        let mut windows = self.weigher.as_mut().zip(patch.as_ref()).map(|(weigher, patch)| weigher.rows(patch));
        for row in rows {
            let within = row - first;
            let lanes = patch.as_ref().map_or(0, |patch| all & patch.lanes(self.pixels.gather(), target, [left, row]));
            let mut made = 0;
            if let Some(windows) = windows.as_mut().filter(|_| lanes != 0) {
                let windows = windows.row(row - top);
                sink.windows([left, within], lanes, windows);
                made = lanes & windows.held();
            }
            for lane in (0..count).filter(|lane| made >> lane & 1 == 0) {
                let Some(screen) = target.screen_pixel(left + lane, row) else { continue };
                let Some(footprint) = self.sampling.footprint(&screen.footprint) else { continue };
                let Some(taps) = self.pixels.taps(&ScreenPixel { footprint, ..screen }) else { continue };
                sink.pixel([left + lane, within], screen.coverage as f32, taps);
            }
        }
    }
}
