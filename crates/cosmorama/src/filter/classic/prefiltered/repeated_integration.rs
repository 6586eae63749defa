use std::ops::RangeInclusive;

use rayon::prelude::*;

use crate::camera::Footprint;
use crate::filter::classic::method::Method;
use crate::filter::classic::tables::{Lit, Tables};
use crate::filter::classic::weighing::reached;
use crate::filter::reference::look;
use crate::filter::traits::{LEAST_BITS, PrepareError, SetupCost};
use crate::raster::Rgba;
use crate::world::{Source, World};

/// A smooth spline over the box around a footprint, by differences in a picture that was integrated several times
/// (Perlin; Heckbert 1986: "Filtering by repeated integration").
///
/// A box of width h, applied n times, is a B-spline of n pieces. Its sum over texels is an n-fold difference, in steps of
/// h, of the texels' n-fold sums. So n = 1 is Crow's rectangle, n = 2 a pyramid, and n = 3 nearly a Gaussian. Each box is
/// as wide as the footprint's own box. Places and widths between whole texels are interpolated.
///
/// Sums are integers of 128 bits that wrap around. A difference of sums is exact as long as it fits itself, however often
/// the sums have wrapped (Hogenauer 1981). So nothing is lost but the rounding of each texel's light, to one part in
/// 2^b of the brightest: see [`bits_of`].
pub(in crate::filter::classic) struct RepeatedIntegration(pub(in crate::filter::classic) IntegrationOrder);

/// Order of repeated integration: the number of boxes that are applied. 1 is a rectangle, 2 a pyramid, 3 nearly a Gaussian.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct IntegrationOrder(u32);

impl IntegrationOrder {
    /// Least and greatest order.
    pub const RANGE: RangeInclusive<u32> = 1..=4;

    /// Usual order.
    pub const USUAL: Self = Self(2);

    /// Returns an order; `None` if it is out of [`IntegrationOrder::RANGE`].
    pub fn new(order: u32) -> Option<Self> {
        Self::RANGE.contains(&order).then_some(Self(order))
    }

    /// Returns the number of boxes.
    pub fn get(self) -> u32 {
        self.0
    }
}

impl Method for RepeatedIntegration {
    fn tables(self: Box<Self>, world: &World, light: &[Rgba]) -> Box<dyn Tables> {
        let table = |source: &Source| Table::new(source, &light[source.texels()], self.0.get());
        Box::new(Integrals(world.sources().iter().map(table).collect()))
    }

    fn setup(&self, world: &World) -> SetupCost {
        let order = self.0.get() as usize;
        let of = |source: &Source| {
            let turns = if source.period.is_some() { 2 } else { 1 };
            (turns * source.columns() + order) * (source.view.height() + order)
        };
        let entries: usize = world.sources().iter().map(of).sum();
        SetupCost { texels: world.texel_count(), bytes: entries * size_of::<Sums>() }
    }

    fn check(&self, world: &World) -> Result<(), PrepareError> {
        let order = self.0.get();
        let lost = world.sources().iter().find(|source| bits_of(source, order) < LEAST_BITS);
        lost.map_or(Ok(()), |source| {
            Err(PrepareError::LosesPrecision {
                order,
                size: [source.columns(), source.view.height()],
                bits: bits_of(source, order),
            })
        })
    }
}

/// Sums of a world's views.
struct Integrals(Vec<Table>);

/// Numbers that are summed: light of four channels times solid angle, and the solid angle.
type Sums = [i128; 5];

/// Bits of a sum without its sign, and one to spare.
const ROOM: u32 = 126;

/// Most bits that a texel's light gets.
const FINEST: u32 = 40;

/// Returns the bits of a texel's light in the integrals of an order: what a kernel as large as the picture leaves.
fn bits_of(source: &Source, order: u32) -> u32 {
    bits_left(source.columns().max(1) * source.view.height().max(1), order)
}

/// Returns the bits that so many texels leave.
fn bits_left(texels: usize, order: u32) -> u32 {
    ROOM.saturating_sub(order.saturating_mul(texels.next_power_of_two().ilog2())).min(FINEST)
}

/// Sums of one view's texels, n times along rows and n times along columns.
struct Table {
    columns: Axis,
    rows: Axis,
    sums: Vec<Sums>,
    /// Light, and solid angle, of one unit.
    units: [f64; 2],
}

/// Texels along one direction, and the sums that are kept of them.
#[derive(Clone, Copy)]
struct Axis {
    texels: usize,
    /// Texels that are repeated before the first one and after the last, where a picture goes round.
    repeated: usize,
    order: usize,
}

impl Axis {
    /// Returns how many texels are summed, with repeated ones.
    fn summed(self) -> usize {
        self.texels + 2 * self.repeated
    }

