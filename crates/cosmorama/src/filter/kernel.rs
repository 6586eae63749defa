use std::f64::consts::PI;

/// The cross-section of a radial kernel: weight by distance r from the centre, in the kernel's unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CrossSection {
    /// exp(−α r²), cut off at a radius. Greene & Heckbert's pixel is α = 2, cutoff 1.
    Gaussian {
        /// Falloff.
        alpha: f64,
        /// Radius beyond which the weight is zero.
        cutoff: f64,
    },
    /// Mitchell & Netravali's cubic of parameters B and C, radius 2.
    Cubic {
        /// Blur.
        b: f64,
        /// Ringing.
        c: f64,
    },
    /// A jinc windowed by a jinc, of one to three lobes (anything else counts as the nearest); `blur` stretches the radius.
    JincJinc {
        /// Zero crossings inside the radius.
        lobes: usize,
        /// Factor on the radius; under 1 is sharper.
        blur: f64,
    },
    /// 1 − r, radius 1.
    Tent,
    /// 1 in the pixel, 0 outside. As an ellipse it is the disc of the pixel's area.
    Box,
}

/// Zeros of the jinc function J₁(πx)/x.
const JINC_ZEROS: [f64; 3] = [1.219_669_891_266_504, 2.233_130_594_381_528_6, 3.238_315_484_166_236];

impl CrossSection {
    /// Mitchell & Netravali 1988, B = C = ⅓.
    pub const MITCHELL: Self = Self::Cubic { b: 1.0 / 3.0, c: 1.0 / 3.0 };
    /// B = 0, C = ½.
    pub const CATMULL_ROM: Self = Self::Cubic { b: 0.0, c: 0.5 };
    /// N. Robidoux's cubic for cylindrical EWA: B = 12/(19 + 9√2), C = 113/(58 + 216√2).
    pub const ROBIDOUX: Self = Self::Cubic { b: 0.378_215_755_092_149_7, c: 0.310_892_122_453_925_1 };
    /// Robidoux's sharper cubic: B = 6/(13 + 7√2), C = 7/(2 + 12√2).
    pub const ROBIDOUX_SHARP: Self = Self::Cubic { b: 0.262_014_575_123_939_1, c: 0.368_992_712_438_030_4 };

    /// The distance beyond which every weight is zero.
    pub fn radius(self) -> f64 {
        match self {
            Self::Gaussian { cutoff, .. } => cutoff,
            Self::Cubic { .. } => 2.0,
            Self::JincJinc { lobes, blur } => last_zero(lobes) * blur,
            Self::Tent => 1.0,
            Self::Box => PI.sqrt().recip(),
        }
    }

    /// The weight at distance `r` ≥ 0.
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

    /// The weight at a screen distance (x, y): as [`CrossSection::weight`], but the box is the pixel's square.
    pub fn weight_at(self, x: f64, y: f64) -> f64 {
        match self {
            Self::Box => f64::from(u8::from(x.abs() < 0.5 && y.abs() < 0.5)),
            _ => self.weight(x.hypot(y)),
        }
    }
}

/// Where a jinc of this many lobes ends.
fn last_zero(lobes: usize) -> f64 {
    JINC_ZEROS[lobes.clamp(1, JINC_ZEROS.len()) - 1]
}

/// Mitchell & Netravali 1988, equation 8.
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

/// 2 J₁(πx)/(πx), 1 at the centre.
fn jinc(x: f64) -> f64 {
    let t = PI * x;
    if t < 1e-8 { 1.0 } else { 2.0 * bessel_j1(t) / t }
}

/// J₁ by its integral (1/π)∫₀^π cos(τ − t sin τ) dτ: the integrand is periodic, so the midpoint rule converges faster
/// than any power, and 32 points are exact to double precision for the arguments under 12 that kernels have.
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

/// A radial kernel with its unit: how far it reaches, in output pixels, but at least in texels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kernel {
    /// The weights where a pixel holds few texels (s ≤ [`Kernel::FINE`]).
    pub fine: CrossSection,
    /// The weights where a pixel holds many (s ≥ [`Kernel::COARSEST`]); between the two they are blended linearly.
    pub coarse: CrossSection,
    /// The kernel's unit in output pixels.
    pub scale: f64,
    /// The kernel's unit is nowhere less than this many texels.
    pub floor: f64,
    /// Whether the weights are corrected so that their centroid is the pixel's centre exactly.
    pub centred: bool,
}

