//! Geometry of many pixels at the price of a few: interpolated between the corners of a patch.

use glam::{DMat2, DVec2};

use super::Kernel;
use super::bend::Bend;
use super::gather::Gather;
use super::lattice::{Lattice, Point};
use crate::world::{PixelPoint, Source, View};

/// Pixels along a patch's side, and lanes that are worked on together.
pub(super) const SIDE: usize = 8;

/// Pixels from one of the points that a patch is measured at to the next.
pub(super) const HALF: usize = SIDE / 2;

/// A bit for each lane of which something holds.
pub(super) fn lanes_of(holds: impl Fn(usize) -> bool) -> u8 {
    (0..SIDE).fold(0, |lanes, lane| lanes | u8::from(holds(lane)) << lane)
}

/// How far, in texels, the interpolated place of a patch's middle may be from the exact one. The cubic curves between exact
/// corners err by much less in almost all patches; where a mapping bends more, each pixel is computed for itself.
const PLACE: f64 = 1.0 / 2048.0;

/// By what part of the largest derivative the others may bend from bilinear ones. They are interpolated by parabolas, whose
/// error is of the next order.
const SLOPE: f64 = 1.0 / 128.0;

/// By what part of itself, at a kernel's edge, the solid angle of a texel may differ from one that changes linearly within
/// the kernel.
const CURVATURE: f64 = 1.0 / 256.0;

/// A quantity over a patch as a parabola down each column: its value in the top row, what is added to that down to the row
/// below the last, and four times what is added half way down; that is zero for places, whose sides bulge apart.
#[derive(Clone, Copy, Debug)]
pub(super) struct Columns {
    pub(super) top: [f32; SIDE],
    pub(super) rise: [f32; SIDE],
    pub(super) bow: [f32; SIDE],
}

impl Columns {
    /// Straight from a function along the top edge to one along the bottom edge.
    fn straight(top: impl Fn(f64) -> f64, bottom: impl Fn(f64) -> f64) -> Self {
        Self::of(|s| [top(s), (top(s) + bottom(s)) / 2.0, bottom(s)])
    }

    /// The parabolas through three rows of three values, at the corners, half way between them and in the middle.
    fn parabolic(rows: [[f64; 3]; 3]) -> Self {
        Self::of(|s| rows.map(|[a, b, c]| a + s * (c - a) + s * (1.0 - s) * bow(a, b, c)))
    }

    /// From the values at the top, half way down and at the bottom.
    fn of(column: impl Fn(f64) -> [f64; 3]) -> Self {
        let columns: [[f64; 3]; SIDE] = std::array::from_fn(|k| column(k as f64 / SIDE as f64));
        Self {
            top: columns.map(|[top, ..]| top as f32),
            rise: columns.map(|[top, _, bottom]| (bottom - top) as f32),
            bow: columns.map(|[top, middle, bottom]| bow(top, middle, bottom) as f32),
        }
    }

    /// The value in a column, this part of the way down.
    fn at(&self, column: usize, t: f64) -> f64 {
        let [top, rise, bow] = [self.top, self.rise, self.bow].map(|row| f64::from(row[column]));
        top + t * rise + t * (1.0 - t) * bow
    }
}

/// Four times what a middle value is above the mean of those at the ends: t (1 − t) times this is the parabola's part.
fn bow(start: f64, middle: f64, end: f64) -> f64 {
    4.0 * middle - 2.0 * (start + end)
}

/// By how much a cubic between two values, with these derivatives at its ends, bulges from the line between them.
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

/// [`SIDE`] × [`SIDE`] pixels of a target as one view sees them: where each lies among its texels, and with what footprint.
///
/// The place is a Coons patch (1967) between cubics that have the exact place and derivatives at the corners, its error of
/// fourth order; derivatives are parabolas. Near the edge of a field of view only some of its pixels are made of it.
#[derive(Clone, Debug)]
pub(super) struct Patch<'a> {
    /// The view, by its index in the world.
    pub(super) view: usize,
    pub(super) source: &'a Source,
    /// The texel from which places are counted: near ones keep their digits in single precision.
    pub(super) origin: [i64; 2],
    /// U and V from the origin, without what the sides bulge by.
    pub(super) place: [Columns; 2],
    sides: [Bulge; 2],
    /// Ux, Vx, Uy, Vy: texels for one pixel to the right and one pixel down.
    pub(super) jacobian: [Columns; 4],
    pub(super) density: Density,
    /// How its texels lie around its middle.
    pub(super) bend: Bend,
    clearance: Clearance,
}

/// How far a patch of a target is from the edge of its field of view.
#[derive(Clone, Copy, Debug)]
pub(super) enum Clearance {
    /// The edge is near none of its pixels.
    Whole,
    /// It may be near those that have it within so many radians.
    Within(f64),
}

/// How the solid angle of texels changes over a patch, relative to itself.
#[derive(Clone, Copy, Debug)]
pub(super) struct Density {
    /// Where, in texels from the origin, the gradient is what it is.
    pub(super) at: [f32; 2],
    /// Change for one texel along U and V.
    pub(super) gradient: [f32; 2],
    /// Change of the gradient for one texel: along U of its U, along either of the other, along V of its V.
    pub(super) bend: [f32; 3],
}