    /// Returns how many sums are kept. Beyond the last texel they grow as a polynomial, which so many determine.
    fn kept(self) -> usize {
        self.summed() + self.order
    }

    /// Returns the widest box.
    fn widest(self) -> f64 {
        let whole = if self.repeated > 0 { self.texels / self.order } else { self.texels };
        whole.saturating_sub(1).max(1) as f64
    }

    /// Returns a place, or the nearest from which no box reaches a texel: so binomials of what lies beyond the last texel fit.
    fn near(self, place: f64) -> f64 {
        let reach = ((self.order + 1) * (self.texels + 2)) as f64;
        place.clamp(-reach, self.texels as f64 + reach)
    }

    /// Adds a difference of the sums to `steps`: indices with their factors. The boxes end at `end` and are `width` wide.
    fn difference(self, end: i64, width: i64, steps: &mut Vec<(usize, i128)>) {
        steps.clear();
        let mut factor = 1i128;
        for k in 0..=self.order as i64 {
            self.sum_until(end - k * width + self.repeated as i64, factor, steps);
            factor = -factor * i128::from(self.order as i64 - k) / i128::from(k + 1);
        }
    }

    /// Adds a sum over all texels before one, times a factor.
    fn sum_until(self, end: i64, factor: i128, steps: &mut Vec<(usize, i128)>) {
        let (last, order) = (self.summed() as i64, self.order as i64);
        if end <= 0 {
            return;
        }
        let beyond = end - last;
        if beyond < order {
            steps.push((end as usize, factor));
            return;
        }
        // Lagrange's polynomial through the last sums, in integers.
        for s in 0..order {
            let sign = if (order - 1 - s) % 2 == 0 { 1 } else { -1 };
            let value = sign * choose(beyond, s) * choose(beyond - s - 1, order - 1 - s);
            steps.push(((last + s) as usize, factor.wrapping_mul(value)));
        }
    }
}

/// Returns the number of ways to choose `k` of `n`.
fn choose(n: i64, k: i64) -> i128 {
    (0..k).fold(1, |ways, i| ways * i128::from(n - i) / i128::from(i + 1))
}

/// Returns the whole number below a width or a place, and the part of the next one.
fn between(value: f64) -> [(i64, f64); 2] {
    let lower = value.floor();
    [(lower as i64, 1.0 - (value - lower)), (lower as i64 + 1, value - lower)]
}

impl Table {
    fn new(source: &Source, light: &[Rgba], order: u32) -> Self {
        let bits = bits_of(source, order);
        let (stride, order) = (source.view.width(), order as usize);
        let repeated = if source.period.is_some() { source.columns() / 2 + order + 2 } else { 0 };
        let columns = Axis { texels: source.columns(), repeated, order };
        let rows = Axis { texels: source.view.height(), repeated: 0, order };
        let solid_angles = &source.solid_angles[..];
        let weighted = |texel: usize| {
            let solid_angle = f64::from(solid_angles[texel]);
            let [red, green, blue, alpha] = light[texel].0.map(|channel| f64::from(channel) * solid_angle);
            [red, green, blue, alpha, solid_angle]
        };
        let mut most = [f64::MIN_POSITIVE; 2];
        for texel in 0..light.len() {
            let [channels @ .., solid_angle] = weighted(texel);
            most = [channels.iter().fold(most[0], |most, value| most.max(value.abs())), most[1].max(solid_angle)];
        }
        let units = most.map(|most| most / f64::from(bits).exp2());
        let mut sums = vec![[0; 5]; columns.kept() * rows.kept()];
        // The first of each n sums is 0, and sums are kept one further on for each time: F(i + 1) = F(i) + f(i).
        sums.par_chunks_mut(columns.kept()).take(rows.texels).enumerate().for_each(|(j, row)| {
            for (i, sum) in row.iter_mut().take(columns.summed()).enumerate() {
                let column = (i as i64 - repeated as i64).rem_euclid(columns.texels as i64) as usize;
                let values = weighted(j * stride + column);
                *sum = std::array::from_fn(|k| (values[k] / units[usize::from(k == 4)]).round() as i128);
            }
            (0..order).for_each(|_| integrate(row));
        });
        for _ in 0..order {
            integrate_rows(&mut sums, columns.kept());
        }
        Self { columns, rows, sums, units }
    }

