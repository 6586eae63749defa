//! Anti-ringing at rims, where a pixel may lie half a texel beyond the last texels that count, on a slope that
//! continues beyond them.
//!
//! If a pixel were clamped to those texels, every slope would end flat at the rim of a lens. The picture would be
//! displaced there by up to half a texel. A plane fitted through all texels tells a slope from a stripe, a step or a
//! sun. Where the texels lie on the plane, the pixel does, too. The farther one of them departs from the plane, the
//! closer the pixel is held to the clamp.

use std::cell::OnceCell;

use fearless_simd::{Simd, f32x4, f64x4, prelude::*};
use glam::{DMat3, DVec3, Vec3Swizzles};

use crate::raster::Rgba;

/// Index of alpha, the channel that may not exceed one.
const ALPHA: usize = 3;

/// Departure of texels from their fitted plane, as a part of their range, up to which they still count as straight. A
/// colour that is linear in the direction departs by about as much, since the sphere is curved.
const STRAIGHT: f64 = 1.0 / 64.0;

/// Factor by which departures beyond [`STRAIGHT`] reduce the extrapolation.
const DOUBT: f64 = 4.0;

/// Least and greatest light of some texels, by channel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds {
    pub(crate) least: [f32; 4],
    pub(crate) greatest: [f32; 4],
}

/// Places of a pixel's texels, relative to its centre, if all of them lie to one side of it; else empty. They are equal
/// in all mirrored copies of the pixel.
#[derive(Clone, Debug)]
pub(crate) struct Rim<'a> {
    places: &'a [[f32; 2]],
    /// Fit through the places, prepared when it is first needed.
    lattice: OnceCell<Option<Lattice>>,
}

impl<'a> Rim<'a> {
    pub(crate) fn new(places: &'a [[f32; 2]]) -> Self {
        Self { places, lattice: OnceCell::new() }
    }

    /// Clamps an average to the texels under the pixel, but lets it exceed them as far as all texels confirm the slope.
    #[inline(always)]
    pub(crate) fn hold<S: Simd>(&self, simd: S, average: Rgba, under: &Bounds, texels: &impl TexelLight) -> Rgba {
        let Bounds { least, greatest } = under;
        let mut held = average;
        for (c, value) in held.0.iter_mut().enumerate() {
            *value = value.max(least[c]).min(greatest[c]);
        }
        if self.places.is_empty() || held == average {
            return held;
        }
        let Some(lattice) = self.lattice.get_or_init(|| Lattice::of(self.places)) else { return held };
        let Some(doubts) = lattice.doubts(simd, texels) else { return held };
        for c in 0..ALPHA {
            let excess = average.0[c] - held.0[c];
            if excess != 0.0 {
                let value = held.0[c] + excess.signum() * (excess.abs() - doubts[c] as f32).max(0.0);
                // Light does not become negative: a slope that would is cut off at zero.
                held.0[c] = if least[c] >= 0.0 { value.max(0.0) } else { value };
            }
        }
        held
    }
}

/// Light of a pixel's texels, in the order of their places.
pub(crate) trait TexelLight {
    /// Returns the light of one texel.
    fn light<S: Simd>(&self, simd: S, index: usize) -> f32x4<S>;
}

#[cfg(test)]
impl TexelLight for Vec<Rgba> {
    fn light<S: Simd>(&self, simd: S, index: usize) -> f32x4<S> {
        f32x4::load_array_ref(simd, &self[index].0)
    }
}

/// Places around their centroid, prepared for fits by least squares.
#[derive(Clone, Debug)]
struct Lattice {
    /// [`terms`] of the places, less their mean.
    terms: Vec<DVec3>,
    /// Inverse of the second moments.
    inverse: DMat3,
}

