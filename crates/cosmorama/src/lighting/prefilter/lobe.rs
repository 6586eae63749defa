use std::f64::consts::PI;

use thiserror::Error;

/// Weight of the light from each direction by its angle θ from an axis: what turns a world into a map of its light.
///
/// Lobes are round about their axis and end at the horizon, θ = 90°. In those with a half vector, the axis is normal, view and
/// mirror direction at once (N = V = R, as in prefiltered maps), so that the half vector lies at θ/2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lobe {
    shape: Shape,
    /// ∫ weight dω.
    integral: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Shape {
    Lambert,
    Phong { exponent: f64 },
    Blinn { exponent: f64 },
    Ggx { alpha: f64 },
    Charlie { alpha: f64 },
}

/// Reason why there is no such lobe.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum LobeError {
    /// The roughness is outside its range.
    #[error("a roughness α of {0} is outside {SMOOTHEST} to 1")]
    Alpha(f64),
    /// The exponent is outside its range.
    #[error("an exponent of {0} is outside 0 to {SHARPEST}")]
    Exponent(f64),
}

/// Least roughness α. A smoother lobe is narrower than any texel.
pub const SMOOTHEST: f64 = 1e-3;

/// Largest exponent. A sharper lobe is narrower than any texel.
pub const SHARPEST: f64 = 1e6;

impl Lobe {
    /// Lambert's cosine, of a matt surface (Greene 1986, section 5; Miller & Hoffman 1984): cos θ.
    pub const LAMBERT: Self = Self { shape: Shape::Lambert, integral: PI };

    /// Returns Phong's lobe about the mirror direction (Phong 1975): cosⁿ θ.
    ///
    /// # Errors
    /// When the exponent is outside 0 to [`SHARPEST`].
    pub fn phong(exponent: f64) -> Result<Self, LobeError> {
        check_exponent(exponent)?;
        Ok(Self { shape: Shape::Phong { exponent }, integral: 2.0 * PI / (exponent + 1.0) })
    }

    /// Returns Blinn's lobe (Blinn 1977): cosⁿ(θ/2) · cos θ.
    ///
    /// # Errors
    /// When the exponent is outside 0 to [`SHARPEST`].
    pub fn blinn(exponent: f64) -> Result<Self, LobeError> {
        check_exponent(exponent)?;
        // With w = (1 + t)/2 = cos²(θ/2) the integrand is a polynomial in w, from ½ to 1.
        let power = exponent / 2.0;
        let primitive = |w: f64| 2.0 * w.powf(power + 2.0) / (power + 2.0) - w.powf(power + 1.0) / (power + 1.0);
        let integral = 4.0 * PI * (primitive(1.0) - primitive(0.5));
        Ok(Self { shape: Shape::Blinn { exponent }, integral })
    }

    /// Returns the GGX lobe (Walter et al. 2007) as prefiltered maps use it (Karis 2013): D(h) · (n·l). α is the square
    /// of what most programs call roughness.
    ///
    /// With α = 1 it is Lambert's.
    ///
    /// # Errors
    /// When α is outside [`SMOOTHEST`] to 1.
    pub fn ggx(alpha: f64) -> Result<Self, LobeError> {
        check_alpha(alpha)?;
        // ∫ t / (a + b t)² dt from 0 to 1, with x = b/a: (ln(1 + x) − x/(1 + x)) / b².
        let (a, b) = (0.5 + 0.5 * alpha * alpha, 0.5 * alpha * alpha - 0.5);
        let x = b / a;
        let part = if x == 0.0 {
            0.5
        } else if x.abs() < 1e-2 {
            // The series of the logarithm, of which the first terms cancel.
            (2..9).map(|k| f64::from(k - 1) / f64::from(k) * (-x).powi(k)).sum::<f64>() / (x * x)
        } else {
            (x.ln_1p() - x / (1.0 + x)) / (x * x)
        };
        Ok(Self { shape: Shape::Ggx { alpha }, integral: 2.0 * PI * part / (a * a) })
    }

    /// Returns the lobe of cloth (Estevez & Kulla 2017): sin^(1/α)(θ/2) · cos θ.
    ///
    /// # Errors
    /// When α is outside [`SMOOTHEST`] to 1.
    pub fn charlie(alpha: f64) -> Result<Self, LobeError> {
        check_alpha(alpha)?;
        // The weight is divided by its value at the horizon, which for small α is less than any number.
        let power = 0.5 / alpha;
        Ok(Self { shape: Shape::Charlie { alpha }, integral: 2.0 * PI / ((power + 1.0) * (power + 2.0)) })
    }