    /// Returns the mean under a spline around a place, whose boxes have these widths.
    fn mean(&self, [x, y]: [f64; 2], [width, height]: [f64; 2]) -> [f64; 5] {
        let (mut across, mut down) = (Vec::new(), Vec::new());
        let mut mean = [0.0; 5];
        for (height, height_part) in between(height) {
            for (bottom, bottom_part) in between(self.end(y, height)) {
                self.rows.difference(bottom, height, &mut down);
                for (width, width_part) in between(width) {
                    for (right, right_part) in between(self.end(x, width)) {
                        let part = height_part * bottom_part * width_part * right_part;
                        if part > 0.0 {
                            self.columns.difference(right, width, &mut across);
                            let area = ((width * height) as f64).powi(self.columns.order as i32);
                            let sums = self.weighted(&across, &down);
                            (0..5).for_each(|k| {
                                mean[k] += sums[k] as f64 * self.units[usize::from(k == 4)] * part / area
                            });
                        }
                    }
                }
            }
        }
        mean
    }

    /// Returns where boxes of a width end that are centred on a place: the middle of n boxes of h texels, added, is
    /// n (h + 1)/2 − ½ before the end of their sums.
    fn end(&self, place: f64, width: i64) -> f64 {
        place + self.columns.order as f64 * (width + 1) as f64 / 2.0 - 0.5
    }

    /// Returns a sum of sums with factors, modulo 2¹²⁸.
    fn weighted(&self, across: &[(usize, i128)], down: &[(usize, i128)]) -> Sums {
        let mut all = [0i128; 5];
        for &(j, down) in down {
            let row = &self.sums[j * self.columns.kept()..][..self.columns.kept()];
            let mut along = [0i128; 5];
            for &(i, factor) in across {
                (0..5).for_each(|k| along[k] = along[k].wrapping_add(row[i][k].wrapping_mul(factor)));
            }
            (0..5).for_each(|k| all[k] = all[k].wrapping_add(along[k].wrapping_mul(down)));
        }
        all
    }
}

/// Replaces values by the sums of all before each.
fn integrate<const N: usize>(values: &mut [[i128; N]]) {
    let mut sum = [0i128; N];
    for value in values {
        let next = std::array::from_fn(|k| sum[k].wrapping_add(value[k]));
        *value = sum;
        sum = next;
    }
}

/// Replaces rows by the sums of all rows above each.
fn integrate_rows(values: &mut [Sums], pitch: usize) {
    let mut sum = vec![[0i128; 5]; pitch];
    values.chunks_mut(pitch).for_each(|row| integrate_row(row, &mut sum));
}

/// Replaces a row by the sum of all rows above it, and adds it to that sum.
fn integrate_row<const N: usize>(row: &mut [[i128; N]], sum: &mut [[i128; N]]) {
    for (sum, value) in sum.iter_mut().zip(row) {
        let next = std::array::from_fn(|k| sum[k].wrapping_add(value[k]));
        *value = *sum;
        *sum = next;
    }
}

impl Tables for Integrals {
    fn reads(&self, of: Lit, footprint: &Footprint) -> usize {
        /// Places and widths that are interpolated.
        const BETWEEN: usize = 16;
        let views = of.world.sources().iter().zip(&self.0);
        let reached = views.filter(|(source, _)| reached(source, footprint, 1.0).is_some());
        reached.map(|(_, table)| BETWEEN * (table.columns.order + 1).pow(2)).sum()
    }

