use std::f64::consts::FRAC_PI_2;

use super::albedo::Albedo;
use super::gauss::GaussRule;
use super::half_vectors::{Azimuth, ViewAngle};

/// Quadrature of the albedo of microfacets with the GGX distribution and Smith's height-correlated shadowing.
///
/// For a view v, light l and half vector h, with F the Fresnel factor, the reflected part of white light is
///
/// ∫ F D(h) G2(v, l) / (4 n·v n·l) · n·l dω_l = ∫ F D(h) G2 (v·h) / (n·v) dω_h, as dω_l = 4 (v·h) dω_h.
///
/// Heitz's stretch of normals by 1/α makes D constant: with m the stretched h, and V the view stretched by α and
/// normalised, D(h) (v·h) / (n·v) · G1(v) dω_h = (m·V) dω_m / (π/2 (1 + V_z)). So the integral is that of F · G2/G1
/// over the hemisphere of m, weighted so that it is 1 without shadowing (E. Heitz, *Understanding the Masking-Shadowing Function in
/// Microfacet-Based BRDFs*, JCGT 3(2), 2014; *Sampling the GGX Distribution of Visible Normals*, JCGT 7(4), 2018). Height-correlated
/// G2/G1 = (1 + Λ(v)) / (1 + Λ(v) + Λ(l)), Λ = (√(1 + α² tan²θ) − 1)/2 (Walter et al. 2007 have D and Λ).
///
/// Half vectors are taken by slope: s = α sinh y resolves those near the normal, of slope α, and far ones, of slope 1.
/// Nodes crowd towards the bound, where light is shadowed within a layer as thin as α.
pub(super) struct GgxQuadrature {
    around: GaussRule,
    slopes: GaussRule,
}

impl GgxQuadrature {
    /// Prepares a rule of so many azimuths and slopes.
    pub(super) fn new(around: usize, slopes: usize) -> Self {
        Self { around: GaussRule::new(around), slopes: GaussRule::new(slopes) }
    }

    /// Computes the albedo.
    pub(super) fn albedo(&self, n_dot_v: f64, alpha: f64) -> Albedo {
        let view = ViewAngle::new(n_dot_v);
        let stretched = (alpha * view.sin).hypot(view.cos);
        let facets = Facets {
            view,
            alpha,
            stretched: [alpha * view.sin / stretched, view.cos / stretched],
            masked: 1.0 + smith(alpha, view.cos),
        };
        let mut sum = Albedo { scale: 0.0, bias: 0.0 };
        for azimuth in view.azimuths(&self.around) {
            let farthest = (azimuth.steepest / alpha).asinh();
            for (x, weight) in self.slopes.nodes() {
                let [all, grazing] = facets.reflected(azimuth, farthest * x * (2.0 - x));
                let weight = azimuth.weight * weight * farthest * 2.0 * (1.0 - x);
                sum.scale += weight * (all - grazing);
                sum.bias += weight * grazing;
            }
        }
        sum
    }
}

/// Facets seen from one direction.
struct Facets {
    view: ViewAngle,
    alpha: f64,
    /// x and z of the stretched view.
    stretched: [f64; 2],
    /// 1 + Λ(v).
    masked: f64,
}

impl Facets {
    /// Returns the integrand for the half vector of slope α sinh y, by dy dφ, for F of 1 and for Schlick's (1 − v·h)⁵.
    #[inline(always)]
    fn reflected(&self, azimuth: Azimuth, y: f64) -> [f64; 2] {
        let Self { view, alpha, stretched: [x, z], masked } = self;
        let tan = y.sinh();
        let cos = (1.0 + tan * tan).sqrt().recip();
        let slope = alpha * tan;
        let upright = (1.0 + slope * slope).sqrt().recip();
        let v_dot_h = upright * (view.sin * slope * azimuth.cos + view.cos);
        let n_dot_l = (2.0 * v_dot_h * upright - view.cos).max(f64::MIN_POSITIVE);
        // dω_m = sin θ dθ dφ, dθ = cos θ dy: tan θ is sinh y.
        let area = tan * cos * cos;
        let visible = cos * (x * tan * azimuth.cos + z) / (FRAC_PI_2 * (1.0 + z));
        let all = visible * area * masked / (masked + smith(*alpha, n_dot_l));
        let off = (1.0 - v_dot_h).clamp(0.0, 1.0);
        [all, all * off * off * off * off * off]
    }
}

/// Returns Smith's Λ of a direction, by the cosine of its angle from the normal.
#[inline(always)]
fn smith(alpha: f64, cos: f64) -> f64 {
    let cos_squared = cos * cos;
    0.5 * ((1.0 + alpha * alpha * (1.0 - cos_squared).max(0.0) / cos_squared).sqrt() - 1.0)
}