    /// Returns the weight at an angle from the axis, given by its cosine: zero behind the horizon. It is not normalised.
    pub fn weight(&self, cosine: f64) -> f64 {
        self.weight_off_axis(1.0 - cosine)
    }

    /// Returns the weight where 1 − cos θ is so much. Near the axis that is exact where the cosine is not.
    pub(super) fn weight_off_axis(&self, s: f64) -> f64 {
        self.visit(At(s))
    }

    /// Returns the roughness α; `None` for lobes that have an exponent.
    pub fn alpha(&self) -> Option<f64> {
        match self.shape {
            Shape::Ggx { alpha } | Shape::Charlie { alpha } => Some(alpha),
            Shape::Lambert | Shape::Phong { .. } | Shape::Blinn { .. } => None,
        }
    }

    /// Returns the integral of the weight over all directions, in steradians.
    pub fn integral(&self) -> f64 {
        self.integral
    }

    /// Calls a visitor with the lobe's formula, compiled for each of them.
    pub(crate) fn visit<V: VisitWeight>(&self, visitor: V) -> V::Output {
        match self.shape {
            Shape::Lambert => visitor.visit(Lambert),
            Shape::Ggx { alpha } => visitor.visit(Ggx { square: alpha * alpha, rise: 0.5 - 0.5 * alpha * alpha }),
            Shape::Phong { exponent } => visitor.visit(Power { of_cosine: exponent, ..Power::ONE }),
            Shape::Blinn { exponent } => visitor.visit(Power { of_far: exponent / 2.0, of_cosine: 1.0, ..Power::ONE }),
            Shape::Charlie { alpha } => visitor.visit(Power { of_near: 0.5 / alpha, of_cosine: 1.0, ..Power::ONE }),
        }
    }
}

/// A lobe's formula as a function of s = 1 − cos θ, from 0 to 2. Near the axis, s is exact where the cosine is not.
pub(crate) trait Weight: Copy + Send + Sync {
    /// Returns the weight in single precision.
    fn single(self, s: f32) -> f32;

    /// Returns the weight in double precision.
    fn double(self, s: f64) -> f64;

    /// Returns the slope −dweight/ds just before the horizon, where it becomes zero.
    fn kink(self) -> f32;
}

/// Receiver of a lobe's formula.
pub(crate) trait VisitWeight {
    type Output;

    fn visit<W: Weight>(self, weight: W) -> Self::Output;
}

/// Asks for one weight.
struct At(f64);

impl VisitWeight for At {
    type Output = f64;

    fn visit<W: Weight>(self, weight: W) -> f64 {
        weight.double(self.0)
    }
}

#[derive(Clone, Copy)]
struct Lambert;

impl Weight for Lambert {
    #[inline(always)]
    fn single(self, s: f32) -> f32 {
        (1.0 - s).max(0.0)
    }

    #[inline(always)]
    fn double(self, s: f64) -> f64 {
        (1.0 - s).max(0.0)
    }

    fn kink(self) -> f32 {
        1.0
    }
}

/// D(h) is proportional to 1/u², where u = 1 + (α² − 1)(n·h)² = α² + (1 − α²) s/2, since (n·h)² = 1 − s/2.
#[derive(Clone, Copy)]
struct Ggx {
    /// α².
    square: f64,
    /// (1 − α²)/2.
    rise: f64,
}

impl Weight for Ggx {
    #[inline(always)]
    fn single(self, s: f32) -> f32 {
        let u = self.square as f32 + self.rise as f32 * s;
        (1.0 - s).max(0.0) / (u * u)
    }

    #[inline(always)]
    fn double(self, s: f64) -> f64 {
        let u = self.square + self.rise * s;
        (1.0 - s).max(0.0) / (u * u)
    }

    fn kink(self) -> f32 {
        (self.square + self.rise).powi(-2) as f32
    }
}

/// Powers of cos θ, of 2 sin²(θ/2) = s and of cos²(θ/2) = 1 − s/2.
#[derive(Clone, Copy)]
struct Power {
    of_cosine: f64,
    of_near: f64,
    of_far: f64,
}

impl Power {
    const ONE: Self = Self { of_cosine: 0.0, of_near: 0.0, of_far: 0.0 };
}

impl Weight for Power {
    #[inline(always)]
    fn single(self, s: f32) -> f32 {
        self.double(f64::from(s)) as f32
    }