    fn average(&self, of: Lit, footprint: &Footprint) -> Rgba {
        /// Part of a texel below which what a kernel reaches is rounding.
        const LEAST: f64 = 1e-9;
        let (mut sum, mut least) = ([0.0; 5], f64::INFINITY);
        for (source, table) in of.world.sources().iter().zip(&self.0) {
            let Some(seen) = reached(source, footprint, 1.0) else { continue };
            let size = seen.half_box() * 2.0;
            let size = [size.x.clamp(1.0, table.columns.widest()), size.y.clamp(1.0, table.rows.widest())];
            let x = if source.period.is_some() {
                seen.place.x.rem_euclid(source.columns() as f64)
            } else {
                table.columns.near(seen.place.x)
            };
            let found = table.mean([x, table.rows.near(seen.place.y)], size);
            // The mean of a view that shows less is worth less: by the area of the kernel, in texels.
            (0..5).for_each(|k| sum[k] += found[k] * size[0] * size[1]);
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

    /// Sums of one column of texels, of light 1 and solid angle 1, except for its pattern.
    fn column(light: impl Fn(usize) -> i128, texels: usize, order: usize) -> (Axis, Vec<Sums>) {
        let axis = Axis { texels, repeated: 0, order };
        let mut sums: Vec<Sums> = (0..axis.kept()).map(|j| [if j < texels { light(j) } else { 0 }; 5]).collect();
        (0..order).for_each(|_| integrate(&mut sums));
        (axis, sums)
    }

    fn difference(axis: Axis, sums: &[Sums], end: i64, width: i64) -> i128 {
        let mut steps = Vec::new();
        axis.difference(end, width, &mut steps);
        steps.iter().fold(0, |sum, &(at, factor)| i128::wrapping_add(sum, sums[at][0].wrapping_mul(factor)))
    }

    /// Weights of boxes of a width, applied so many times, from the last texel back.
    fn boxes(width: usize, order: usize) -> Vec<i128> {
        (0..order).fold(vec![1], |weights: Vec<i128>, _| {
            let mut wider = vec![0; weights.len() + width - 1];
            weights.iter().enumerate().for_each(|(at, weight)| (at..at + width).for_each(|into| wider[into] += weight));
            wider
        })
    }

    #[test]
    fn differences_of_sums_are_splines_inside_and_beyond_the_edge() {
        let light = |j: usize| (j * j % 17) as i128;
        for order in 1..=4 {
            let (axis, sums) = column(light, 40, order);
            for (width, end) in [(1, 9), (3, 20), (7, 33), (5, 47), (9, 3), (12, 60), (4, -5), (2, 41)] {
                let texel = |back: usize| end - order as i64 - back as i64;
                let there = |at: i64| usize::try_from(at).ok().filter(|at| *at < 40).map_or(0, light);
                let expected: i128 =
                    boxes(width, order).iter().enumerate().map(|(back, weight)| weight * there(texel(back))).sum();
                assert_eq!(difference(axis, &sums, end, width as i64), expected, "order {order}, {width} to {end}");
            }
        }
    }

    #[test]
    fn large_pictures_leave_fewer_bits_to_high_orders() {
        assert_eq!((1..=4).map(|order| bits_left(1 << 24, order)).collect::<Vec<_>>(), [40, 40, 40, 30]);
        // 16384 × 8192: 27 bits of texels, four times; 24 are asked for.
        assert_eq!((3..=4).map(|order| bits_left(1 << 27, order)).collect::<Vec<_>>(), [40, 18]);
        assert_eq!(bits_left(2, u32::MAX), 0);
    }

    /// Sums of light of 100 bits wrap around many times, and differences are still exact.
    #[test]
    fn sums_may_wrap_around() {
        const TEXELS: usize = 1 << 22;
        let light = |j: usize| (1i128 << 100) + (j % 2) as i128;
        for order in [2, 3] {
            let (axis, sums) = column(light, TEXELS, order);
            let end = TEXELS as i64 - 5;
            let sum: i128 =
                boxes(8, order).iter().sum::<i128>() * (1 << 100) + boxes(8, order).iter().sum::<i128>() / 2;
            assert_eq!(difference(axis, &sums, end, 8), sum, "order {order}");
        }
    }
    /// Sums of 16384² texels, kept a few rows at a time: differences at the far corner, where sums are largest, are exact.
    #[test]
    fn differences_of_a_large_picture_are_exact() {
        const SIDE: usize = 1 << 14;
        const ORDER: usize = 2;
        const WIDTH: i64 = 9;
        // As bright as rounding makes them.
        let light = |i: usize, j: usize| ((i * 5 + j * 3) % 7) as i128 * ((1 << FINEST) / 6);
        let axis = Axis { texels: SIDE, repeated: 0, order: ORDER };
        let (mut across, mut down) = (Vec::new(), Vec::new());
        let end = (SIDE - 3) as i64;
        axis.difference(end, WIDTH, &mut across);
        axis.difference(end, WIDTH, &mut down);
        let mut above = [vec![[0i128]; axis.kept()], vec![[0i128]; axis.kept()]];
        let mut found = 0i128;
        for j in 0..axis.kept() {
            let texel = |i: usize| if i < SIDE && j < SIDE { light(i, j) } else { 0 };
            let mut row: Vec<[i128; 1]> = (0..axis.kept()).map(|i| [texel(i)]).collect();
            (0..ORDER).for_each(|_| integrate(&mut row));
            above.iter_mut().for_each(|sum| integrate_row(&mut row, sum));
            let along =
                || across.iter().fold(0i128, |sum, (i, factor)| sum.wrapping_add(row[*i][0].wrapping_mul(*factor)));
            for (_, factor) in down.iter().filter(|(row, _)| *row == j) {
                found = found.wrapping_add(along().wrapping_mul(*factor));
            }
        }
        let weights = boxes(WIDTH as usize, ORDER);
        let texel = |back: usize| end as usize - ORDER - back;
        let row = |(down, weight): (usize, &i128)| {
            let texels = weights.iter().enumerate().map(|(back, weight)| weight * light(texel(back), texel(down)));
            weight * texels.sum::<i128>()
        };
        assert_eq!(found, weights.iter().enumerate().map(row).sum::<i128>());
    }
}
