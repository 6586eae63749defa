//! Places and derivatives of a patch's pixels, interpolated between nine exact points.

use glam::{DMat2, DVec2};

use super::lattice::Point;
use super::tile::{HALF, SIDE};
use crate::filter::gather::clearance::Grid;
use crate::filter::semi_axes;

/// Greatest error of interpolated places half way between a patch's corners, in texels. Where the middle pixel's
/// shorter axis is longer than a texel, it is the unit instead, since it is the kernel's unit as well. The cubic curves
/// between exact corners err by much less in almost all patches. Where a mapping bends more, each pixel is measured.
const PLACE: f64 = 1.0 / 2048.0;

/// Greatest error of places in texels, however large pixels are.
const FARTHEST: f64 = 1.0 / 128.0;

/// Greatest departure of derivatives from bilinear ones, as a part of the largest derivative. They are interpolated by
/// parabolas, which have an error of the next order.
const SLOPE: f64 = 1.0 / 128.0;

/// A quantity over a patch as a parabola down each column. It has the value in the top row, the rise from there to the
/// row below the last, and four times the excess half way down. That excess is zero for places, whose sides bulge
/// apart.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Columns {
    pub(crate) top: [f32; SIDE],
    pub(crate) rise: [f32; SIDE],
    pub(crate) bow: [f32; SIDE],
}

impl Columns {
    /// Interpolates linearly from a function along the top edge to one along the bottom edge.
    fn straight(top: impl Fn(f64) -> f64, bottom: impl Fn(f64) -> f64) -> Self {
        Self::of(|s| [top(s), (top(s) + bottom(s)) / 2.0, bottom(s)])
    }

    /// Makes the parabolas through three rows of three values: at the corners, half way between them and in the middle.
    fn parabolic(rows: [[f64; 3]; 3]) -> Self {
        Self::of(|s| rows.map(|[a, b, c]| a + s * (c - a) + s * (1.0 - s) * bow(a, b, c)))
    }

    /// Makes the parabolas from the values at the top, half way down and at the bottom.
    fn of(column: impl Fn(f64) -> [f64; 3]) -> Self {
        let columns: [[f64; 3]; SIDE] = std::array::from_fn(|k| column(k as f64 / SIDE as f64));
        Self {
            top: columns.map(|[top, ..]| top as f32),
            rise: columns.map(|[top, _, bottom]| (bottom - top) as f32),
            bow: columns.map(|[top, middle, bottom]| bow(top, middle, bottom) as f32),
        }
    }

    /// Returns the value in a column, this part of the way down.
    fn at(&self, column: usize, t: f64) -> f64 {
        let [top, rise, bow] = [self.top, self.rise, self.bow].map(|row| f64::from(row[column]));
        top + t * rise + t * (1.0 - t) * bow
    }
}

/// Returns four times the excess of a middle value over the mean of the ends. Times t (1 − t), this is the parabola's
/// part.
fn bow(start: f64, middle: f64, end: f64) -> f64 {
    4.0 * middle - 2.0 * (start + end)
}

/// Bulge of a cubic between two values, with given derivatives at its ends, from the straight line between them.
#[derive(Clone, Copy, Debug)]
struct Bulge {
    start: DVec2,
    end: DVec2,
}

impl Bulge {
    fn new(from: DVec2, to: DVec2, slope_from: DVec2, slope_to: DVec2) -> Self {
        Self { start: slope_from - (to - from), end: slope_to - (to - from) }
    }

    fn at(&self, t: f64) -> DVec2 {
        (self.start * (1.0 - t) - self.end * t) * (t * (1.0 - t))
    }
}

