use std::f64::consts::PI;

use super::Lens;
use super::arc_sine::{arc_sine, sine, twice};

/// Lens formula of a mirror ball: the angle from the direction back to the camera, with r = 1 at the ball's outline.
///
/// The ray at the angle α from the axis meets the ball (radius 1, centre at the distance D) at the angle of incidence
/// i, with sin i = D sin α, and leaves it at 2i − α from the direction back. The outline has sin α = 1/D, so tan α =
/// r/√(D² − 1). For a distant camera the angle becomes 2 asin r.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallLens {
    /// 1/D.
    nearness: f64,
}

impl BallLens {
    /// The ball as seen by a distant camera.
    pub const DISTANT: Self = Self { nearness: 0.0 };

    /// Returns the ball as seen from a distance to its centre, in ball radii; `None` unless the distance exceeds 1.
    pub fn from_distance(distance: f64) -> Option<Self> {
        (distance > 1.0).then(|| Self { nearness: distance.recip() })
    }

    /// Returns √(1 − 1/D²).
    fn cosine(&self) -> f64 {
        ((1.0 - self.nearness) * (1.0 + self.nearness)).sqrt()
    }
}

impl Lens for BallLens {
    fn angle(&self, radius: f64) -> (f64, f64) {
        // With n = 1/D and c = √(1 − n²): tan α = n r/c, and sin i = D sin α = r/√(c² + n² r²).
        let (n, c) = (self.nearness, self.cosine());
        let length2 = c * c + n * n * radius * radius;
        let length = length2.sqrt();
        let (incidence, slope) = arc_sine(radius / length);
        let alpha = (n * radius).atan2(c);
        // d sin i/dr = c²/length³, dα/dr = n c/length².
        (2.0 * incidence - alpha, 2.0 * slope * c * c / (length2 * length) - n * c / length2)
    }

    fn sin_cos(&self, radius: f64) -> (f64, f64) {
        let (n, c) = (self.nearness, self.cosine());
        let length = (c * c + n * n * radius * radius).sqrt();
        let (sin_alpha, cos_alpha) = (n * radius / length, c / length);
        let (sin, cos) = twice(sine(radius / length));
        (sin * cos_alpha - cos * sin_alpha, cos * cos_alpha + sin * sin_alpha)
    }

    /// Solves for the angle β at the ball's centre between the axis and the point that the ray meets. With i = α + β, φ
    /// = 2β + α and tan α = sin β/(D − cos β). Uses Newton's iteration on β.
    fn radius(&self, angle: f64) -> Option<f64> {
        let n = self.nearness;
        if angle > self.reach() {
            return None;
        }
        if n == 0.0 {
            return Some((angle / 2.0).sin());
        }
        let mut beta = angle / 2.0;
        for _ in 0..50 {
            let (sin, cos) = beta.sin_cos();
            let (across, along) = (n * sin, 1.0 - n * cos);
            let alpha = across.atan2(along);
            let slope = (n * cos - n * n) / (across * across + along * along);
            let step = (2.0 * beta + alpha - angle) / (2.0 + slope);
            beta -= step;
            if step.abs() <= 2.0 * f64::EPSILON * beta.abs() {
                break;
            }
        }
        let (sin, cos) = beta.sin_cos();
        Some(self.cosine() * sin / (1.0 - n * cos))
    }

    fn reach(&self) -> f64 {
        // All but the cone of directions that the ball hides from the camera.
        PI - self.nearness.asin()
    }

    fn has_steep_rim(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_that_are_traced_one_by_one() {
        for distance in [1.5f64, 3.0, 100.0] {
            let lens = BallLens::from_distance(distance).expect("outside the ball");
            for step in 0..100 {
                let radius = f64::from(step) / 100.0;
                // The camera at +D on the z axis looks along −z.
                let alpha = (radius / (distance * distance - 1.0).sqrt()).atan();
                let (dx, dz) = (alpha.sin(), -alpha.cos());
                let along = distance * alpha.cos() - (1.0 - (distance * alpha.sin()).powi(2)).max(0.0).sqrt();
                let (nx, nz) = (along * dx, distance + along * dz);
                let dot = dx * nx + dz * nz;
                let (rx, rz) = (dx - 2.0 * dot * nx, dz - 2.0 * dot * nz);
                let expected = rx.atan2(rz);
                let (angle, _) = lens.angle(radius);
                assert!((angle - expected).abs() < 1e-10, "{distance}, {radius}: {angle}, not {expected}");
                let back = lens.radius(angle).expect("seen");
                assert!((back - radius).abs() < 1e-12, "{distance}, {radius}: {back}");
            }
        }
    }

    #[test]
    fn a_near_ball_hides_what_is_behind_it() {
        let lens = BallLens::from_distance(2.0).expect("outside the ball");
        assert!((lens.reach().to_degrees() - 150.0).abs() < 1e-9);
        assert!(lens.radius(151f64.to_radians()).is_none());
        assert!((lens.radius(lens.reach()).expect("the rim") - 1.0).abs() < 1e-12);
        assert_eq!(BallLens::from_distance(1.0), None);
    }
}
