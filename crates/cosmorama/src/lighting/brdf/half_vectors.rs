use std::f64::consts::FRAC_PI_2;

use super::gauss::GaussRule;

/// Direction of view, in the plane of x and z; the normal is z.
#[derive(Clone, Copy, Debug)]
pub(super) struct ViewAngle {
    /// n·v.
    pub(super) cos: f64,
    /// Sine of the same angle.
    pub(super) sin: f64,
}

impl ViewAngle {
    pub(super) fn new(cos: f64) -> Self {
        Self { cos, sin: ((1.0 - cos) * (1.0 + cos)).max(0.0).sqrt() }
    }

    /// Visits azimuths φ of the half vector: the cosine, the steepest slope, and the weight of both sides together.
    ///
    /// A half vector of slope s = tan θh sends light from above the surface while s² − 2ks − 1 < 0, with k = tan θv cos φ; hence
    /// s < k + √(k² + 1). At grazing angles this bound steps about φ = 90°, over a width of cot θv. Nodes are spread from there by a
    /// sinh (P. R. Johnston and D. Elliott, *A sinh transformation for evaluating nearly singular boundary element
    /// integrals*, Int. J. Numer. Meth. Engng 62, 2005).
    pub(super) fn azimuths(self, rule: &GaussRule) -> impl Iterator<Item = Azimuth> {
        let width = (self.cos / self.sin.max(LEAST)).max(LEAST);
        let stretch = (FRAC_PI_2 / width).asinh();
        rule.nodes().map(move |(x, weight)| {
            let y = (2.0 * x - 1.0) * stretch;
            let cos = (FRAC_PI_2 + width * y.sinh()).cos();
            let k = self.sin / self.cos * cos;
            let root = (k * k + 1.0).sqrt();
            // Without cancellation on the far side.
            let steepest = if k > 0.0 { k + root } else { 1.0 / (root - k) };
            // Both nodes and sides count twice.
            Azimuth { cos, steepest, weight: 4.0 * weight * stretch * width * y.cosh() }
        })
    }
}

/// Sine below which a direction of view is the normal.
const LEAST: f64 = 1e-9;

/// Azimuth of half vectors.
#[derive(Clone, Copy, Debug)]
pub(super) struct Azimuth {
    /// Cosine of the azimuth from that of the view.
    pub(super) cos: f64,
    /// Slope at which reflected light would come from the horizon.
    pub(super) steepest: f64,
    /// Weight dφ, of this azimuth and its mirror image.
    pub(super) weight: f64,
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn azimuths_go_all_around() {
        let rule = GaussRule::new(24);
        for cos in [5e-4, 0.1, 0.7, 1.0] {
            let around: f64 = ViewAngle::new(cos).azimuths(&rule).map(|azimuth| azimuth.weight).sum();
            assert!((around / (2.0 * PI) - 1.0).abs() < 1e-6, "{cos}: {around}");
        }
    }
}
