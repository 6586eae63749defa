use glam::DVec2;

use super::region::{Region, Seen};

/// Exact areas of texels under a pixel's parallelogram, evenly weighted: a box filter (Catmull 1974; Catmull & Smith
/// 1980 call it area averaging).
///
/// Catmull's quadrilateral has any corners. A footprint tells the derivatives alone, so that here it is a parallelogram.
pub(super) struct Catmull;

/// Corners of a polygon that a square may have cut: four, and one more for each side of the square.
const MOST: usize = 8;

impl Region for Catmull {
    fn texels(&self, seen: &Seen, mut visit: impl FnMut([i64; 2], f64)) {
        let [x, y] = [seen.jacobian.x_axis * 0.5, seen.jacobian.y_axis * 0.5];
        let corners = [-x - y, x - y, x + y, y - x].map(|corner| corner + seen.place);
        let within = seen.texels_within(seen.half_box());
        for j in within.rows {
            for i in within.columns.clone() {
                let area = area_in_square(corners, DVec2::new(i as f64, j as f64));
                if area > 0.0 {
                    visit([i, j], area);
                }
            }
        }
    }
}

/// A convex polygon of few corners.
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
fn area_in_square(corners: [DVec2; 4], first: DVec2) -> f64 {
    let mut polygon = Polygon { corners: [DVec2::ZERO; MOST], count: 0 };
    corners.into_iter().for_each(|corner| polygon.push(corner - first));
    let sides: [fn(DVec2) -> f64; 4] = [|at| at.x, |at| 1.0 - at.x, |at| at.y, |at| 1.0 - at.y];
    sides.into_iter().fold(polygon, |polygon, inside| polygon.cut(inside)).area()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_in_squares_add_to_the_whole() {
        for k in 0..50 {
            let angle = 0.37 * f64::from(k);
            let (x, y) = (DVec2::from_angle(angle) * 1.7, DVec2::from_angle(angle + 1.1) * 0.4 * f64::from(k % 7 + 1));
            let middle = DVec2::new(5.2 + 0.13 * f64::from(k), 6.7);
            let corners = [-x - y, x - y, x + y, y - x].map(|corner| middle + corner * 0.5);
            let sum: f64 =
                (0..400).map(|at| area_in_square(corners, DVec2::new((at % 20) as f64, (at / 20) as f64))).sum();
            assert!((sum - x.perp_dot(y).abs()).abs() < 1e-12, "{k}: {sum}");
        }
    }

    #[test]
    fn a_turned_square_covers_half_of_a_square_through_its_corners() {
        let corners = [(0.5, 0.0), (1.0, 0.5), (0.5, 1.0), (0.0, 0.5)].map(|(x, y)| DVec2::new(x, y));
        assert!((area_in_square(corners, DVec2::ZERO) - 0.5).abs() < 1e-15);
    }
}
