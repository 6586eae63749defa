use std::f64::consts::PI;

use super::gauss::GaussRule;
use super::half_vectors::{Azimuth, ViewAngle};

/// Quadrature of the albedo of cloth: the distribution Charlie, D = (2 + 1/α) sin^(1/α) θh / 2π (A. C. Estevez and C. Kulla, *Production
/// Friendly Microfacet Sheen BRDF*, SIGGRAPH 2017 courses), with the visibility V = 1 / (4 (n·l + n·v − n·l n·v)) of Neubelt & Pettineo
/// (*Crafting a Next-Gen Material Pipeline for The Order: 1886*, 2013), as Filament and glTF's tables have it.
///
/// With m = 1/α the albedo is ∫ D V n·l · 4 (v·h) dω_h over half vectors that send light from above the surface: sin θh below its bound S. With
/// u = (sin θh / S)^(m+2), D dω_h = S^(m+2)/2π · du dφ / cos θh: the peak at grazing half vectors is gone. What is left is steep at
/// both ends of u; nodes crowd there.
pub(super) struct CharlieQuadrature {
    around: GaussRule,
    slopes: GaussRule,
}

impl CharlieQuadrature {
    /// Prepares a rule of so many azimuths and slopes.
    pub(super) fn new(around: usize, slopes: usize) -> Self {
        Self { around: GaussRule::new(around), slopes: GaussRule::new(slopes) }
    }

    /// Computes the albedo.
    pub(super) fn albedo(&self, n_dot_v: f64, alpha: f64) -> f64 {
        let view = ViewAngle::new(n_dot_v);
        let power = 2.0 + alpha.recip();
        let mut sum = 0.0;
        for azimuth in view.azimuths(&self.around) {
            // ln S² = −ln(1 + 1/s²), and cos² at the bound.
            let log = -azimuth.steepest.powi(-2).ln_1p();
            let level = 1.0 / (1.0 + azimuth.steepest * azimuth.steepest);
            let density = azimuth.weight * (0.5 * power * log).exp() / (2.0 * PI);
            for (x, weight) in self.slopes.nodes() {
                // u = x³/(x³ + (1−x)³).
                let (low, high) = (x * x * x, (1.0 - x) * (1.0 - x) * (1.0 - x));
                let both = low + high;
                let slope = 3.0 * x * x * (1.0 - x) * (1.0 - x) / (both * both);
                // sin² = S² u^(2/(m+2)); its distance from S² without cancellation.
                let fall = 2.0 / power * (-high / both).ln_1p();
                let sin_squared = (log + fall).exp();
                let cos = (level - log.exp() * fall.exp_m1()).sqrt();
                sum += density * weight * slope * reflected(view, azimuth, [sin_squared.sqrt(), cos]);
            }
        }
        sum
    }
}

/// Returns V n·l 4 (v·h) / cos θh for a half vector.
fn reflected(view: ViewAngle, azimuth: Azimuth, [sin, cos]: [f64; 2]) -> f64 {
    let v_dot_h = view.sin * sin * azimuth.cos + view.cos * cos;
    let n_dot_l = (2.0 * v_dot_h * cos - view.cos).max(0.0);
    v_dot_h * n_dot_l / (n_dot_l + view.cos - n_dot_l * view.cos) / cos
}
