use fearless_simd::{Simd, prelude::*};

use super::lanes::{Falloff, Lanes};
use crate::filter::kernel::UNDER;
use crate::filter::{CrossSection, Kernel};

/// Gaussian exp(−α q) of squared distances q, cut off at a radius, which SIMD lanes evaluate without a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Gaussian {
    /// Change of the exponent's [`PARTS`]-th part with q.
    rate: f32,
    /// Squared radius.
    reach: f32,
}

/// Number of equal parts into which an exponent is divided.
const PARTS: f64 = 8.0;

/// Coefficients 1/k! of the series of eˣ, from x⁷ down. Between −1 and 0 it errs by less than 1/8!.
const SERIES: [f32; 8] = [1.0 / 5040.0, 1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0];

impl Gaussian {
    /// Returns the Gaussian of a kernel. `None` if a cross-section is none, if the two differ, if it is so narrow that a
    /// texel under the pixel may have no weight, if it falls below e⁻⁸, or if a table of some length is asked for.
    pub(crate) fn of(kernel: &Kernel) -> Option<Self> {
        let CrossSection::Gaussian { alpha, cutoff } = kernel.fine else { return None };
        let (reach, is_one) = (cutoff * cutoff, kernel.fine == kernel.coarse);
        let is_held =
            is_one && kernel.entries == Kernel::ENTRIES && reach >= UNDER && (0.0..=PARTS).contains(&(alpha * reach));
        is_held.then_some(Self { rate: (-alpha / PARTS) as f32, reach: reach as f32 })
    }
}

impl<V> Falloff<V> for Gaussian {
    #[inline(always)]
    fn weight<S: Simd>(&self, q: V) -> V
    where
        V: Lanes<S>,
    {
        let reach = V::splat(q.token(), self.reach);
        let exponent = q.min(reach) * self.rate;
        let mut part = V::splat(q.token(), SERIES[0]);
        for coefficient in &SERIES[1..] {
            part = part * exponent + *coefficient;
        }
        // The eighth power.
        let (square, zero) = (part * part, V::splat(q.token(), 0.0));
        let fourth = square * square;
        q.simd_lt(reach).select(fourth * fourth, zero)
    }
}

#[cfg(test)]
mod tests {
    use fearless_simd::{Level, dispatch, f32x8};

    use super::*;

    fn gaussian(alpha: f64, cutoff: f64) -> Kernel {
        Kernel::uniform(CrossSection::Gaussian { alpha, cutoff })
    }

    #[test]
    fn lanes_weigh_as_the_cross_section_does() {
        for kernel in [Kernel::LIGHT, gaussian(0.0, 2.0), gaussian(5.0, 1.25)] {
            let lanes = Gaussian::of(&kernel).expect("a wide Gaussian");
            for step in 0..2000 {
                let r = f64::from(step) * 0.0012;
                let q = (r * r) as f32;
                let found = dispatch!(Level::new(), simd => lanes.weight(f32x8::splat(simd, q)).to_array());
                let exact = if q < lanes.reach { kernel.fine.weight(f64::from(q).sqrt()) } else { 0.0 };
                assert!((f64::from(found[0]) - exact).abs() < 1e-6, "{kernel:?} at {r}: {} {exact}", found[0]);
            }
        }
    }

    #[test]
    fn only_wide_gaussians_are_taken() {
        let mixed = Kernel { coarse: CrossSection::MITCHELL, ..Kernel::LIGHT };
        let listed = Kernel { entries: 16, ..Kernel::LIGHT };
        for other in [Kernel::ADAPTIVE, mixed, listed, gaussian(2.0, 1.0), gaussian(2.0, 3.0), gaussian(-1.0, 2.0)] {
            assert_eq!(Gaussian::of(&other), None, "{other:?}");
        }
    }
}
