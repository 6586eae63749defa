//! Polygons, cut into triangles.

use glam::{DVec2, DVec3};

/// Most corners of a polygon that bends inward: cutting it takes time that goes with their square.
const MOST: usize = 4096;

/// Area that rounding makes, in squares of the polygon's extent.
const ROUNDING: f64 = 1e-13;

/// Part of a polygon's area that a fan may have turned over where there are too many corners to cut: circles are rounded.
const TURNED: f64 = 1e-6;

/// The triangles of a polygon.
pub(super) struct Cut {
    /// Numbers of its corners, in the polygon's own order around each triangle.
    pub(super) triangles: Vec<[usize; 3]>,
    /// Whether it crosses itself, so that there are no triangles that fill it.
    pub(super) is_crossed: bool,
}

/// Cuts a polygon into triangles between its corners, two less than there are.
///
/// A fan around the first corner serves if all of its triangles face as the whole does, as in convex polygons. Others are cut ear by
/// ear, in the plane of their mean normal (G. Meisters, *Polygons have ears*, 1975). Each corner stays one, even in the middle of a
/// straight side, where a neighbour may have one, too.
pub(super) fn cut(points: &[DVec3]) -> Result<Cut, String> {
    let fan = || (1..points.len() - 1).map(|k| [0, k, k + 1]);
    let normal = area(points);
    let (plane, whole) = (normal.normalize_or_zero(), normal.length());
    let least = ROUNDING * points.iter().map(|point| point.distance_squared(points[0])).fold(0.0, f64::max);
    let part = |[a, b, c]: [usize; 3]| (points[b] - points[a]).cross(points[c] - points[a]);
    if points.len() == 3 || fan().all(|face| part(face).dot(plane) > least) {
        return Ok(Cut { triangles: fan().collect(), is_crossed: false });
    }
    if plane == DVec3::ZERO {
        // On a line, or of parts that face opposite ways.
        return Ok(Cut { triangles: fan().collect(), is_crossed: fan().any(|face| part(face).length() > least) });
    }
    if points.len() > MOST {
        let turned: f64 = fan().map(|face| -part(face).dot(plane).min(0.0)).sum();
        if turned < TURNED * whole {
            return Ok(Cut { triangles: fan().collect(), is_crossed: false });
        }
        let count = points.len();
        return Err(format!("the face bends inward and has {count} corners; expected at most {MOST}, or triangles"));
    }
    let (x, y) = plane.any_orthonormal_pair();
    let from_first = points.iter().map(|point| *point - points[0]);
    let flat: Vec<DVec2> = from_first.map(|point| DVec2::new(point.dot(x), point.dot(y))).collect();
    Ok(Cut { triangles: Ring::new(&flat, least).cut(), is_crossed: is_crossed(&flat, least) })
}

/// Returns the polygon's normal, as long as twice its area (M. Newell).
fn area(points: &[DVec3]) -> DVec3 {
    let from_first = |pair: &[DVec3]| (pair[0] - points[0]).cross(pair[1] - points[0]);
    points.windows(2).map(from_first).sum()
}

/// Returns whether two sides of a polygon cross each other, by more than an area that counts as none.
fn is_crossed(points: &[DVec2], least: f64) -> bool {
    let side = |k: usize| (points[k], points[(k + 1) % points.len()]);
    let parts = |(a, b): (DVec2, DVec2), (c, d): (DVec2, DVec2)| {
        let [c, d] = [c, d].map(|point| (b - a).perp_dot(point - a));
        c.min(d) < -least && c.max(d) > least
    };
    let crosses = |one: usize, other: usize| parts(side(one), side(other)) && parts(side(other), side(one));
    (0..points.len()).any(|one| (0..one).any(|other| crosses(one, other)))
}

/// The corners that are left of a polygon in a plane, anticlockwise.
struct Ring<'a> {
    points: &'a [DVec2],
    /// Area that counts as none.
    least: f64,
    corners: Vec<usize>,
    is_ear: Vec<bool>,
}

impl<'a> Ring<'a> {
    fn new(points: &'a [DVec2], least: f64) -> Self {
        let mut ring = Self { points, least, corners: (0..points.len()).collect(), is_ear: Vec::new() };
        ring.is_ear = (0..points.len()).map(|k| ring.has_ear(k)).collect();
        ring
    }

    /// Cuts ear after ear. Where there is none, as in polygons that cross themselves, any corner is cut.
    fn cut(mut self) -> Vec<[usize; 3]> {
        let mut triangles = Vec::with_capacity(self.points.len() - 2);
        while self.corners.len() > 3 {
            let k = self.is_ear.iter().position(|is_ear| *is_ear).unwrap_or(1);
            triangles.push(self.around(k));
            self.corners.remove(k);
            self.is_ear.remove(k);
            // Only its neighbours may have become ears, or ceased to be some.
            let count = self.corners.len();
            for near in [(k + count - 1) % count, k % count] {
                self.is_ear[near] = self.has_ear(near);
            }
        }
        triangles.push([self.corners[0], self.corners[1], self.corners[2]]);
        triangles
    }

