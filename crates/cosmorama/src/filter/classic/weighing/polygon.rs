use std::ops::RangeInclusive;

use glam::DVec2;

/// Greatest number of corners of a quadrilateral that a square has cut.
const MOST: usize = 16;

/// A polygon of few corners.
#[derive(Clone, Copy)]
struct Polygon {
    corners: [DVec2; MOST],
    count: usize,
}

impl Polygon {
    fn push(&mut self, corner: DVec2) {
        if let Some(into) = self.corners.get_mut(self.count) {
            *into = corner;
            self.count += 1;
        }
    }

    /// Returns the part where `inside` is not negative, along a straight line (Sutherland & Hodgman 1974).
    fn cut(&self, inside: impl Fn(DVec2) -> f64) -> Self {
        let mut cut = Self { corners: [DVec2::ZERO; MOST], count: 0 };
        for k in 0..self.count {
            let (from, to) = (self.corners[k], self.corners[(k + 1) % self.count]);
            let (a, b) = (inside(from), inside(to));
            if a >= 0.0 {
                cut.push(from);
            }
            if (a < 0.0) != (b < 0.0) {
                cut.push(from + (to - from) * (a / (a - b)));
            }
        }
        cut
    }

    fn area(&self) -> f64 {
        let twice = |k: usize| self.corners[k].perp_dot(self.corners[(k + 1) % self.count]);
        0.5 * (0..self.count).map(twice).sum::<f64>().abs()
    }
}

/// Returns the area of a quadrilateral in the unit square that begins at `first`.
pub(in crate::filter::classic) fn area_in_square(corners: [DVec2; 4], first: DVec2) -> f64 {
    let mut polygon = Polygon { corners: [DVec2::ZERO; MOST], count: 0 };
    corners.into_iter().for_each(|corner| polygon.push(corner - first));
    let sides: [fn(DVec2) -> f64; 4] = [|at| at.x, |at| 1.0 - at.x, |at| at.y, |at| 1.0 - at.y];
    sides.into_iter().fold(polygon, |polygon, inside| polygon.cut(inside)).area()
}

/// Returns the columns of a row whose texels have their centres in a quadrilateral.
pub(in crate::filter::classic) fn columns_at(corners: [DVec2; 4], row: i64) -> RangeInclusive<i64> {
    let y = row as f64 + 0.5;
    let (mut from, mut to) = (f64::INFINITY, f64::NEG_INFINITY);
    for (a, b) in (0..4).map(|k| (corners[k], corners[(k + 1) % 4])) {
        if (a.y < y) != (b.y < y) {
            let x = a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y);
            (from, to) = (from.min(x), to.max(x));
        }
    }
    (from - 0.5).ceil() as i64..=(to - 0.5).floor() as i64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Parallelograms of all shapes, with their areas.
    fn parallelograms() -> impl Iterator<Item = ([DVec2; 4], f64)> {
        (0..50).map(|k| {
            let angle = 0.37 * f64::from(k);
            let (x, y) = (DVec2::from_angle(angle) * 1.7, DVec2::from_angle(angle + 1.1) * 0.4 * f64::from(k % 7 + 1));
            let middle = DVec2::new(5.2 + 0.13 * f64::from(k), 6.7);
            ([-x - y, x - y, x + y, y - x].map(|corner| middle + corner * 0.5), x.perp_dot(y).abs())
        })
    }

    fn squares() -> impl Iterator<Item = DVec2> {
        (0..400).map(|at| DVec2::new(f64::from(at % 20), f64::from(at / 20)))
    }

    #[test]
    fn areas_in_squares_add_to_the_whole() {
        for (corners, area) in parallelograms() {
            let sum: f64 = squares().map(|first| area_in_square(corners, first)).sum();
            assert!((sum - area).abs() < 1e-12, "{corners:?}: {sum}");
        }
    }

    #[test]
    fn a_turned_square_covers_half_of_a_square_through_its_corners() {
        let corners = [(0.5, 0.0), (1.0, 0.5), (0.5, 1.0), (0.0, 0.5)].map(|(x, y)| DVec2::new(x, y));
        assert!((area_in_square(corners, DVec2::ZERO) - 0.5).abs() < 1e-15);
    }

    #[test]
    fn rows_hold_the_centres_that_are_inside() {
        for (corners, _) in parallelograms() {
            for first in squares() {
                let centre = first + DVec2::splat(0.5);
                let turns = (0..4).map(|k| (corners[(k + 1) % 4] - corners[k]).perp_dot(centre - corners[k]));
                let is_inside = turns.clone().all(|turn| turn > 0.0) || turns.clone().all(|turn| turn < 0.0);
                assert_eq!(columns_at(corners, first.y as i64).contains(&(first.x as i64)), is_inside, "{corners:?}");
            }
        }
    }
}
