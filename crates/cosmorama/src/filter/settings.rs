use super::Kernel;

/// How the texels under a footprint become a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FilterKind {
    /// The elliptical weighted average.
    Ewa,
    /// The same of few texels, however many a pixel holds: those of smaller copies of the world, each half as large as the one
    /// before; of the two that fit a pixel best, each gives its part (Heckbert 1989).
    EwaPyramid,
    /// The one texel that the pixel's centre sees: no filter at all.
    Point,
    /// The four texels around the pixel's centre.
    Bilinear,
    /// N×N sub-samples a pixel through the exact mapping: slow, the judge of the others. Each sub-sample interpolates
    /// between texels, so that the kernel's floor and its centring have nothing to mend and play no part.
    Reference {
        /// Sub-samples along a pixel's side.
        samples: usize,
    },
}

/// A filter with its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Filter {
    /// The method.
    pub kind: FilterKind,
    /// The weights, for the methods that have a choice.
    pub kernel: Kernel,
    /// Whether the average is clamped, per channel, to the texels under the pixel.
    pub anti_ringing: bool,
}

impl Filter {
    /// EWA with the adaptive kernel and anti-ringing: what is used when nothing else is asked for.
    pub const DEFAULT: Self = Self { kind: FilterKind::Ewa, kernel: Kernel::ADAPTIVE, anti_ringing: true };
}

impl Default for Filter {
    fn default() -> Self {
        Self::DEFAULT
    }
}
