use std::f64::consts::PI;

/// Cross-section of a radial kernel: weight by distance r from the centre, in the kernel's unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CrossSection {
    /// Gaussian exp(−α r²) up to the radius `cutoff`, and zero beyond it. Greene and Heckbert use α = 2 and a cutoff of 1
    /// pixel.
    Gaussian {
        /// Falloff α.
        alpha: f64,
        /// Radius beyond which the weight is zero.
        cutoff: f64,
    },
    /// Mitchell & Netravali's cubic with parameters B and C; its radius is 2.
    Cubic {
        /// Parameter B, the blur.
        b: f64,
        /// Parameter C, the ringing.
        c: f64,
    },
    /// Jinc windowed by a jinc, with one to three lobes; any other number counts as the nearest of these.
    JincJinc {
        /// Number of zero crossings inside the radius.
        lobes: usize,
        /// Factor on the radius; below 1 the kernel is sharper.
        blur: f64,
    },
    /// Tent 1 − r; its radius is 1.
    Tent,
    /// Box: 1 in the pixel, 0 outside. As an ellipse it is the disc with the pixel's area.
    Box,
}

/// Zeros of the jinc function J₁(πx)/x.
const JINC_ZEROS: [f64; 3] = [1.219_669_891_266_504, 2.233_130_594_381_528_6, 3.238_315_484_166_236];

impl CrossSection {
    /// Mitchell & Netravali's own cubic (1988): B = C = ⅓.
    pub const MITCHELL: Self = Self::Cubic { b: 1.0 / 3.0, c: 1.0 / 3.0 };
    /// Catmull-Rom spline: B = 0, C = ½.
    pub const CATMULL_ROM: Self = Self::Cubic { b: 0.0, c: 0.5 };
    /// N. Robidoux's cubic for cylindrical EWA: B = 12/(19 + 9√2), C = 113/(58 + 216√2).
    pub const ROBIDOUX: Self = Self::Cubic { b: 0.378_215_755_092_149_7, c: 0.310_892_122_453_925_1 };
    /// Robidoux's sharper cubic: B = 6/(13 + 7√2), C = 7/(2 + 12√2).
    pub const ROBIDOUX_SHARP: Self = Self::Cubic { b: 0.262_014_575_123_939_1, c: 0.368_992_712_438_030_4 };

    /// Returns the distance beyond which every weight is zero.
    pub fn radius(self) -> f64 {
        match self {
            Self::Gaussian { cutoff, .. } => cutoff,
            Self::Cubic { .. } => 2.0,
            Self::JincJinc { lobes, blur } => last_zero(lobes) * blur,
            Self::Tent => 1.0,
            Self::Box => PI.sqrt().recip(),
        }
    }

    /// Returns the weight at distance `r` ≥ 0.
    pub fn weight(self, r: f64) -> f64 {
        if r >= self.radius() {
            return 0.0;
        }
        match self {
            Self::Gaussian { alpha, .. } => (-alpha * r * r).exp(),
            Self::Cubic { b, c } => cubic(b, c, r),
            Self::JincJinc { lobes, blur } => {
                let x = r / blur;
                jinc(x) * jinc(x * JINC_ZEROS[0] / last_zero(lobes))
            }
            Self::Tent => 1.0 - r,
            Self::Box => 1.0,
        }
    }

    /// Returns the weight at a screen distance (x, y). It is [`CrossSection::weight`], except that the box is the
    /// pixel's square.
    pub fn weight_at(self, x: f64, y: f64) -> f64 {
        match self {
            Self::Box => f64::from(u8::from(x.abs() < 0.5 && y.abs() < 0.5)),
            _ => self.weight(x.hypot(y)),
        }
    }
}

/// Returns the distance at which a jinc with this many lobes ends.
fn last_zero(lobes: usize) -> f64 {
    JINC_ZEROS[lobes.clamp(1, JINC_ZEROS.len()) - 1]
}

/// Computes Mitchell & Netravali's cubic (1988, equation 8).
fn cubic(b: f64, c: f64, r: f64) -> f64 {
    let sixth = if r < 1.0 {
        (12.0 - 9.0 * b - 6.0 * c) * r.powi(3) + (-18.0 + 12.0 * b + 6.0 * c) * r.powi(2) + (6.0 - 2.0 * b)
    } else {
        (-b - 6.0 * c) * r.powi(3)
            + (6.0 * b + 30.0 * c) * r.powi(2)
            + (-12.0 * b - 48.0 * c) * r
            + (8.0 * b + 24.0 * c)
    };
    sixth / 6.0
}

/// Computes the jinc 2 J₁(πx)/(πx), which is 1 at the centre.
fn jinc(x: f64) -> f64 {
    let t = PI * x;
    if t < 1e-8 { 1.0 } else { 2.0 * bessel_j1(t) / t }
}

