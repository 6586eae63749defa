use glam::{DVec2, Vec2Swizzles};

use super::weighing::{Region, ScreenKernel, Seen, reached};
use crate::camera::Footprint;
use crate::filter::Kernel;
use crate::world::Source;

/// Two passes of one dimension each: rows first and then columns, or the other way (Catmull & Smith 1980).
///
/// The first pass averages each row of texels around the line on which the pixel's column lies. The second averages those
/// means along the column. Pictures are made by such passes, with means that all pixels of a column share
/// (`render/two_pass`). Here both are composed into one kernel for a single footprint: its derivatives stand for both
/// mappings.
///
/// The means would be a picture with 1/a columns for each column of texels, where a = det J / p. Its bottleneck is a small
/// p: by the order of passes, and by turning the screen by 90°, p may be any of the four derivatives, and the largest is
/// taken. Then rows are sheared by 45° at most. Here p is the derivative that is left undivided.
///
/// The kernel is its own in each pass, so that it is no disc on the screen but a sheared square. This is what two passes
/// cannot do better, and why `ewa` is rounder.
pub(crate) struct TwoPass(pub(super) ScreenKernel);

/// Two passes through one view: along `u` first, then along `v`. Axes of the view are exchanged where columns come first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Passes {
    /// Place of the footprint's middle, in the view.
    pub(crate) place: DVec2,
    /// Whether the second pass follows the screen's columns; otherwise its rows.
    pub(crate) follows_columns: bool,
    /// Whether the first pass averages columns of texels; otherwise rows.
    pub(crate) columns_first: bool,
    /// Texels along `v` to the next pixel of the second pass.
    pub(crate) step: f64,
    /// Texels along `u` in a pixel of the first pass, and along `v` in one of the second; at least one.
    pub(crate) units: DVec2,
    /// Step along `u` of the first pass's line for each step along `v`.
    pub(crate) shear: f64,
}

impl Passes {
    /// Chooses the passes with the widest bottleneck.
    fn of(seen: &Seen) -> Self {
        let largest = |column: DVec2| column.abs().max_element();
        let (x, y) = (seen.jacobian.x_axis, seen.jacobian.y_axis);
        let follows_columns = largest(y) >= largest(x);
        // The second pass follows this axis of the screen; the other one is that, turned by 90°.
        let along = if follows_columns { y } else { x };
        let columns_first = along.x.abs() > along.y.abs();
        let along = if columns_first { along.yx() } else { along };
        let units = DVec2::new(seen.jacobian.determinant() / along.y, along.y).abs().max(DVec2::ONE);
        Self { place: seen.place, follows_columns, columns_first, step: along.y, units, shear: along.x / along.y }
    }

    /// Exchanges both axes where columns come first.
    pub(crate) fn turned(&self, at: DVec2) -> DVec2 {
        if self.columns_first { at.yx() } else { at }
    }
}

impl TwoPass {
    /// Weighs by a Gaussian in each pass; of any other kernel, the paper's stands instead.
    pub(crate) fn of(kernel: &Kernel) -> Self {
        Self(ScreenKernel::of(kernel))
    }

    /// Returns the passes by which a view makes a pixel; `None` if it shows nothing near it.
    pub(crate) fn passes(&self, source: &Source, footprint: &Footprint) -> Option<Passes> {
        Some(Passes::of(&reached(source, footprint, self.radius())?))
    }

    /// Returns the radius of the kernel, in pixels.
    pub(crate) fn radius(&self) -> f64 {
        self.0.radius()
    }

    /// Returns the weight at a distance along a line, in texels, where a pixel has so many.
    pub(crate) fn weight(&self, distance: f64, unit: f64) -> f64 {
        self.0.weight((distance / unit).powi(2))
    }

    /// Returns the sum of the weights of all texels along a line, of which a pixel has so many.
    pub(crate) fn whole(&self, middle: f64, unit: f64) -> f64 {
        if unit > MANY {
            return unit * self.0.integral();
        }
        let half = unit * self.radius();
        let texels = (middle - half).floor() as i64..=(middle + half).ceil() as i64;
        texels.map(|texel| self.weight(texel as f64 + 0.5 - middle, unit)).sum()
    }
}

/// Texels in a pixel from which on the sum of weights along a row is the kernel's integral, to a thousandth.
const MANY: f64 = 256.0;

impl Region for TwoPass {
    fn texels(&self, seen: &Seen, mut visit: impl FnMut([i64; 2], f64)) {
        let passes = Passes::of(seen);
        let half = passes.units * self.radius();
        let within = seen.texels_within(passes.turned(half + DVec2::new(passes.shear.abs() * half.y, 0.0)));
        let place = passes.turned(seen.place);
        let (rows, columns) =
            if passes.columns_first { (within.columns, within.rows) } else { (within.rows, within.columns) };
        for row in rows {
            let down = row as f64 + 0.5 - place.y;
            let of_row = self.weight(down, passes.units.y);
            if of_row <= 0.0 {
                continue;
            }
            let middle = place.x + passes.shear * down;
            // The first pass makes a mean of each row: also of texels that the view does not have.
            let whole = self.whole(middle, passes.units.x);
            for column in columns.clone() {
                let part = self.weight(column as f64 + 0.5 - middle, passes.units.x);
                if part > 0.0 && whole > 0.0 {
                    visit(if passes.columns_first { [row, column] } else { [column, row] }, of_row * part / whole);
                }
            }
        }
    }
}