    /// Returns a corner with its neighbours.
    fn around(&self, k: usize) -> [usize; 3] {
        let count = self.corners.len();
        [self.corners[(k + count - 1) % count], self.corners[k], self.corners[(k + 1) % count]]
    }

    /// Returns whether a corner and its neighbours are a triangle with an area, in or on which there is no other corner.
    fn has_ear(&self, k: usize) -> bool {
        let [a, b, c] = self.around(k).map(|corner| self.points[corner]);
        let is_left = |from: DVec2, to: DVec2, point: DVec2| (to - from).perp_dot(point - from) >= -self.least;
        let is_within = |point: DVec2| is_left(a, b, point) && is_left(b, c, point) && is_left(c, a, point);
        let mut others = self.corners.iter().map(|corner| self.points[*corner]);
        (b - a).perp_dot(c - a) > self.least && !others.any(|point| ![a, b, c].contains(&point) && is_within(point))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Places a plane polygon aslant in space.
    fn aslant(points: &[[f64; 2]]) -> Vec<DVec3> {
        let (x, y) = DVec3::new(0.3, -0.5, 0.8).normalize().any_orthonormal_pair();
        points.iter().map(|[u, v]| DVec3::new(7.0, -2.0, 1.0) + x * *u + y * *v).collect()
    }

    /// Checks that triangles fill a polygon: each faces as it does, their areas add up to its own, and all corners are used.
    fn check(points: &[DVec3]) {
        let Cut { triangles, is_crossed } = cut(points).unwrap();
        let whole = area(points);
        let parts: Vec<f64> = triangles
            .iter()
            .map(|[a, b, c]| (points[*b] - points[*a]).cross(points[*c] - points[*a]).dot(whole.normalize()))
            .collect();
        assert!(!is_crossed && triangles.len() == points.len() - 2);
        assert!(parts.iter().all(|part| *part > 1e-9), "{triangles:?}: {parts:?}");
        assert!((parts.iter().sum::<f64>() - whole.length()).abs() < 1e-9 * whole.length(), "{triangles:?}");
        assert!((0..points.len()).all(|k| triangles.iter().flatten().any(|corner| *corner == k)), "{triangles:?}");
    }

    /// Checks a polygon from each of its corners on, and the other way round.
    fn check_all(points: &[[f64; 2]]) {
        let mut points = aslant(points);
        for _ in 0..2 {
            for _ in 0..points.len() {
                points.rotate_left(1);
                check(&points);
            }
            points.reverse();
        }
    }

    const L: [[f64; 2]; 6] = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];

    #[test]
    fn polygons_that_bend_inward_are_filled_and_no_more() {
        check_all(&L);
        check_all(&[[0.0, 0.0], [1.0, 0.3], [2.0, 0.0], [1.0, 3.0]]);
        // A comb, with many corners that bend inward.
        let teeth = (0..50).flat_map(|k| [[f64::from(k), 0.0], [f64::from(k) + 0.5, 5.0]]);
        check_all(&teeth.chain([[50.0, 0.0], [50.0, -1.0], [0.0, -1.0]]).collect::<Vec<_>>());
        // A frame: a square with a hole, to which a cut leads.
        let outer = [[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 3.0], [0.0, 0.0]];
        check_all(&[&outer[..], &[[1.0, 1.0], [1.0, 2.0], [2.0, 2.0], [2.0, 1.0], [1.0, 1.0]]].concat());
    }

    #[test]
    fn corners_on_straight_sides_make_no_triangle_without_area() {
        check_all(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 2.0], [0.0, 2.0], [0.0, 1.0]]);
    }

    #[test]
    fn convex_polygons_are_fans_and_crossed_ones_are_told() {
        let Cut { triangles, .. } =
            cut(&aslant(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 2.0], [0.0, 1.0]])).unwrap();
        assert_eq!(triangles, [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
        let crossed = cut(&aslant(&[[0.0, 0.0], [3.0, 0.0], [1.0, 2.0], [1.0, -1.0], [0.0, 2.0]])).unwrap();
        assert!(crossed.is_crossed && crossed.triangles.len() == 3);
        let bow = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
        assert!(
            cut(&bow).unwrap().is_crossed && !cut(&[bow[0], bow[1], bow[1] * 2.0, bow[1] * 3.0]).unwrap().is_crossed
        );
        // A star.
        let ray = |k: usize, angle: f64| (1 + k % 2) as f64 * DVec3::new(angle.cos(), angle.sin(), 0.0);
        let star = (0..MOST + 2).map(|k| ray(k, k as f64 * std::f64::consts::TAU / (MOST + 2) as f64));
        assert!(cut(&star.collect::<Vec<_>>()).is_err_and(|why| why.contains("4098 corners")));
        // A circle, whose coordinates are rounded as in files.
        let round = |angle: f64| DVec3::new((1e6 * angle.cos()).round(), (1e6 * angle.sin()).round(), 0.0);
        let circle: Vec<DVec3> = (0..2 * MOST).map(|k| round(k as f64 * std::f64::consts::PI / MOST as f64)).collect();
        assert_eq!(cut(&circle).unwrap().triangles.len(), 2 * MOST - 2);
    }
}
