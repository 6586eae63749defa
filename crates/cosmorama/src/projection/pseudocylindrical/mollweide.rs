use std::f64::consts::{PI, SQRT_2};

use super::{Parallel, Parallels};
use crate::projection::cylindrical::Latitude;

/// Mollweide's map, in an ellipse with semi-axes 2√2 and √2: x = (2√2/π) λ cos θ, y = √2 sin θ, where 2θ + sin 2θ = π
/// sin φ. Areas are proportional to solid angles.
///
/// Near a pole θ is computed from the angle δ = π/2 − θ to it, with 2δ − sin 2δ = π (1 − sin φ), which stays exact
/// there.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mollweide;

/// x divided by λ cos θ.
const WIDTH: f64 = 2.0 * SQRT_2 / PI;

/// Least sin δ and cos φ; at the pole itself, which is a point, they would be 0.
const NARROWEST: f64 = 1e-12;

/// Returns x − sin x, by a series where the difference would lose digits.
fn excess(x: f64) -> f64 {
    if x > 1.0 {
        return x - x.sin();
    }
    let x2 = x * x;
    let term = |rest: f64, n: f64| 1.0 - x2 / (n * (n + 1.0)) * rest;
    let series = [16.0, 14.0, 12.0, 10.0, 8.0, 6.0, 4.0].into_iter().fold(1.0, term);
    x * x2 / 6.0 * series
}

/// Returns sine and cosine of θ at a northern latitude, by Newton's iteration.
fn auxiliary(latitude: Latitude) -> (f64, f64) {
    let sin = latitude.sin.abs().min(1.0);
    if sin < 0.5 {
        let target = PI * sin;
        return newton(target / 4.0, |theta| (2.0 * theta + (2.0 * theta).sin() - target, 4.0 * theta.cos().powi(2)))
            .sin_cos();
    }
    // 1 − sin φ without its loss of digits; near the pole δ is a cube root of it.
    let target = PI * latitude.cos * latitude.cos / (1.0 + sin);
    let start = (0.75 * target).cbrt();
    let (sin_delta, cos_delta) =
        newton(start, |delta| (excess(2.0 * delta) - target, 4.0 * delta.sin().powi(2))).sin_cos();
    (cos_delta, sin_delta)
}

/// Finds the root near `start` of a function given with its derivative; `start` itself where the derivative vanishes.
fn newton(start: f64, function: impl Fn(f64) -> (f64, f64)) -> f64 {
    let mut at = start;
    for _ in 0..50 {
        let (value, slope) = function(at);
        let step = if slope > 0.0 { value / slope } else { 0.0 };
        at -= step;
        if step.abs() <= 2.0 * f64::EPSILON * at {
            break;
        }
    }
    at
}

impl Parallels for Mollweide {
    fn place(&self, latitude: Latitude) -> (f64, f64) {
        let (sin, cos) = auxiliary(latitude);
        (SQRT_2 * sin * latitude.sin.signum(), WIDTH * cos)
    }

    fn at(&self, height: f64) -> Option<Parallel> {
        let cos_delta = height.abs() / SQRT_2;
        if cos_delta.is_nan() || cos_delta > 1.0 + NARROWEST {
            return None;
        }
        let cos_delta = cos_delta.min(1.0);
        let sin_delta = ((1.0 - cos_delta) * (1.0 + cos_delta)).sqrt();
        let s = excess(2.0 * sin_delta.atan2(cos_delta)) / PI;
        let (sin, cos) = (1.0 - s, (s * (2.0 - s)).max(0.0).sqrt().max(NARROWEST));
        let sin_delta = sin_delta.max(NARROWEST);
        Some(Parallel {
            latitude: Latitude { sin: sin * height.signum(), cos },
            width: WIDTH * sin_delta,
            // π cos φ dφ = 4 cos² θ dθ and dy = √2 cos θ dθ.
            latitude_slope: 4.0 * sin_delta / (PI * SQRT_2 * cos),
            width_slope: -WIDTH * cos_delta * height.signum() / (SQRT_2 * sin_delta),
        })
    }
    fn has_steep_poles(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pole_is_as_exact_as_the_rest() {
        for exponent in 0..12 {
            let colatitude = 10f64.powi(-exponent);
            let (height, _) = Mollweide.place(Latitude { sin: colatitude.cos(), cos: colatitude.sin() });
            let back = Mollweide.at(height).expect("on the map").latitude;
            // The height holds the pole's distance to the 4/3: all of its digits down to a millionth of a degree.
            let lost = f64::EPSILON / colatitude.powf(4.0 / 3.0);
            assert!((back.cos / colatitude.sin() - 1.0).abs() < 1e-14 + 4.0 * lost, "{colatitude}: {back:?}");
        }
        assert_eq!(Mollweide.at(1.5), None);
    }
}