impl Kernel {
    /// Texels per pixel up to which the fine cross-section holds alone.
    pub const FINE: f64 = 0.8;
    /// Texels per pixel at which the coarse cross-section has [`Kernel::KNEE`] of the blend: from here on it comes in slowly.
    pub const COARSE: f64 = 1.5;
    /// Texels per pixel from which the coarse cross-section holds alone.
    pub const COARSEST: f64 = 4.0;
    /// The coarse part at [`Kernel::COARSE`] texels per pixel. Of [`Kernel::ADAPTIVE`], the blend has there the B of Mitchell's
    /// cubic, and all but its C: 0.345.
    pub const KNEE: f64 = 0.881_330;

    /// How fast the coarse part grows with s, before the knee and after it.
    pub(crate) const SLOPES: [f64; 2] =
        [Self::KNEE / (Self::COARSE - Self::FINE), (1.0 - Self::KNEE) / (Self::COARSEST - Self::COARSE)];

    /// The default: a sharp cubic (B = 0, C = 0.6) under enlargement, Mitchell's or all but his from one and a half texels per
    /// pixel, and Robidoux's from four: the softer the more texels there are to average. Its unit is 0.8 pixel.
    ///
    /// The floor is √5/2 texels, rounded up: the radius at which every half disc on a square lattice holds a texel, so
    /// that there is something on each side of a pixel to interpolate between.
    pub const ADAPTIVE: Self = Self {
        fine: CrossSection::Cubic { b: 0.0, c: 0.6 },
        coarse: CrossSection::ROBIDOUX,
        scale: 0.8,
        floor: 1.12,
        centred: true,
    };

    /// A wide Gaussian, σ = 0.7 pixel or texel: positive, and its weights add to one over pixels, too, so that a sun of one texel
    /// gives as much light to all pixels around it as it has. For that, nothing must hold pixels to the texels under them.
    pub const LIGHT: Self =
        Self { scale: 1.4, floor: 1.4, ..Self::uniform(CrossSection::Gaussian { alpha: 2.0, cutoff: 2.0 }) };

    /// One cross-section at every scale, its unit one output pixel and at least one texel.
    pub const fn uniform(cross_section: CrossSection) -> Self {
        Self { fine: cross_section, coarse: cross_section, scale: 1.0, floor: 1.0, centred: false }
    }

    /// How much of the coarse cross-section counts where a pixel is as wide as `s` texels.
    pub fn coarseness(&self, s: f64) -> f64 {
        let [before, after] = Self::SLOPES;
        (before * (s - Self::FINE)).min(Self::KNEE + after * (s - Self::COARSE)).clamp(0.0, 1.0)
    }

    /// The larger radius of the two cross-sections.
    pub fn radius(&self) -> f64 {
        self.fine.radius().max(self.coarse.radius())
    }
}

/// Anti-ringing clamps to the texels of r² under this. With the default floor the disc reaches 1.37 texels, so that
/// whatever way a gradient runs there are texels on both sides of the pixel, at the corners of a cube too.
pub(crate) const UNDER: f64 = 1.5;

/// The paper's WTAB, twice: both cross-sections of a kernel tabulated over r², so that Q = r² is the index.
#[derive(Clone, Debug)]
pub(crate) struct KernelTable {
    kernel: Kernel,
    weights: Vec<[f32; 2]>,
    entries_per_unit: f64,
    radius_squared: f64,
}

/// Entries of a table: small enough to stay in the first cache. The line between two errs by less than 1e-4 of the peak for
/// the cubics, but by 2 % for the tent, whose tip is sharp in r², and at the edge of the box.
const ENTRIES: usize = 2048;

impl KernelTable {
    pub(crate) fn new(kernel: &Kernel) -> Self {
        let radius_squared = kernel.radius().powi(2);
        let entries_per_unit = ENTRIES as f64 / radius_squared;
        let weights = (0..=ENTRIES)
            .map(|entry| {
                // The last entry is what the weights come to at the edge, not what is beyond it.
                let r = (entry as f64 / entries_per_unit).sqrt().min(kernel.radius() * (1.0 - 1e-9));
                [kernel.fine.weight(r) as f32, kernel.coarse.weight(r) as f32]
            })
            .collect();
        Self { kernel: *kernel, weights, entries_per_unit, radius_squared }
    }

    pub(crate) fn kernel(&self) -> &Kernel {
        &self.kernel
    }

    /// r² from which every weight is zero.
    pub(crate) fn radius_squared(&self) -> f64 {
        self.radius_squared
    }

    /// The weight at distance² `q` < [`KernelTable::radius_squared`].
    pub(crate) fn weight(&self, q: f64, coarseness: f32) -> f32 {
        let place = q * self.entries_per_unit;
        let entry = (place as usize).min(ENTRIES - 1);
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
