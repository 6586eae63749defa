use glam::{DMat2, DVec2};

use super::weighing::{Region, ScreenKernel, Seen};

/// Model of two passes of one dimension each: rows first and then columns, or the other way (Catmull & Smith 1980).
///
/// The first pass averages each row of texels around the line on which the pixel's column lies. The second averages those
/// means along the column. Here both are composed into one kernel, which is evaluated pixel by pixel: there are no sweeps
/// and no intermediate picture, so that this shows the quality of two passes, and not their cost. The footprint's
/// derivatives stand for both mappings. Per pixel they are exact, so that no intermediate function is inverted or fitted
/// (Fraser, Schowengerdt & Briggs 1985), and nothing can fold over, which real sweeps may have to refuse.
///
/// An intermediate picture would have 1/a columns for each column of texels, where a = det J / p. Its bottleneck is a small
/// p: by the order of passes, and by turning the screen by 90°, p may be any of the four derivatives, and the largest is
/// taken. Then rows are sheared by 45° at most. Here p is the derivative that is left undivided.
///
/// The kernel is its own in each pass, so that it is no disc on the screen but a sheared square. This is what two passes
/// cannot do better, and why `ewa` is rounder.
pub(super) struct TwoPass(pub(super) ScreenKernel);

/// Two passes through one view: along `u` first, then along `v`. Axes are exchanged where columns come first.
struct Passes {
    columns_first: bool,
    /// Texels along `u` in a pixel of the first pass, and along `v` in one of the second; at least one.
    units: DVec2,
    /// Step along `u` of the first pass's line for each step along `v`.
    shear: f64,
}

impl Passes {
    /// Chooses the passes with the widest bottleneck.
    fn of(jacobian: DMat2) -> Self {
        let largest = |column: DVec2| column.abs().max_element();
        let (x, y) = (jacobian.x_axis, jacobian.y_axis);
        // The second pass follows this axis of the screen; the other one is that, turned by 90°.
        let along = if largest(y) >= largest(x) { y } else { x };
        let columns_first = along.x.abs() > along.y.abs();
        let along = if columns_first { DVec2::new(along.y, along.x) } else { along };
        let units = DVec2::new(jacobian.determinant() / along.y, along.y).abs().max(DVec2::ONE);
        Self { columns_first, units, shear: along.x / along.y }
    }

    /// Exchanges both axes where columns come first.
    fn turned(&self, at: DVec2) -> DVec2 {
        if self.columns_first { DVec2::new(at.y, at.x) } else { at }
    }
}

/// Texels in a pixel from which on the sum of weights along a row is the kernel's integral, to a thousandth.
const MANY: f64 = 256.0;

impl Region for TwoPass {
    fn texels(&self, seen: &Seen, mut visit: impl FnMut([i64; 2], f64)) {
        let passes = Passes::of(seen.jacobian);
        let half = passes.units * self.0.radius();
        let within = seen.texels_within(passes.turned(half + DVec2::new(passes.shear.abs() * half.y, 0.0)));
        let place = passes.turned(seen.place);
        // Of very many texels, the sum of weights along a row is the kernel's integral.
        let integral = (passes.units.x > MANY).then(|| passes.units.x * self.0.integral());
        let (rows, columns) =
            if passes.columns_first { (within.columns, within.rows) } else { (within.rows, within.columns) };
        for row in rows {
            let down = row as f64 + 0.5 - place.y;
            let of_row = self.0.weight((down / passes.units.y).powi(2));
            let middle = place.x + passes.shear * down;
            let weight = |column: i64| self.0.weight(((column as f64 + 0.5 - middle) / passes.units.x).powi(2));
            if of_row <= 0.0 {
                continue;
            }
            // The first pass makes a mean of each row: also of texels that the view does not have.
            let whole = integral.unwrap_or_else(|| {
                ((middle - half.x).floor() as i64..=(middle + half.x).ceil() as i64).map(weight).sum()
            });
            for column in columns.clone() {
                let part = weight(column);
                if part > 0.0 && whole > 0.0 {
                    visit(if passes.columns_first { [row, column] } else { [column, row] }, of_row * part / whole);
                }
            }
        }
    }
}
