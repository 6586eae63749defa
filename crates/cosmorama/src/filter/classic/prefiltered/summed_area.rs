use glam::DVec2;
use rayon::prelude::*;

use crate::camera::Footprint;
use crate::filter::classic::region::reached;
use crate::filter::reference::look;
use crate::filter::traits::{Prepared, bounded};
use crate::raster::Rgba;
use crate::world::{Source, World};

/// The rectangle around a footprint's parallelogram, evenly weighted, by four look-ups in a table of sums (Crow 1984).
///
/// A rectangle that crosses the edge of a view takes what lies in each view. Texels count by their solid angle. Sums are
/// f64. A sum over 16384² texels of light up to 1 has 2¹⁴ additions along a column, each rounded by at most 2⁻²⁵ of a
/// texel: the four look-ups of a rectangle are right to 2⁻⁹ of one texel's light, and to some 2⁻¹⁷ as roundings cancel.
pub(in crate::filter::classic) struct PreparedSummedArea<'w> {
    world: &'w World,
    light: &'w [Rgba],
    tables: Vec<Table>,
}

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

impl<'w> PreparedSummedArea<'w> {
    pub(in crate::filter::classic) fn new(world: &'w World, light: &'w [Rgba]) -> Self {
        let tables = world.sources().par_iter().map(|source| Table::new(source, &light[source.texels()])).collect();
        Self { world, light, tables }
    }

    /// Returns the bytes of all tables.
    pub(in crate::filter::classic) fn bytes(world: &World) -> usize {
        world.sources().iter().map(|source| (source.columns() + 1) * (source.view.height() + 1)).sum::<usize>()
            * size_of::<Sums>()
    }
}

impl Table {
    fn new(source: &Source, light: &[Rgba]) -> Self {
        let (columns, rows, stride) = (source.columns(), source.view.height(), source.view.width());
        let pitch = columns + 1;
        let mut sums = vec![[0.0; 5]; pitch * (rows + 1)];
        for j in 0..rows {
            let mut along = [0.0; 5];
            for i in 0..columns {
                let texel = j * stride + i;
                let (solid_angle, Rgba(light)) = (f64::from(source.solid_angles[texel]), light[texel]);
                let above = sums[j * pitch + i + 1];
                let into = &mut sums[(j + 1) * pitch + i + 1];
                for k in 0..5 {
                    along[k] += solid_angle * light.get(k).map_or(1.0, |channel| f64::from(*channel));
                    into[k] = above[k] + along[k];
                }
            }
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
        let parts: [Sums; 3] = [row(i, 1.0 - right), row(i + 1, right), row(self.columns, turns)];
        std::array::from_fn(|k| parts[0][k] + parts[1][k] + parts[2][k])
    }

    /// Returns the sum of a rectangle.
    fn within(&self, first: DVec2, last: DVec2) -> Sums {
        let [a, b, c, d] =
            [last, first, DVec2::new(first.x, last.y), DVec2::new(last.x, first.y)].map(|at| self.until(at));
        std::array::from_fn(|k| a[k] + b[k] - c[k] - d[k])
    }
}

impl Prepared for PreparedSummedArea<'_> {
    fn world(&self) -> &World {
        self.world
    }

    fn reads(&self, footprint: &Footprint) -> usize {
        /// Entries around each corner of a rectangle.
        const ENTRIES: usize = 4 * 4;
        let Some(footprint) = bounded(footprint) else { return 0 };
        ENTRIES * self.world.sources().iter().filter(|source| reached(source, &footprint).is_some()).count()
    }

    fn average(&self, footprint: &Footprint) -> Rgba {
        /// Part of a texel below which the edge of a rectangle is rounding.
        const LEAST: f64 = 1e-9;
        let Some(footprint) = bounded(footprint) else { return Rgba::TRANSPARENT };
        let mut sum = [0.0; 5];
        let mut least = f64::INFINITY;
        for (source, table) in self.world.sources().iter().zip(&self.tables) {
            let Some(seen) = reached(source, &footprint) else { continue };
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
        look(self.world, footprint.direction, self.light).unwrap_or_default()
    }
}
