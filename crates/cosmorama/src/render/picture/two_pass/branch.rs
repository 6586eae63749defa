use glam::DVec4;

use super::curve::Curve;
use super::knot::Knot;
use super::sweep::{Sum, Sweep};
use crate::camera::PixelPoint;
use crate::world::Source;

/// Pixels of a line that share the means of the first pass.
pub(super) struct Branch<'a> {
    sweep: &'a Sweep<'a>,
    source: &'a Source,
    /// Pixels, in the order of their places along the second pass.
    knots: Vec<Knot>,
    curve: Curve,
}

/// Texels of a view along one axis.
struct Axis {
    size: i64,
    /// Half of the texels all the way round.
    half_turn: Option<f64>,
}

impl Axis {
    /// Returns the texels within a distance of a place: those that the axis has, or half a turn at most.
    fn within(&self, from: f64, to: f64, reach: f64) -> std::ops::Range<i64> {
        let reach = self.half_turn.map_or(reach, |half| reach.min(half));
        let (first, last) = ((from - reach).floor() as i64, (to + reach).ceil() as i64);
        if self.half_turn.is_some() { first..last } else { first.max(0)..last.min(self.size) }
    }
}

impl<'a> Branch<'a> {
    pub(super) fn new(sweep: &'a Sweep, source: &'a Source, mut knots: Vec<Knot>) -> Self {
        knots.sort_by(|a, b| a.place.y.total_cmp(&b.place.y));
        let curve = Curve::fit(&knots);
        Self { sweep, source, knots, curve }
    }

    /// Averages along the branch, and adds each pixel's sum to its place in the line.
    pub(super) fn sweep(&self, sums: &mut [Sum]) {
        let radius = self.sweep.kernel.radius();
        let reach = |knot: &Knot| knot.units.y * radius;
        let second = self.axis(false);
        let ends = self.knots.iter().map(|knot| second.within(knot.place.y, knot.place.y, reach(knot)));
        let Some(rows) = ends.reduce(|a, b| a.start.min(b.start)..a.end.max(b.end)) else { return };
        let means: Vec<Sum> = rows.clone().map(|row| self.mean(row)).collect();
        for knot in &self.knots {
            let within = second.within(knot.place.y, knot.place.y, reach(knot));
            let mut sum = Sum::default();
            for row in within {
                let weight = self.sweep.kernel.weight(row as f64 + 0.5 - knot.place.y, knot.units.y);
                let mean = means[(row - rows.start) as usize];
                sum += Sum { light: mean.light * weight, share: mean.share * weight };
            }
            let whole = self.sweep.kernel.whole(knot.place.y, knot.units.y);
            let place = self.turned([knot.place.x, knot.place.y]);
            let angle = self.source.view.solid_angle(PixelPoint::new(place[0], place[1])).unwrap_or(0.0);
            // A view that gives a pixel nothing has no part in it.
            if whole > 0.0 && angle > 0.0 && sum.share > 0.0 {
                let part = 1.0 / (whole * angle);
                sums[knot.at] += Sum { light: sum.light * part, share: sum.share * part };
            }
        }
    }

    /// Averages a line of texels around the curve, by solid angle.
    fn mean(&self, row: i64) -> Sum {
        let (middle, unit) = (self.curve.at(row as f64 + 0.5), self.unit(row as f64 + 0.5));
        let (sweep, source) = (self.sweep, self.source);
        let mut sum = Sum::default();
        for column in self.axis(true).within(middle, middle, unit * sweep.kernel.radius()) {
            let weight = sweep.kernel.weight(column as f64 + 0.5 - middle, unit);
            let [i, j] = self.turned([column, row]);
            let Some(i) = source.column(i).filter(|_| weight > 0.0) else { continue };
            let texel = j as usize * source.view.width() + i as usize;
            let weight = weight * f64::from(source.solid_angles[texel]);
            let light = DVec4::from_array(sweep.light[source.offset + texel].0.map(f64::from));
            sum += Sum { light: light * weight, share: weight };
        }
        let whole = sweep.kernel.whole(middle, unit);
        if whole > 0.0 { Sum { light: sum.light / whole, share: sum.share / whole } } else { Sum::default() }
    }

    /// Returns the texels in a pixel of the first pass, between those of the pixels around.
    fn unit(&self, row: f64) -> f64 {
        let after = self.knots.partition_point(|knot| knot.place.y < row).clamp(1, self.knots.len().max(2) - 1);
        let (Some(from), Some(to)) = (self.knots.get(after - 1), self.knots.get(after)) else {
            return self.knots[0].units.x;
        };
        let part = ((row - from.place.y) / (to.place.y - from.place.y)).clamp(0.0, 1.0);
        from.units.x + (to.units.x - from.units.x) * part
    }

    /// Returns the axis of the first pass, or of the second.
    fn axis(&self, first: bool) -> Axis {
        let view = &self.source.view;
        if first == self.knots[0].columns_first {
            return Axis { size: view.height() as i64, half_turn: None };
        }
        Axis { size: view.width() as i64, half_turn: self.source.period.map(|period| 0.5 * period as f64) }
    }

    /// Exchanges places along both axes where columns come first.
    fn turned<T>(&self, [u, v]: [T; 2]) -> [T; 2] {
        if self.knots[0].columns_first { [v, u] } else { [u, v] }
    }
}
