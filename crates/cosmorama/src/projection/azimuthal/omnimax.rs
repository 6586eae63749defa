use super::Lens;

/// The Omnimax lens (Max 1983; Greene & Heckbert 1986, "Omnimax projection"):
/// φ(r) = 1.411269 r − 0.094389 r³ + 0.25674 r⁵ radians, r = 1 at the limiting circle.
///
/// ```
/// use cosmorama::projection::azimuthal::{Lens, OmnimaxLens};
/// let (rim, _) = OmnimaxLens.angle(1.0);
/// assert!((rim.to_degrees() - 90.162).abs() < 1e-3);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OmnimaxLens;

const C1: f64 = 1.411269;
const C3: f64 = -0.094389;
const C5: f64 = 0.25674;

impl Lens for OmnimaxLens {
    fn angle(&self, radius: f64) -> (f64, f64) {
        let r2 = radius * radius;
        (radius * (C1 + r2 * (C3 + r2 * C5)), C1 + r2 * (3.0 * C3 + r2 * 5.0 * C5))
    }

    /// Uses Newton's iteration. φ is concave up to r = 0.33 and convex after it, and φ′ is at least 1.36. From this
    /// start the iteration therefore converges quadratically for every angle up to 180°.
    fn radius(&self, angle: f64) -> Option<f64> {
        let mut radius = angle / C1;
        for _ in 0..20 {
            let (found, slope) = self.angle(radius);
            let step = (found - angle) / slope;
            radius -= step;
            if step.abs() <= 2.0 * f64::EPSILON * radius.abs() {
                break;
            }
        }
        Some(radius)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_of_the_paper() {
        let (rim, slope) = OmnimaxLens.angle(1.0);
        assert!((rim.to_degrees() - 90.162).abs() < 5e-4);
        assert!((slope.to_degrees() - 138.2).abs() < 0.05);
        let middle = OmnimaxLens.radius(45f64.to_radians()).expect("45° is in the lens");
        assert!((middle - 0.558290).abs() < 5e-7, "{middle}");
        let right_angle = OmnimaxLens.radius(90f64.to_radians()).expect("90° is in the lens");
        assert!((right_angle - 0.998828).abs() < 5e-7, "{right_angle}");
    }

    #[test]
    fn inverse_is_exact_to_double_precision() {
        for step in 0..=2000 {
            let angle = std::f64::consts::PI * f64::from(step) / 2000.0;
            let radius = OmnimaxLens.radius(angle).expect("every angle has a radius");
            let (back, _) = OmnimaxLens.angle(radius);
            assert!((back - angle).abs() <= 4.0 * f64::EPSILON * angle, "{angle}: {back}");
        }
    }
}
