//! Elliptical weighted average filter as the paper prints it, for one image (Greene & Heckbert 1986).
//!
//! [`Resampler`](crate::render::Resampler) computes the average across views, with any kernel. This is the original,
//! recognisable line by line. A test holds the two equal where one view suffices.

use crate::camera::PixelPoint;
use crate::filter::CrossSection;
use crate::raster::{Image, Rgba};

/// The paper's WTAB: weights tabulated over r², out to the radius of their cross-section.
#[derive(Clone, Debug, PartialEq)]
pub struct WeightTable {
    wtab: Vec<f32>,
    radius: f64,
}

impl WeightTable {
    /// Makes a table of `length` entries, each the weight in the middle of its part; the paper uses a Gaussian of α = 2 out to
    /// r = 1.
    pub fn new(section: CrossSection, length: usize) -> Self {
        let radius = section.radius();
        let entry = |q: usize| section.weight(((q as f64 + 0.5) / length as f64).sqrt() * radius) as f32;
        Self { wtab: (0..length).map(entry).collect(), radius }
    }

    /// Returns the number of entries.
    pub(crate) fn length(&self) -> usize {
        self.wtab.len()
    }

    /// Returns an entry; zero beyond the last.
    pub(crate) fn entry(&self, q: usize) -> f64 {
        self.wtab.get(q).map_or(0.0, |weight| f64::from(*weight))
    }
}

/// Derivatives of the texture coordinates (u, v) by screen x and y: texels for a step of one pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureDerivatives {
    /// ∂u/∂x.
    pub ux: f64,
    /// ∂v/∂x.
    pub vx: f64,
    /// ∂u/∂y.
    pub uy: f64,
    /// ∂v/∂y.
    pub vy: f64,
}

/// Averages the texels of `image` under the screen pixel whose centre maps to `centre`. The result is transparent where
/// the ellipse holds no texel.
pub fn ewa(image: &Image<Rgba>, centre: PixelPoint, derivatives: TextureDerivatives, table: &WeightTable) -> Rgba {
    let TextureDerivatives { ux, vx, uy, vy } = derivatives;
    // Texel centres lie at half-integers; the paper's lie at integers.
    let (u0, v0) = (centre.x - 0.5, centre.y - 0.5);

    // The ellipse Q(U, V) = AU² + BUV + CV² < F.
    let (mut a, mut b, mut c) = (vx * vx + vy * vy, -2.0 * (ux * vx + uy * vy), ux * ux + uy * uy);
    let mut f = (table.radius * (ux * vy - uy * vx)).powi(2);

    // Its box: Q's extrema along U and V.
    let determinant = a * c - b * b / 4.0;
    let (u_reach, v_reach) = ((c * f / determinant).sqrt(), (a * f / determinant).sqrt());
    let (u_min, u_max) = ((u0 - u_reach).ceil().max(0.0), (u0 + u_reach).floor().min(image.width() as f64 - 1.0));
    let (v_min, v_max) = ((v0 - v_reach).ceil().max(0.0), (v0 + v_reach).floor().min(image.height() as f64 - 1.0));
    if !(u_min <= u_max && v_min <= v_max) {
        return Rgba::TRANSPARENT;
    }

    // Scale A, B, C so that F is the length of WTAB and Q its index.
    let scale = table.wtab.len() as f64 / f;
    (a, b, c, f) = (a * scale, b * scale, c * scale, table.wtab.len() as f64);

    let (mut num, mut den) = (Rgba::TRANSPARENT, 0f32);
    let ddq = 2.0 * a;
    for v in v_min as usize..=v_max as usize {
        let (u, dv) = (u_min - u0, v as f64 - v0);
        // Q by finite differences along the row.
        let mut dq = a * (2.0 * u + 1.0) + b * dv;
        let mut q = (c * dv + b * u) * dv + a * u * u;
        for texel in &image.row(v)[u_min as usize..=u_max as usize] {
            if q < f {
                let weight = table.wtab[q.max(0.0) as usize];
                num += *texel * weight;
                den += weight;
            }
            q += dq;
            dq += ddq;
        }
    }
    if den > 0.0 { num * den.recip() } else { Rgba::TRANSPARENT }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Averages texel by texel, from the definition.
    fn by_definition(image: &Image<Rgba>, centre: PixelPoint, d: TextureDerivatives, alpha: f64) -> f64 {
        let determinant = d.ux * d.vy - d.uy * d.vx;
        let (mut num, mut den) = (0.0, 0.0);
        for j in 0..image.height() {
            for i in 0..image.width() {
                let (u, v) = (i as f64 + 0.5 - centre.x, j as f64 + 0.5 - centre.y);
                // Back to the screen, where the pixel is round.
                let (x, y) = ((d.vy * u - d.uy * v) / determinant, (d.ux * v - d.vx * u) / determinant);
                let r2 = x * x + y * y;
                if r2 < 1.0 {
                    num += (-alpha * r2).exp() * f64::from(image.get(i, j).0[0]);
                    den += (-alpha * r2).exp();
                }
            }
        }
        num / den
    }

    #[test]
    fn equals_the_definition() {
        let image = Image::from_fn(64, 48, |i, j| {
            let value = ((i * 37 + j * 101) % 29) as f32 / 29.0;
            Rgba::opaque(value, value, value)
        });
        let table = WeightTable::new(CrossSection::Gaussian { alpha: 2.0, cutoff: 1.0 }, 1 << 16);
        for (k, derivatives) in [(3.0, 0.5, -1.0, 2.0), (6.0, 2.5, 1.0, 1.5), (1.5, 0.0, 0.0, 8.0)].iter().enumerate() {
            let &(ux, vx, uy, vy) = derivatives;
            let derivatives = TextureDerivatives { ux, vx, uy, vy };
            let centre = PixelPoint::new(20.3 + 9.0 * k as f64, 22.9);
            let found = f64::from(ewa(&image, centre, derivatives, &table).0[0]);
            let expected = by_definition(&image, centre, derivatives, 2.0);
            assert!((found - expected).abs() < 1e-5, "{derivatives:?}: {found} is not {expected}");
        }
    }
}
