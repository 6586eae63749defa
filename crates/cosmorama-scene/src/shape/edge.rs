//! The part of a pixel that a shape with a smooth outline covers.

/// An outline near a pixel: how far the pixel's centre lies outside, and how that changes along the pixel's sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Edge {
    /// Distance of the centre from the outline, negative inside.
    pub(crate) gap: f64,
    /// Change of the distance along the whole of each side.
    pub(crate) slope: [f64; 2],
}

impl Edge {
    /// Returns the greatest difference of the distance from that at the centre.
    fn reach(&self) -> f64 {
        0.5 * (self.slope[0].abs() + self.slope[1].abs())
    }

    /// Returns the covered part of the pixel's area: what a straight line cuts off a square.
    pub(crate) fn coverage(&self) -> f64 {
        let [a, b] = self.slope.map(f64::abs);
        let (long, short) = (a.max(b), a.min(b));
        let (depth, reach, flat) = (-self.gap, self.reach(), 0.5 * (long - short));
        if depth.abs() >= reach {
            return if depth > 0.0 { 1.0 } else { 0.0 };
        }
        if depth.abs() <= flat {
            return 0.5 + depth / long;
        }
        let corner = (reach - depth.abs()).powi(2) / (2.0 * long * short);
        if depth > 0.0 { 1.0 - corner } else { corner }
    }

    /// Returns the offset from the centre, in parts of the pixel, to the middle of what is covered.
    pub(crate) fn middle(&self) -> [f64; 2] {
        let deepest = -self.gap + self.reach();
        let towards = -0.5 * deepest - self.gap;
        let square = self.slope[0].powi(2) + self.slope[1].powi(2);
        if square > 0.0 { self.slope.map(|slope| slope * towards / square) } else { [0.0; 2] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coverage_is_that_of_many_samples() {
        const SIDE: usize = 400;
        for k in 0..40 {
            let (sin, cos) = (0.37 * f64::from(k)).sin_cos();
            let edge = Edge { gap: 0.6 * (f64::from(k) * 1.3).sin(), slope: [sin, cos * 0.8] };
            let at = |k: usize| (k as f64 + 0.5) / SIDE as f64 - 0.5;
            let inside = |s: f64, t: f64| edge.gap + edge.slope[0] * s + edge.slope[1] * t < 0.0;
            let count = (0..SIDE * SIDE).filter(|k| inside(at(k % SIDE), at(k / SIDE))).count();
            let expected = count as f64 / (SIDE * SIDE) as f64;
            assert!((edge.coverage() - expected).abs() < 3e-3, "{edge:?}: {} for {expected}", edge.coverage());
            let [s, t] = edge.middle();
            assert!(expected == 0.0 || inside(s, t), "{edge:?}");
        }
    }
}