/// Rows of three points of a patch: corners, what is half way between them, and the middle.
pub(super) type Grid<T> = [[T; 3]; 3];

impl<'a> Patch<'a> {
    /// The patch whose top left pixel is in column `i` of row `j`; `None` where its pixels had better be computed one by
    /// one: where views meet, near a singularity, where the mapping bends.
    pub(super) fn new(gather: &Gather<'a>, lattice: &mut Lattice, [i, j]: [usize; 2]) -> Option<Self> {
        let middle = lattice.footprint([i + HALF, j + HALF])?;
        let (view, _) = gather.world().owner(middle.direction)?;
        let source = &gather.world().sources()[view];
        let mut screen = [[middle; 3]; 3];
        let mut points = Grid::<Point>::default();
        for (y, (screen, points)) in screen.iter_mut().zip(&mut points).enumerate() {
            for (x, (screen, point)) in screen.iter_mut().zip(points).enumerate() {
                let (footprint, seen) = lattice.point([i + x * HALF, j + y * HALF], (view, source))?;
                // Beside a steep rim derivatives are not what pixels are measured by.
                if lattice.target().is_steep_at(&footprint) {
                    return None;
                }
                (*screen, *point) = (footprint, seen?);
            }
        }
        let clearance = gather.clearance(source, &screen)?;
        let density = Density::around(&source.view, &points, gather.kernel())?;
        let middle = points[1][1].place;
        let bend = Bend::around(&source.view, PixelPoint::new(middle.x, middle.y))?;
        Self::through((view, source), &points, density, bend).map(|patch| Self { clearance, ..patch })
    }

    /// Which pixels of a row come of it, a bit for each: those that the edge of the field of view is not near.
    pub(super) fn lanes(&self, gather: &Gather, target: &View, [i, j]: [usize; 2]) -> u8 {
        let Clearance::Within(reach) = self.clearance else { return u8::MAX };
        lanes_of(|lane| {
            let direction = target.direction(PixelPoint::centre(i + lane, j));
            direction.is_some_and(|direction| !gather.is_near_edge(direction, reach))
        })
    }