impl Lattice {
    /// Returns the lattice of some places; `None` if they lie in a line, or are too few for a fit.
    fn of(places: &[[f32; 2]]) -> Option<Self> {
        let mut terms: Vec<DVec3> = places.iter().map(|place| self::terms(*place)).collect();
        let count = terms.len() as f64;
        let centroid = terms.iter().sum::<DVec3>() / count;
        // The matrix is symmetric, so that six of its nine sums suffice.
        let (mut squares, mut products) = (DVec3::ZERO, DVec3::ZERO);
        for term in &mut terms {
            *term -= centroid;
            (squares, products) = (squares + *term * *term, products + *term * term.yzx());
        }
        let moments = DMat3::from_cols(
            DVec3::new(squares.x, products.x, products.z),
            DVec3::new(products.x, squares.y, products.y),
            DVec3::new(products.z, products.y, squares.z),
        );
        let sizes = moments.x_axis.x * moments.y_axis.y * moments.z_axis.z;
        let is_plane = count >= FEWEST && moments.determinant() > THINNEST * sizes;
        is_plane.then(|| Self { terms, inverse: moments.inverse() })
    }

    /// Returns the doubt, by channel, that a slope through these texels continues: the light by which the extrapolation
    /// is reduced. `None` where one of them is not opaque, since colour must stay within alpha there.
    // No closures: the compiler would not use the SIMD level's instructions in them.
    #[inline(always)]
    fn doubts<S: Simd>(&self, simd: S, texels: &impl TexelLight) -> Option<[f64; 4]> {
        let (mut sum, mut along) = (f64x4::splat(simd, 0.0), [f64x4::splat(simd, 0.0); 3]);
        let (mut least, mut greatest) = (f32x4::splat(simd, f32::INFINITY), f32x4::splat(simd, f32::NEG_INFINITY));
        for (index, from) in self.terms.iter().enumerate() {
            let light = texels.light(simd, index);
            (least, greatest) = (least.min(light), greatest.max(light));
            let light = widened(light);
            sum += light;
            for axis in 0..3 {
                along[axis] += light * from[axis];
            }
        }
        if least.to_array()[ALPHA] < 1.0 {
            return None;
        }
        let [x, y, z] = along;
        let mut slopes = along;
        for (axis, slope) in slopes.iter_mut().enumerate() {
            *slope = x * self.inverse.x_axis[axis] + y * self.inverse.y_axis[axis] + z * self.inverse.z_axis[axis];
        }
        let mean = sum / self.terms.len() as f64;
        let mut departure = f64x4::splat(simd, 0.0);
        for (index, from) in self.terms.iter().enumerate() {
            let on_plane = mean + slopes[0] * from.x + slopes[1] * from.y + slopes[2] * from.z;
            departure = departure.max((widened(texels.light(simd, index)) - on_plane).abs());
        }
        let range = widened(greatest) - widened(least);
        Some((((departure - range * STRAIGHT) * DOUBT).max(f64x4::splat(simd, 0.0))).to_array())
    }
}

#[inline(always)]
fn widened<S: Simd>(light: f32x4<S>) -> f64x4<S> {
    let (low, high) = light.widen();
    low.combine(high)
}

/// Least number of texels for which a fit confirms anything.
const FEWEST: f64 = 8.0;

/// Least determinant of the second moments, as a part of the product of the variances. Below it, the places lie in a
/// line.
const THINNEST: f64 = 1e-6;

/// Returns the terms of a colour that is linear in the direction, at a place: its two coordinates, and the drop of the
/// sphere below the tangent plane, up to a factor.
fn terms([x, y]: [f32; 2]) -> DVec3 {
    let (x, y) = (f64::from(x), f64::from(y));
    DVec3::new(x, y, x * x + y * y)
}

#[cfg(test)]
mod tests {
    use fearless_simd::dispatch;

    use super::*;
    use crate::filter::rim::simd_levels::levels;

    fn hold(average: Rgba, under: &Bounds, texels: impl Iterator<Item = (Rgba, [f32; 2])>) -> Rgba {
        let (texels, places): (Vec<_>, Vec<_>) = texels.unzip();
        let of = |level| dispatch!(level, simd => Rim::new(&places).hold(simd, average, under, &texels));
        let made: Vec<Rgba> = levels().into_iter().map(of).collect();
        assert!(made.iter().all(|pixel| *pixel == made[0]), "by each level's instructions the same: {made:?}");
        made[0]
    }

    /// Number of rows of texels before the pixel; the nearest is half a row away.
    const ROWS: usize = 4;

    /// Returns an average clamped to opaque grey texels, whose first rows lie under the pixel.
    fn hold_grey(average: f32, texel: impl Fn(f32, f32) -> f32) -> f32 {
        hold_all(Rgba::opaque(average, average, average), |x, y| Rgba::opaque(texel(x, y), 0.5, 0.5)).0[0]
    }