    #[inline(always)]
    fn double(self, s: f64) -> f64 {
        if s >= 1.0 {
            return 0.0;
        }
        let s = s.max(0.0);
        let factor = |base: f64, power: f64| if power == 0.0 { 1.0 } else { base.powf(power) };
        factor(1.0 - s, self.of_cosine) * factor(s, self.of_near) * factor(1.0 - 0.5 * s, self.of_far)
    }

    fn kink(self) -> f32 {
        const BEFORE: f64 = 0.01;
        (self.double(1.0 - BEFORE) / BEFORE) as f32
    }
}

fn check_alpha(alpha: f64) -> Result<(), LobeError> {
    if (SMOOTHEST..=1.0).contains(&alpha) { Ok(()) } else { Err(LobeError::Alpha(alpha)) }
}

fn check_exponent(exponent: f64) -> Result<(), LobeError> {
    if (0.0..=SHARPEST).contains(&exponent) { Ok(()) } else { Err(LobeError::Exponent(exponent)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all() -> Vec<Lobe> {
        let alphas = [0.05, 0.1, 0.25, 0.5, 0.995, 1.0];
        let exponents = [0.0, 1.0, 16.0, 64.0, 1000.0];
        let ggx = alphas.map(|alpha| Lobe::ggx(alpha).expect("in range"));
        let charlie = alphas.map(|alpha| Lobe::charlie(alpha).expect("in range"));
        let phong = exponents.map(|exponent| Lobe::phong(exponent).expect("in range"));
        let blinn = exponents.map(|exponent| Lobe::blinn(exponent).expect("in range"));
        [Lobe::LAMBERT].into_iter().chain(ggx).chain(charlie).chain(phong).chain(blinn).collect()
    }

    #[test]
    fn integrals_are_those_of_the_weights() {
        const STEPS: usize = 1_000_000;
        for lobe in all() {
            let step = 0.5 * PI / STEPS as f64;
            let at = |k: usize| (k as f64 + 0.5) * step;
            let sum: f64 = (0..STEPS).map(|k| lobe.weight(at(k).cos()) * at(k).sin()).sum();
            let found = 2.0 * PI * step * sum;
            assert!((found / lobe.integral() - 1.0).abs() < 1e-8, "{lobe:?}: {found}");
        }
    }

    #[test]
    fn weights_follow_their_papers() {
        let theta: f64 = 0.7;
        let (cosine, half) = (theta.cos(), theta / 2.0);
        let relative = |lobe: Lobe, other: f64| lobe.weight(cosine) / lobe.weight(other.cos());
        let near = |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 1e-12, "{found}, {expected}");
        near(relative(Lobe::phong(16.0).expect("in range"), 0.3), (cosine / 0.3f64.cos()).powi(16));
        let blinn = |theta: f64| (theta / 2.0).cos().powi(9) * theta.cos();
        near(relative(Lobe::blinn(9.0).expect("in range"), 0.3), blinn(0.7) / blinn(0.3));
        // Walter et al. 2007, equation 33, with tan θm.
        let ggx = |theta: f64| {
            let (m, square) = (theta / 2.0, 0.3f64 * 0.3);
            square / (PI * m.cos().powi(4) * (square + m.tan().powi(2)).powi(2)) * theta.cos()
        };
        near(relative(Lobe::ggx(0.3).expect("in range"), 0.2), ggx(0.7) / ggx(0.2));
        let charlie = |theta: f64| (theta / 2.0).sin().powf(1.0 / 0.4) * theta.cos();
        near(relative(Lobe::charlie(0.4).expect("in range"), 1.2), half.sin().powf(2.5) * cosine / charlie(1.2));
    }

    #[test]
    fn the_roughest_is_matt() {
        let rough = Lobe::ggx(1.0).expect("in range");
        for cosine in [-0.5, 0.0, 0.1, 0.7, 1.0] {
            assert!((rough.weight(cosine) / rough.integral() - Lobe::LAMBERT.weight(cosine) / PI).abs() < 1e-15);
        }
    }

    #[test]
    fn what_is_out_of_range_is_refused() {
        for alpha in [0.0, 1.1, f64::NAN, -1.0] {
            assert!(Lobe::ggx(alpha).is_err() && Lobe::charlie(alpha).is_err(), "{alpha}");
        }
        for exponent in [-1.0, f64::NAN, f64::INFINITY] {
            assert!(Lobe::phong(exponent).is_err() && Lobe::blinn(exponent).is_err(), "{exponent}");
        }
    }
}