/// Place of each pixel of a patch among the texels of a view, and its footprint.
///
/// The place is a Coons patch (1967) between cubics that have the exact place and derivatives at the corners. Its error
/// is of fourth order. Derivatives are parabolas.
#[derive(Clone, Debug)]
pub(crate) struct Coons {
    /// Coordinates U and V from the patch's origin, without the bulge of the sides.
    pub(crate) place: [Columns; 2],
    sides: [Bulge; 2],
    /// Derivatives Ux, Vx, Uy, Vy: texels for one pixel to the right and one pixel down.
    pub(crate) jacobian: [Columns; 4],
}

impl Coons {
    /// Makes the Coons patch through these points, whose places are counted from an origin. `None` where the mapping
    /// bends too much.
    pub(crate) fn through(points: &Grid<Point>, origin: DVec2) -> Option<Self> {
        let [[a, _, b], _, [c, _, d]] = *points;
        let edge = |from: Point, to: Point, along: fn(&DMat2) -> DVec2| {
            let slope = |point: Point| along(&point.slope) * SIDE as f64;
            Bulge::new(from.place, to.place, slope(from), slope(to))
        };
        let (top, bottom) = (edge(a, b, |m| m.x_axis), edge(c, d, |m| m.x_axis));
        let along = |from: Point, to: Point, bulge: Bulge, axis: usize| {
            move |s: f64| (from.place + (to.place - from.place) * s + bulge.at(s) - origin)[axis]
        };
        let coons = Self {
            place: [0, 1].map(|axis| Columns::straight(along(a, b, top, axis), along(c, d, bottom, axis))),
            sides: [edge(a, c, |m| m.y_axis), edge(b, d, |m| m.y_axis)],
            jacobian: [0, 1, 2, 3]
                .map(|k| Columns::parabolic(points.map(|row| row.map(|point| point.jacobian.to_cols_array()[k])))),
        };
        let error = coons.error(points, origin);
        // The size of a pixel takes longer to compute, and is seldom needed.
        let is_near = error < PLACE || error < FARTHEST.min(PLACE * semi_axes(points[1][1].jacobian)[1]);
        (is_near && is_almost_bilinear(points)).then_some(coons)
    }

    /// Returns the greatest distance, in texels, of places half way along the edges and in the middle from the exact
    /// ones.
    fn error(&self, points: &Grid<Point>, origin: DVec2) -> f64 {
        let error = |(x, y): (usize, usize)| {
            let (s, t) = (x as f64 / 2.0, y as f64 / 2.0);
            let sides = self.sides[0].at(t) * (1.0 - s) + self.sides[1].at(t) * s;
            let place = DVec2::new(self.place[0].at(x * HALF, t), self.place[1].at(x * HALF, t)) + sides;
            place.distance(points[y][x].place - origin)
        };
        // The right edge is the left one of the next patch.
        [(1, 0), (0, 1), (1, 1), (1, 2)].into_iter().map(error).fold(0.0, f64::max)
    }

    /// Returns the bulges of the left and the right side at a row, along U and V.
    pub(crate) fn bulge(&self, row: usize) -> [[f32; 2]; 2] {
        self.sides.map(|side| side.at(row as f64 / SIDE as f64).as_vec2().to_array())
    }
}

/// Returns whether the derivatives half way between corners are nearly the mean of the corners' derivatives.
fn is_almost_bilinear([top, middle, bottom]: &Grid<Point>) -> bool {
    let bends = |a: &Point, b: &Point, c: &Point| (a.jacobian + c.jacobian) * 0.5 - b.jacobian;
    let bound = SLOPE * largest(middle[1].jacobian);
    [top, middle, bottom].iter().all(|[a, b, c]| largest(bends(a, b, c)) < bound)
        && (0..3).all(|k| largest(bends(&top[k], &middle[k], &bottom[k])) < bound)
}