    fn hold_all(average: Rgba, texel: impl Fn(f32, f32) -> Rgba) -> Rgba {
        let places = (0..ROWS).flat_map(|j| (0..7).map(move |i| [i as f32 - 2.8, j as f32 + 0.5]));
        let texels: Vec<_> = places.map(|[x, y]| (texel(x, y), [0.01 * x, 0.01 * y])).collect();
        let mut bounds = Bounds { least: [f32::INFINITY; 4], greatest: [f32::NEG_INFINITY; 4] };
        for (texel, _) in &texels[..14] {
            for c in 0..4 {
                bounds.least[c] = bounds.least[c].min(texel.0[c]);
                bounds.greatest[c] = bounds.greatest[c].max(texel.0[c]);
            }
        }
        hold(average, &bounds, texels.iter().copied())
    }

    #[test]
    fn a_slope_goes_on() {
        for value in [0.95, 1.0, 1.1] {
            assert_eq!(hold_grey(value, |_, y| 1.0 + 0.1 * y), value);
        }
        // A colour that is linear in the direction curves away from the tangent plane.
        assert_eq!(hold_grey(0.96, |x, y| 1.0 + 0.1 * y - 0.005 * (x * x + y * y)), 0.96);
    }

    #[test]
    fn what_is_no_slope_goes_nowhere() {
        assert_eq!(hold_grey(2e6, |x, y| if x.hypot(y - 1.5) < 1.0 { 1e6 } else { 1.0 }), 1e6);
        assert_eq!(hold_grey(-5e4, |x, y| if x.hypot(y - 1.5) < 1.0 { 1e6 } else { 1.0 }), 1.0);
        // Steps that a renderer smoothed to a slope: three rows of texels are straight, the fourth is not.
        let step = |_: f32, y: f32| [0.2, 0.5, 0.8, 0.8][y as usize];
        assert_eq!(hold_grey(0.05, step), 0.2);
        let step = |_: f32, y: f32| [0.8, 0.5, 0.2, 0.2][y as usize];
        assert_eq!(hold_grey(0.95, step), 0.8);
        assert_eq!(hold_grey(1.4, |x, _| if x < 0.4 { 0.3 } else { 1.2 }), 1.2);
    }

    #[test]
    fn light_stays_positive_and_alpha_within_what_there_is() {
        assert_eq!([0.02, -0.02].map(|value| hold_grey(value, |_, y| 0.1 * y)), [0.02, 0.0]);
        assert_eq!(hold_grey(-0.09, |_, y| 0.1 * y - 0.1), -0.09);
        assert_eq!(hold_all(Rgba([1.1; 4]), |_, y| Rgba([1.0 - 0.1 * y; 4])).0, [0.95; 4]);
    }

    #[test]
    fn as_many_texels_as_confirm_a_slope() {
        let bounds = Bounds { least: [0.7; 4], greatest: [0.85; 4] };
        let average = Rgba::opaque(0.65, 0.7, 0.7);
        // Two rows, exactly on a slope.
        let places = (0..4).flat_map(|i| [0.5, 1.5].map(|y| [0.01 * (i as f32 - 1.2), 0.01 * y]));
        let texels = places.map(|[x, y]| (Rgba::opaque(0.65 + 10.0 * y, 0.7, 0.7), [x, y]));
        assert_eq!(hold(average, &bounds, texels.clone().take(7)).0[0], 0.7);
        assert_eq!(hold(average, &bounds, texels).0[0], 0.65);
    }

    #[test]
    fn texels_in_a_line_or_too_few_confirm_nothing() {
        let bounds = Bounds { least: [0.6; 4], greatest: [1.0; 4] };
        let line = (0..9).map(|k| (Rgba::opaque(0.6 + 0.05 * k as f32, 0.6, 0.6), [0.01 * k as f32, 0.02 * k as f32]));
        let average = Rgba::opaque(0.5, 0.6, 0.6);
        assert_eq!(hold(average, &bounds, line.clone()).0[0], 0.6);
        assert_eq!(hold(average, &bounds, line.take(3)).0[0], 0.6);
        assert_eq!(hold(average, &bounds, std::iter::empty()).0[0], 0.6);
    }
}
