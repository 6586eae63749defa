use glam::DVec2;
use rayon::prelude::*;

use crate::camera::Footprint;
use crate::filter::classic::method::Method;
use crate::filter::classic::tables::{Lit, Tables};
use crate::filter::classic::weighing::reached;
use crate::filter::reference::look;
use crate::filter::traits::SetupCost;
use crate::filter::{CrossSection, Kernel};
use crate::raster::Rgba;
use crate::world::{Source, World};

/// The rectangle around a footprint's parallelogram, evenly weighted, by four look-ups in a table of sums (Crow 1984).
///
/// A rectangle that crosses the edge of a view takes what lies in each view. Texels count by their solid angle. Sums are
/// f64. Each of the additions down a column is rounded by at most 2⁻⁵³ of the whole sum: in a picture of 16384² texels the
/// four look-ups of a rectangle are right to 4 · 2¹⁴ · 2²⁸ · 2⁻⁵³ = 2⁻⁹ of the mean light of a texel, and to some 2⁻¹⁷ as
/// roundings cancel. So it is the mean that counts: where a picture is a thousand times darker than its mean, as a night sky
/// is beside its sun, a rectangle of one texel is right to a hundredth there, and at worst to twice its light. Larger ones are
/// as much more exact.
pub(in crate::filter::classic) struct SummedArea;

impl Method for SummedArea {
    fn tables(self: Box<Self>, world: &World, light: &[Rgba]) -> Box<dyn Tables> {
        let table = |source: &Source| Table::new(source, &light[source.texels()]);
        Box::new(TablesOfViews(world.sources().par_iter().map(table).collect()))
    }

    fn setup(&self, world: &World) -> SetupCost {
        let of = |source: &Source| (source.columns() + 1) * (source.view.height() + 1);
        let entries: usize = world.sources().iter().map(of).sum();
        SetupCost { texels: world.texel_count(), bytes: entries * size_of::<Sums>() }
    }

    fn kernel(&self) -> Option<Kernel> {
        Some(Kernel::uniform(CrossSection::Box))
    }
}

/// Tables of a world's views.
struct TablesOfViews(Vec<Table>);

/// Numbers that are summed: light of four channels times solid angle, and the solid angle.
type Sums = [f64; 5];

/// Sums over all rectangles that begin at a view's first texel, in its first `columns` columns.
struct Table {
    columns: usize,
    rows: usize,
    /// Whether the picture repeats after the last column.
    is_round: bool,
    sums: Vec<Sums>,
}

/// Fills a row of sums, of which the first is zero, from the row above and the texels between.
fn sum_row<const N: usize>(above: &[[f64; N]], texels: impl Iterator<Item = [f64; N]>, row: &mut [[f64; N]]) {
    let mut along = [0.0; N];
    for ((texel, above), sum) in texels.zip(&above[1..]).zip(&mut row[1..]) {
        for k in 0..N {
            along[k] += texel[k];
            sum[k] = above[k] + along[k];
        }
    }
}

impl Table {
    fn new(source: &Source, light: &[Rgba]) -> Self {
        let (columns, rows, stride) = (source.columns(), source.view.height(), source.view.width());
        let pitch = columns + 1;
        let mut sums = vec![[0.0; 5]; pitch * (rows + 1)];
        let texel = |texel: usize| {
            let solid_angle = f64::from(source.solid_angles[texel]);
            let [red, green, blue, alpha] = light[texel].0.map(|channel| solid_angle * f64::from(channel));
            [red, green, blue, alpha, solid_angle]
        };
        for j in 0..rows {
            let (above, below) = sums.split_at_mut((j + 1) * pitch);
            sum_row(&above[j * pitch..], (j * stride..j * stride + columns).map(texel), &mut below[..pitch]);
        }
        Self { columns, rows, is_round: source.period.is_some(), sums }
    }

