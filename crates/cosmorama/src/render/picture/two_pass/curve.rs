use glam::{DMat4, DVec4};

use super::knot::Knot;

/// Greatest distance of a pixel's place from its cubic, in texels.
const TOLERANCE: f64 = 0.01;

/// Intermediate function of a branch: the place along the first pass by the place along the second.
pub(super) struct Curve {
    /// Cubics, one after the other.
    pieces: Vec<Piece>,
    /// Lines before the first pixel and after the last: place along both passes, and slope.
    ends: [(f64, f64, f64); 2],
}

/// A cubic between two places along the second pass.
struct Piece {
    from: f64,
    to: f64,
    coefficients: DVec4,
}

impl Piece {
    /// Fits a cubic to places and slopes of pixels by least squares.
    fn fit(knots: &[Knot]) -> Option<Self> {
        let (from, to) = (knots.first()?.place.y, knots.last()?.place.y);
        let half = 0.5 * (to - from);
        let origin = knots.first()?.place.x;
        let (mut square, mut right) = (DMat4::ZERO, DVec4::ZERO);
        for knot in knots {
            let x = (knot.place.y - from) / half - 1.0;
            let equations = [
                (DVec4::new(1.0, x, x * x, x * x * x), knot.place.x - origin),
                (DVec4::new(0.0, 1.0, 2.0 * x, 3.0 * x * x), knot.shear * half),
            ];
            for (row, value) in equations {
                square += DMat4::from_cols(row * row.x, row * row.y, row * row.z, row * row.w);
                right += row * value;
            }
        }
        let coefficients = square.inverse() * right + DVec4::X * origin;
        coefficients.is_finite().then_some(Self { from, to, coefficients })
    }

    fn at(&self, place: f64) -> f64 {
        let x = 2.0 * (place - self.from) / (self.to - self.from) - 1.0;
        let [a, b, c, d] = self.coefficients.to_array();
        a + x * (b + x * (c + x * d))
    }

    /// Returns whether all pixels are near enough.
    fn suits(&self, knots: &[Knot]) -> bool {
        knots.iter().all(|knot| (self.at(knot.place.y) - knot.place.x).abs() <= TOLERANCE)
    }
}

impl Curve {
    /// Fits a curve to pixels in the order of their places along the second pass.
    pub(super) fn fit(knots: &[Knot]) -> Self {
        let mut pieces = Vec::new();
        add(knots, &mut pieces);
        let end = |knot: Option<&Knot>| knot.map_or((0.0, 0.0, 0.0), |knot| (knot.place.x, knot.place.y, knot.shear));
        Self { pieces, ends: [end(knots.first()), end(knots.last())] }
    }

    /// Returns the place along the first pass.
    pub(super) fn at(&self, place: f64) -> f64 {
        let [first, last] = self.ends;
        let straight = |(x, y, slope): (f64, f64, f64)| x + slope * (place - y);
        if place <= first.1 {
            return straight(first);
        }
        if place >= last.1 {
            return straight(last);
        }
        let piece = self.pieces.partition_point(|piece| piece.to < place);
        self.pieces.get(piece).map_or_else(|| straight(last), |piece| piece.at(place))
    }
}

/// Adds cubics for these pixels: one if it is near enough to all of them, else those of both halves, which share a pixel.
fn add(knots: &[Knot], pieces: &mut Vec<Piece>) {
    if knots.len() < 2 {
        return;
    }
    match Piece::fit(knots) {
        Some(piece) if knots.len() == 2 || piece.suits(knots) => pieces.push(piece),
        None if knots.len() == 2 => {}
        _ => {
            let middle = knots.len() / 2;
            add(&knots[..=middle], pieces);
            add(&knots[middle..], pieces);
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::filter::Passes;

    /// Places pixels on a function, unevenly.
    fn knots(function: impl Fn(f64) -> (f64, f64), count: usize) -> Vec<Knot> {
        let knot = |k: usize| {
            let along = 3.0 + 1.7 * k as f64 + 0.004 * (k * k) as f64;
            let (place, shear) = function(along);
            let units = DVec2::ONE;
            let place = DVec2::new(place, along);
            Knot::new(k, &Passes { place, follows_columns: true, columns_first: false, step: 1.7, units, shear })
        };
        (0..count).map(knot).collect()
    }

    #[test]
    fn a_cubic_is_one_piece_and_exact() {
        let function = |y: f64| (0.3 + 0.8 * y - 2e-3 * y * y + 1e-5 * y * y * y, 0.8 - 4e-3 * y + 3e-5 * y * y);
        let curve = Curve::fit(&knots(function, 80));
        assert_eq!(curve.pieces.len(), 1);
        for k in 0..100 {
            let y = 4.0 + 1.3 * f64::from(k);
            assert!((curve.at(y) - function(y).0).abs() < 1e-9, "{y}");
        }
    }

    #[test]
    fn other_functions_are_met_within_the_tolerance_between_pixels_too() {
        let function = |y: f64| (200.0 - 90.0 * (y / 60.0).cos(), 1.5 * (y / 60.0).sin());
        let curve = Curve::fit(&knots(function, 80));
        assert!((2..20).contains(&curve.pieces.len()), "{}", curve.pieces.len());
        for k in 0..1300 {
            let y = 3.0 + 0.1 * f64::from(k);
            assert!((curve.at(y) - function(y).0).abs() < 1.5 * TOLERANCE, "{y}");
        }
    }

    #[test]
    fn beyond_its_ends_it_is_straight() {
        let function = |y: f64| (7.0 + 0.5 * y + 0.01 * y * y, 0.5 + 0.02 * y);
        let all = knots(function, 10);
        let (first, last) = (all[0], all[9]);
        let curve = Curve::fit(&all);
        assert!((curve.at(first.place.y - 2.0) - (first.place.x - 2.0 * first.shear)).abs() < 1e-12);
        assert!((curve.at(last.place.y + 2.0) - (last.place.x + 2.0 * last.shear)).abs() < 1e-12);
        let alone = Curve::fit(&all[..1]);
        assert!((alone.at(5.0) - (first.place.x + (5.0 - first.place.y) * first.shear)).abs() < 1e-12);
    }
}