    /// `None` where the mapping bends too much.
    fn through(
        (view, source): (usize, &'a Source),
        points: &Grid<Point>,
        density: Density,
        bend: Bend,
    ) -> Option<Self> {
        let [[a, _, b], _, [c, _, d]] = *points;
        let origin = a.place.floor();
        let edge = |from: Point, to: Point, along: fn(&DMat2) -> DVec2| {
            let slope = |point: Point| along(&point.jacobian) * SIDE as f64;
            Bulge::new(from.place, to.place, slope(from), slope(to))
        };
        let (top, bottom) = (edge(a, b, |m| m.x_axis), edge(c, d, |m| m.x_axis));
        let along = |from: Point, to: Point, bulge: Bulge, axis: usize| {
            move |s: f64| (from.place + (to.place - from.place) * s + bulge.at(s) - origin)[axis]
        };
        let patch = Self {
            view,
            source,
            origin: [origin.x as i64, origin.y as i64],
            place: [0, 1].map(|axis| Columns::straight(along(a, b, top, axis), along(c, d, bottom, axis))),
            sides: [edge(a, c, |m| m.y_axis), edge(b, d, |m| m.y_axis)],
            jacobian: [0, 1, 2, 3]
                .map(|k| Columns::parabolic(points.map(|row| row.map(|point| point.jacobian.to_cols_array()[k])))),
            density,
            bend,
            clearance: Clearance::Whole,
        };
        (patch.error(points) < PLACE && is_almost_bilinear(points)).then_some(patch)
    }

    /// How far, in texels, places half way along the edges and in the middle are from the exact ones.
    fn error(&self, points: &Grid<Point>) -> f64 {
        let origin = points[0][0].place.floor();
        let error = |(x, y): (usize, usize)| {
            let (s, t) = (x as f64 / 2.0, y as f64 / 2.0);
            let sides = self.sides[0].at(t) * (1.0 - s) + self.sides[1].at(t) * s;
            let place = DVec2::new(self.place[0].at(x * HALF, t), self.place[1].at(x * HALF, t)) + sides;
            place.distance(points[y][x].place - origin)
        };
        // The right edge is the left one of the next patch.
        [(1, 0), (0, 1), (1, 1), (1, 2)].into_iter().map(error).fold(0.0, f64::max)
    }

    /// By how much the left and the right side bulge at a row, along U and V.
    pub(super) fn bulge(&self, row: usize) -> [[f32; 2]; 2] {
        self.sides.map(|side| side.at(row as f64 / SIDE as f64).as_vec2().to_array())
    }
}

/// Whether the derivatives half way between corners are about the mean of those there.
fn is_almost_bilinear([top, middle, bottom]: &Grid<Point>) -> bool {
    let bends = |a: &Point, b: &Point, c: &Point| ((a.jacobian + c.jacobian) * 0.5 - b.jacobian).to_cols_array();
    let largest = |of: [f64; 4]| of.into_iter().fold(0f64, |largest, value| largest.max(value.abs()));
    let bound = SLOPE * largest(middle[1].jacobian.to_cols_array());
    [top, middle, bottom].iter().all(|[a, b, c]| largest(bends(a, b, c)) < bound)
        && (0..3).all(|k| largest(bends(&top[k], &middle[k], &bottom[k])) < bound)
}

impl Density {
    /// That of a view's texels around the middle of a patch; `None` where it bends within a kernel.
    fn around(view: &View, points: &Grid<Point>, kernel: &Kernel) -> Option<Self> {
        let size = |point: &Point| {
            let [x, y] = [point.jacobian.x_axis, point.jacobian.y_axis];
            (x.length_squared() + y.length_squared()).sqrt()
        };
        let widest = points.iter().flatten().map(size).fold(0.0, f64::max);
        let radius = kernel.radius() * (kernel.scale * widest).max(kernel.floor);
        let (origin, at) = (points[0][0].place.floor(), points[1][1].place);
        let solid_angle = |u: f64, v: f64| view.solid_angle(PixelPoint::new(at.x + u, at.y + v));
        let here = solid_angle(0.0, 0.0).filter(|here| *here > 0.0)?;
        let [left, right, above, below, diagonal] =
            [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0), (1.0, 1.0)].map(|(u, v)| solid_angle(u, v));
        let [left, right, above, below, diagonal] =
            [left? / here, right? / here, above? / here, below? / here, diagonal? / here];
        let (x, y) = ((right - left) / 2.0, (below - above) / 2.0);
        let (xx, xy, yy) = (left + right - 2.0, diagonal - right - below + 1.0, above + below - 2.0);
        let at = at - origin;
        // No eigenvalue of the second derivatives is larger than this.
        let bend = xx.abs().max(yy.abs()) + xy.abs();
        (bend * radius * radius / 2.0 < CURVATURE).then(|| Self {
            at: [at.x as f32, at.y as f32],
            gradient: [x as f32, y as f32],
            // The gradient is relative to what is there.
            bend: [xx - x * x, xy - x * y, yy - y * y].map(|bend| bend as f32),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::CubeFace;
    use crate::world::{CubeFaceFrame, Frame, World};

    /// A point of a mapping, given its place at (s, t) and the derivatives of that, all over a patch that is 1 wide and high.
    fn point(place: impl Fn(f64, f64) -> DVec2, (s, t): (f64, f64)) -> Point {
        let step = 1e-5;
        let slope = |ds: f64, dt: f64| (place(s + ds, t + dt) - place(s - ds, t - dt)) / (2.0 * step * SIDE as f64);
        Point { place: place(s, t), jacobian: DMat2::from_cols(slope(step, 0.0), slope(0.0, step)) }
    }

    fn grid(place: impl Fn(f64, f64) -> DVec2) -> Grid<Point> {
        std::array::from_fn(|y| std::array::from_fn(|x| point(&place, (x as f64 / 2.0, y as f64 / 2.0))))
    }

    fn world() -> World {
        let front = Frame::CubeFace(CubeFaceFrame).view(64, 64).expect("a face");
        World::new([(CubeFace::Front.name().to_owned(), front)]).expect("one view")
    }

    const EVEN: Density = Density { at: [0.0; 2], gradient: [0.0; 2], bend: [0.0; 3] };

    /// A cubic across whose coefficients change linearly down, and the other way round.
    fn bent(s: f64, t: f64) -> DVec2 {
        DVec2::new(
            20.3 + 7.0 * s + 0.5 * t + 0.1 * s * s * t - 0.06 * s * s * s + 0.05 * t * t * t,
            11.8 - 0.4 * s + 6.5 * t - 0.08 * t * t + 0.07 * s * t * t * t + 0.04 * s * s * s * t,
        )
    }

    #[test]
    fn cubic_mappings_are_met_exactly() {
        let world = world();
        let patch = Patch::through((0, &world.sources()[0]), &grid(bent), EVEN, Bend::default()).expect("hardly bent");
        for row in 0..SIDE {
            let t = row as f64 / SIDE as f64;
            let [left, right] = patch.bulge(row);
            for column in 0..SIDE {
                let s = column as f64 / SIDE as f64;
                for axis in 0..2 {
                    let side = f64::from(left[axis]) * (1.0 - s) + f64::from(right[axis]) * s;
                    let found = patch.origin[axis] as f64 + patch.place[axis].at(column, t) + side;
                    let exact = bent(s, t)[axis];
                    assert!((found - exact).abs() < 2e-6, "({column}, {row}): {found}, not {exact}");
                }
            }
        }
    }

    #[test]
    fn kinks_are_refused() {
        let world = world();
        let through = |place: &dyn Fn(f64, f64) -> DVec2| {
            Patch::through((0, &world.sources()[0]), &grid(place), EVEN, Bend::default())
        };
        assert!(through(&bent).is_some());
        // Across, down, and around a point that none of the nine is near.
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
