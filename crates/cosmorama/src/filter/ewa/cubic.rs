use fearless_simd::{Simd, prelude::*};

use super::lanes::{Falloff, Lanes};
use crate::filter::{CrossSection, Kernel};

/// Polynomials for a kernel's two cross-sections, which SIMD lanes evaluate without a table. Both cross-sections must
/// be cubics of Mitchell & Netravali (1988).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cubics {
    fine: Coefficients,
    coarse: Coefficients,
}

/// Coefficients of r³, r² and 1 for r up to 1; then of x³ and x², where x = 2 − r, for r from 1 to 2.
type Coefficients = [f32; 5];

impl Cubics {
    /// Returns the cubics of a kernel; `None` if one of its cross-sections is not a cubic.
    pub(crate) fn of(kernel: &Kernel) -> Option<Self> {
        Some(Self { fine: coefficients(kernel.fine)?, coarse: coefficients(kernel.coarse)? })
    }

    /// Returns whether no weight is negative: the outer parts, of which x³ has the greater share, have no lobes.
    pub(crate) fn are_positive(&self) -> bool {
        [self.fine, self.coarse].iter().all(|[.., square]| *square >= 0.0)
    }

    /// Blends the two polynomials for each lane.
    #[inline(always)]
    pub(crate) fn blend<S: Simd, V: Lanes<S>>(&self, coarseness: V) -> Curve<V> {
        let mut curve = [coarseness; 5];
        for (k, coefficient) in curve.iter_mut().enumerate() {
            *coefficient = coarseness * (self.coarse[k] - self.fine[k]) + self.fine[k];
        }
        Curve(curve)
    }
}

/// Returns the coefficients of Mitchell & Netravali 1988, equation 8. The outer part has value and slope zero at r = 2,
/// so that powers of 2 − r suffice.
fn coefficients(section: CrossSection) -> Option<Coefficients> {
    let CrossSection::Cubic { b, c } = section else { return None };
    // With other parameters, negative lobes could outweigh the rest, which the lanes do not check.
    if !(0.0..=1.0).contains(&b) || !(0.0..=1.0).contains(&c) {
        return None;
    }
    let inner = [12.0 - 9.0 * b - 6.0 * c, -18.0 + 12.0 * b + 6.0 * c, 6.0 - 2.0 * b];
    Some([inner[0], inner[1], inner[2], b + 6.0 * c, -6.0 * c].map(|k| (k / 6.0) as f32))
}

/// A cubic in each lane.
pub(crate) struct Curve<V>([V; 5]);

impl<V> Falloff<V> for Curve<V> {
    #[inline(always)]
    fn weight<S: Simd>(&self, q: V) -> V
    where
        V: Lanes<S>,
    {
        let [inner3, inner2, inner0, outer3, outer2] = self.0;
        let (zero, r) = (V::splat(q.token(), 0.0), q.sqrt());
        // Zero from r = 2 on.
        let x = (zero + 2.0 - r).max(zero);
        let (inner, outer) = ((inner3 * r + inner2) * q + inner0, x * x * (outer3 * x + outer2));
        r.simd_lt(zero + 1.0).select(inner, outer)
    }
}

#[cfg(test)]
mod tests {
    use fearless_simd::{Level, dispatch, f32x8};

    use super::*;

    #[test]
    fn lanes_weigh_as_the_cross_section_does() {
        let kernel = Kernel::ADAPTIVE;
        let cubics = Cubics::of(&kernel).expect("both are cubics");
        for step in 0..2000 {
            let r = f64::from(step) * 0.0012;
            let q = (r * r) as f32;
            let found = dispatch!(Level::new(), simd => {
                let coarseness = f32x8::simd_from(simd, [0.0, 1.0, 0.5, 0.25, 0.0, 0.0, 0.0, 0.0]);
                cubics.blend(coarseness).weight(f32x8::splat(simd, q)).to_array()
            });
            for (lane, coarseness) in [0.0, 1.0, 0.5, 0.25].into_iter().enumerate() {
                let exact = kernel.fine.weight(r) * (1.0 - coarseness) + kernel.coarse.weight(r) * coarseness;
                assert!((f64::from(found[lane]) - exact).abs() < 1e-6, "{r} {lane}: {} {exact}", found[lane]);
            }
        }
    }

    #[test]
    fn only_cubics_are_taken() {
        assert_eq!(Cubics::of(&Kernel::uniform(CrossSection::Tent)), None);
    }
}