    /// Returns the sum from the first texel to a place in the image, linear between texels' corners.
    fn until(&self, at: DVec2) -> Sums {
        let columns = self.columns as f64;
        let turns = if self.is_round { (at.x / columns).floor() } else { 0.0 };
        let (x, y) = ((at.x - turns * columns).clamp(0.0, columns), at.y.clamp(0.0, self.rows as f64));
        let (i, j) = ((x as usize).min(self.columns - 1), (y as usize).min(self.rows - 1));
        let (right, down) = (x - i as f64, y - j as f64);
        let row = |i: usize, part: f64| {
            let at = |j: usize| &self.sums[j * (self.columns + 1) + i];
            let (above, below) = (at(j), at(j + 1));
            std::array::from_fn(|k| part * (above[k] + (below[k] - above[k]) * down))
        };
        let parts: [Sums; 2] = [row(i, 1.0 - right), row(i + 1, right)];
        let whole = if turns == 0.0 { [0.0; 5] } else { row(self.columns, turns) };
        std::array::from_fn(|k| parts[0][k] + parts[1][k] + whole[k])
    }

    /// Returns the sum of a rectangle.
    fn within(&self, first: DVec2, last: DVec2) -> Sums {
        let [a, b, c, d] =
            [last, first, DVec2::new(first.x, last.y), DVec2::new(last.x, first.y)].map(|at| self.until(at));
        std::array::from_fn(|k| a[k] + b[k] - c[k] - d[k])
    }
}

impl Tables for TablesOfViews {
    fn reads(&self, of: Lit, footprint: &Footprint) -> usize {
        /// Entries around each corner of a rectangle; a rectangle across a panorama's ends reads two more for each.
        const ENTRIES: usize = 4 * 4;
        ENTRIES * of.world.sources().iter().filter(|source| reached(source, footprint, 1.0).is_some()).count()
    }

    fn average(&self, of: Lit, footprint: &Footprint) -> Rgba {
        /// Part of a texel below which the edge of a rectangle is rounding.
        const LEAST: f64 = 1e-9;
        let mut sum = [0.0; 5];
        let mut least = f64::INFINITY;
        for (source, table) in of.world.sources().iter().zip(&self.0) {
            let Some(seen) = reached(source, footprint, 1.0) else { continue };
            // No narrower than a texel, so that two neighbours are interpolated where a picture is enlarged.
            let round = if table.is_round { 0.5 * table.columns as f64 } else { f64::INFINITY };
            let half = seen.half_box().max(DVec2::splat(0.5)).min(DVec2::new(round, f64::INFINITY));
            let found = table.within(seen.place - half, seen.place + half);
            (0..5).for_each(|k| sum[k] += found[k]);
            least = least.min(LEAST * source.texel_pitch.powi(2));
        }
        let [red, green, blue, alpha, solid_angle] = sum;
        if solid_angle > least {
            return Rgba([red, green, blue, alpha].map(|channel| (channel / solid_angle) as f32));
        }
        look(of.world, footprint.direction, of.light).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums of 16384² texels of a pattern whose sums are known, by the table's own recurrence: of single texels and of
    /// rectangles at the far corner, where sums are largest.
    #[test]
    fn sums_of_a_large_picture_are_exact_enough() {
        const SIDE: usize = 1 << 14;
        /// Rows of the rectangle.
        const ROWS: usize = 5;
        // No multiple of a power of two, so that sums are rounded.
        let unit = f64::from(0.1f32);
        let texel = |i: usize, j: usize| ((i * 5 + j * 3) % 7) as f64 * unit;
        let (mut above, mut row) = (vec![[0.0]; SIDE + 1], vec![[0.0]; SIDE + 1]);
        let mut before = above.clone();
        for j in 0..SIDE {
            if j == SIDE - ROWS {
                before.clone_from(&above);
            }
            sum_row(&above, (0..SIDE).map(|i| [texel(i, j)]), &mut row);
            std::mem::swap(&mut above, &mut row);
        }
        for columns in [1, 2, 7, 1000] {
            let first = SIDE - columns;
            let found = above[SIDE][0] - above[first][0] - before[SIDE][0] + before[first][0];
            let texels = (SIDE - ROWS..SIDE).flat_map(|j| (first..SIDE).map(move |i| (i, j)));
            let expected: f64 = texels.map(|(i, j)| texel(i, j)).sum();
            // The mean light is three units.
            assert!((found - expected).abs() < 3.0 * unit / 512.0, "{columns} columns: {found} for {expected}");
        }
    }
}