/// Computes J₁ by its integral (1/π)∫₀^π cos(τ − t sin τ) dτ. The integrand is periodic, so the midpoint rule converges
/// faster than any power. With 32 points it is exact to double precision for the arguments below 12 that kernels have.
fn bessel_j1(t: f64) -> f64 {
    const POINTS: usize = 32;
    (0..POINTS)
        .map(|k| {
            let tau = PI * (k as f64 + 0.5) / POINTS as f64;
            (tau - t * tau.sin()).cos()
        })
        .sum::<f64>()
        / POINTS as f64
}

/// A radial kernel and its unit of length: `scale` output pixels, but at least `floor` texels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kernel {
    /// Cross-section where a pixel holds few texels: s ≤ [`Kernel::FINE`], where s is the pixel's width in texels.
    pub fine: CrossSection,
    /// Cross-section where a pixel holds many texels (s ≥ [`Kernel::COARSEST`]). Between the two limits, both are
    /// blended linearly.
    pub coarse: CrossSection,
    /// Unit of the kernel in output pixels.
    pub scale: f64,
    /// Least size of the unit, in texels.
    pub floor: f64,
    /// Whether the weights are corrected so that their centroid is exactly the pixel's centre.
    pub centred: bool,
    /// Whether a pixel counts as a circle of its solid angle, whatever its shape ([`Footprint::rounded`]). Pixels of two faces
    /// of a cube lean to different sides at the edge between them, most of all beside a corner. Circles do not.
    ///
    /// [`Footprint::rounded`]: crate::camera::Footprint::rounded
    pub round: bool,
    /// Number of entries of the table over r² that holds the weights, from 1 to [`Kernel::MOST_ENTRIES`]; between two
    /// entries they are interpolated. Where that is faster, cubics are computed instead, and wide Gaussians whose table has
    /// the usual length.
    pub entries: usize,
}

impl Kernel {
    /// Texels per pixel up to which only the fine cross-section counts.
    pub const FINE: f64 = 0.8;
    /// Texels per pixel at which the share of the coarse cross-section is [`Kernel::KNEE`]; beyond it the share grows
    /// slowly.
    pub const COARSE: f64 = 1.5;
    /// Texels per pixel from which only the coarse cross-section counts.
    pub const COARSEST: f64 = 4.0;
    /// Share of the coarse cross-section at [`Kernel::COARSE`]. With it, [`Kernel::ADAPTIVE`] has B = ⅓ and C = 0.345
    /// there, nearly Mitchell's.
    pub const KNEE: f64 = 0.881_330;

    /// Usual number of entries of a table, which is small enough for the first-level cache. For the cubics, interpolation
    /// between two entries errs by less than 1e-4 of the peak. For the tent, whose tip is sharp in r², and at the edge of
    /// the box, it errs by 2 %.
    pub const ENTRIES: usize = 2048;

    /// Greatest number of entries of a table.
    pub const MOST_ENTRIES: usize = 1 << 16;

    /// Growth of the coarse share with s, before the knee and after it.
    pub(crate) const SLOPES: [f64; 2] =
        [Self::KNEE / (Self::COARSE - Self::FINE), (1.0 - Self::KNEE) / (Self::COARSEST - Self::COARSE)];

    /// The default kernel, which is softer the more texels there are to average; its unit is 0.8 pixel. Under
    /// enlargement it is a sharp cubic (B = 0, C = 0.6). At one and a half texels per pixel it is nearly Mitchell's,
    /// from four on Robidoux's.
    ///
    /// The floor is √5/2 texels, rounded up: the radius at which every half disc on a square lattice holds a texel. So
    /// there is something on each side of a pixel to interpolate between.
    pub const ADAPTIVE: Self = Self {
        fine: CrossSection::Cubic { b: 0.0, c: 0.6 },
        coarse: CrossSection::ROBIDOUX,
        scale: 0.8,
        floor: 1.12,
        centred: true,
        round: false,
        entries: Self::ENTRIES,
    };

    /// A wide Gaussian that keeps the total light; σ = 0.7 pixel or 0.7 texel, whichever is larger. Its weights are
    /// positive, and for each texel they add to one over the pixels: a sun of one texel gives the pixels around it as
    /// much light as it has. This needs anti-ringing to be off.
    pub const LIGHT: Self =
        Self { scale: 1.4, floor: 1.4, ..Self::uniform(CrossSection::Gaussian { alpha: 2.0, cutoff: 2.0 }) };

    /// Returns the kernel with one cross-section at every scale, whose unit is one output pixel and at least one texel.
    pub const fn uniform(cross_section: CrossSection) -> Self {
        Self {
            fine: cross_section,
            coarse: cross_section,
            scale: 1.0,
            floor: 1.0,
            centred: false,
            round: false,
            entries: Self::ENTRIES,
        }
    }

    /// Returns the share of the coarse cross-section where a pixel is `s` texels wide.
    pub fn coarseness(&self, s: f64) -> f64 {
        let [before, after] = Self::SLOPES;
        (before * (s - Self::FINE)).min(Self::KNEE + after * (s - Self::COARSE)).clamp(0.0, 1.0)
    }

    /// Returns the larger radius of the two cross-sections.
    pub fn radius(&self) -> f64 {
        self.fine.radius().max(self.coarse.radius())
    }
}