/// Returns the largest of some derivatives, by absolute value.
pub(crate) fn largest(jacobian: DMat2) -> f64 {
    jacobian.to_cols_array().into_iter().fold(0.0, |largest, value| largest.max(value.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a point of a mapping, given its place at (s, t) and the derivatives of that, over a patch that is 1 wide
    /// and high.
    fn point(place: impl Fn(f64, f64) -> DVec2, (s, t): (f64, f64)) -> Point {
        let step = 1e-5;
        let slope = |ds: f64, dt: f64| (place(s + ds, t + dt) - place(s - ds, t - dt)) / (2.0 * step * SIDE as f64);
        let slope = DMat2::from_cols(slope(step, 0.0), slope(0.0, step));
        Point { place: place(s, t), slope, jacobian: slope }
    }

    fn grid(place: impl Fn(f64, f64) -> DVec2) -> Grid<Point> {
        std::array::from_fn(|y| std::array::from_fn(|x| point(&place, (x as f64 / 2.0, y as f64 / 2.0))))
    }

    /// Computes the sum of a cubic across, whose coefficients change linearly down, and of a cubic down, likewise.
    fn bent(s: f64, t: f64) -> DVec2 {
        DVec2::new(
            20.3 + 7.0 * s + 0.5 * t + 0.1 * s * s * t - 0.06 * s * s * s + 0.05 * t * t * t,
            11.8 - 0.4 * s + 6.5 * t - 0.08 * t * t + 0.07 * s * t * t * t + 0.04 * s * s * s * t,
        )
    }

    #[test]
    fn cubic_mappings_are_met_exactly() {
        let origin = DVec2::new(20.0, 11.0);
        let coons = Coons::through(&grid(bent), origin).expect("hardly bent");
        for row in 0..SIDE {
            let t = row as f64 / SIDE as f64;
            let [left, right] = coons.bulge(row);
            for column in 0..SIDE {
                let s = column as f64 / SIDE as f64;
                for axis in 0..2 {
                    let side = f64::from(left[axis]) * (1.0 - s) + f64::from(right[axis]) * s;
                    let found = origin[axis] + coons.place[axis].at(column, t) + side;
                    let exact = bent(s, t)[axis];
                    assert!((found - exact).abs() < 2e-6, "({column}, {row}): {found}, not {exact}");
                }
            }
        }
    }

    #[test]
    fn kinks_are_refused() {
        let through = |place: &dyn Fn(f64, f64) -> DVec2| Coons::through(&grid(place), DVec2::ZERO);
        assert!(through(&bent).is_some());
        // Creases across and down, and a tip at a point that none of the nine is near.
        assert!(through(&|s, t| bent(s, t) + DVec2::new(0.2 * (s - 0.3).abs(), 0.0)).is_none());
        assert!(through(&|s, t| bent(s, t) + DVec2::new(0.0, 0.2 * (t - 0.7).abs())).is_none());
        assert!(through(&|s, t| bent(s, t) * (1.0 + 0.02 * (s - 0.3).hypot(t - 0.6))).is_none());
    }

    #[test]
    fn parabolas_go_through_nine_points() {
        let any = [[3.0, -1.0, 4.0], [1.0, -5.0, 9.0], [-2.0, 6.0, 5.0]];
        let columns = Columns::parabolic(any);
        for (y, row) in any.iter().enumerate() {
            for (x, expected) in row[..2].iter().enumerate() {
                assert!((columns.at(x * HALF, y as f64 / 2.0) - expected).abs() < 1e-6);
            }
        }
        let parabola = |s: f64, t: f64| 2.0 + s - 3.0 * t + 0.5 * s * s - 2.0 * s * t + 1.5 * t * t + s * s * t * t;
        let columns = Columns::parabolic([0.0, 0.5, 1.0].map(|t| [0.0, 0.5, 1.0].map(|s| parabola(s, t))));
        for column in 0..SIDE {
            for t in [0.0, 0.125, 0.4, 0.5, 0.9, 1.0] {
                let expected = parabola(column as f64 / SIDE as f64, t);
                assert!((columns.at(column, t) - expected).abs() < 2e-6, "{column}, {t}");
            }
        }
    }
}