/// Squared distance below which a texel counts as under a pixel; anti-ringing clamps the average to these texels. With
/// the default floor the disc reaches 1.37 texels. So there are texels on both sides of the pixel along any gradient,
/// at the corners of a cube, too.
pub(crate) const UNDER: f64 = 1.5;

/// The paper's WTAB, twice: both cross-sections of a kernel tabulated over r², so that Q = r² is the index.
#[derive(Clone, Debug)]
pub(crate) struct KernelTable {
    kernel: Kernel,
    weights: Vec<[f32; 2]>,
    entries_per_unit: f64,
    radius_squared: f64,
}

impl KernelTable {
    pub(crate) fn new(kernel: &Kernel) -> Self {
        let radius_squared = kernel.radius().powi(2);
        let entries = kernel.entries.max(1);
        let entries_per_unit = entries as f64 / radius_squared;
        let weights = (0..=entries)
            .map(|entry| {
                // The last entry holds the weights just inside the radius. At the radius itself they may drop to zero.
                let r = (entry as f64 / entries_per_unit).sqrt().min(kernel.radius() * (1.0 - 1e-9));
                [kernel.fine.weight(r) as f32, kernel.coarse.weight(r) as f32]
            })
            .collect();
        Self { kernel: *kernel, weights, entries_per_unit, radius_squared }
    }

    pub(crate) fn kernel(&self) -> &Kernel {
        &self.kernel
    }

    /// Returns the squared distance from which on every weight is zero.
    pub(crate) fn radius_squared(&self) -> f64 {
        self.radius_squared
    }

    /// Returns the weight at squared distance `q` < [`KernelTable::radius_squared`].
    pub(crate) fn weight(&self, q: f64, coarseness: f32) -> f32 {
        let place = q * self.entries_per_unit;
        let entry = (place as usize).min(self.weights.len() - 2);
        let part = (place - entry as f64) as f32;
        let ([fine, coarse], [next_fine, next_coarse]) = (self.weights[entry], self.weights[entry + 1]);
        let (fine, coarse) = (fine + (next_fine - fine) * part, coarse + (next_coarse - coarse) * part);
        fine + (coarse - fine) * coarseness
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_hold_their_kernels() {
        let gaussian = CrossSection::Gaussian { alpha: 2.0, cutoff: 1.0 };
        let lanczos = CrossSection::JincJinc { lobes: 3, blur: 1.0 };
        for (section, bound) in [
            (CrossSection::MITCHELL, 1e-4),
            (CrossSection::CATMULL_ROM, 1e-4),
            (gaussian, 1e-4),
            (lanczos, 1e-4),
            (CrossSection::Tent, 0.02),
        ] {
            let table = KernelTable::new(&Kernel::uniform(section));
            for step in 0..100_000 {
                let r = section.radius() * f64::from(step) / 100_000.0;
                let error = (f64::from(table.weight(r * r, 0.5)) - section.weight(r)).abs();
                assert!(error < bound, "{section:?} at {r}: {error}");
            }
        }
    }

    /// Checks that interpolation errs by an eighth of the second derivative, 4 of exp(−2 q), times the square of a step.
    #[test]
    fn a_table_of_a_gaussian_is_as_exact_as_it_is_long() {
        let gaussian = CrossSection::Gaussian { alpha: 2.0, cutoff: 1.0 };
        for entries in [4, 64, 4096] {
            let table = KernelTable::new(&Kernel { entries, ..Kernel::uniform(gaussian) });
            let error = |k: i32| {
                let q = f64::from(k) / 10_000.0;
                (f64::from(table.weight(q, 0.0)) - (-2.0 * q).exp()).abs()
            };
            let greatest = (0..9_999).map(error).fold(0.0, f64::max);
            let bound = 0.5 / (entries * entries) as f64;
            assert!(greatest < bound + 1e-7 && greatest > 0.5 * bound - 1e-7, "{entries} entries: {greatest}");
        }
    }

    #[test]
    fn kernels_get_coarser_the_more_texels_a_pixel_holds() {
        let parts = [0.0, 0.8, 1.15, 1.5, 2.75, 4.0, 1e9].map(|s| Kernel::ADAPTIVE.coarseness(s));
        let expected = [0.0, 0.0, 0.440_665, 0.881_33, 0.940_665, 1.0, 1.0];
        for (part, expected) in parts.into_iter().zip(expected) {
            assert!((part - expected).abs() < 1e-12, "{part}, not {expected}");
        }
        // At the knee: Mitchell's cubic.
        for r in [0.0, 0.3, 0.7, 1.0, 1.4, 1.9] {
            let part = Kernel::KNEE;
            let weight = Kernel::ADAPTIVE.fine.weight(r) * (1.0 - part) + Kernel::ADAPTIVE.coarse.weight(r) * part;
            let mitchell = CrossSection::MITCHELL.weight(r);
            assert!((weight - mitchell).abs() < 0.003, "{weight} at {r}, not {mitchell}");
        }
    }

    #[test]
    fn jincs_end_at_their_zeros() {
        for zero in JINC_ZEROS {
            assert!(jinc(zero).abs() < 1e-14, "{zero}");
        }
    }
}
