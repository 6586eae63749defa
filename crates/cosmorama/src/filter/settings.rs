use super::{
    Bilinear, Classic, ClassicTables, Ewa, EwaPyramid, Filter, Kernel, LabelRule, Labels, Point, PrepareError,
    Prepared, Reference, SetupCost,
};
use crate::raster::Rgba;
use crate::world::{Light, World};

/// Method that makes a pixel of the texels under a footprint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FilterKind {
    /// The elliptical weighted average.
    Ewa,
    /// EWA on a pyramid of smaller copies of the world, each half as large as the one before. A pixel takes few texels,
    /// however many it holds: the two levels that fit it best each give a part (Heckbert 1989).
    EwaPyramid,
    /// The one texel that the pixel's centre sees, without filtering.
    Point,
    /// Bilinear interpolation between the four texels around the pixel's centre.
    Bilinear,
    /// One texel's value, chosen by a rule and never mixed with others: for labels.
    Labels(LabelRule),
    /// A filter of the literature, to compare with.
    Classic(Classic),
    /// N×N sub-samples a pixel through the exact mapping. It is slow, and the other methods are judged by it. Each
    /// sub-sample interpolates between texels, so the kernel's floor and its centring are not needed and have no
    /// effect.
    Reference {
        /// Number of sub-samples along a pixel's side.
        samples: usize,
    },
}

/// A filter chosen at run time, with its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilterSettings {
    /// Method of averaging.
    pub kind: FilterKind,
    /// Kernel that weighs the texels, for methods that have a choice.
    pub kernel: Kernel,
    /// Whether the average is clamped, per channel, to the texels under the pixel.
    pub anti_ringing: bool,
}

impl FilterKind {
    /// Returns whether a kernel of [`FilterSettings`] plays a part.
    pub fn uses_kernel(self, kernel: &Kernel) -> bool {
        match self {
            Self::Ewa | Self::EwaPyramid | Self::Labels(LabelRule::Vote) | Self::Reference { .. } => true,
            Self::Point | Self::Bilinear | Self::Labels(LabelRule::Nearest) => false,
            Self::Classic(classic) => classic.with(*kernel).shape() == Some(*kernel),
        }
    }

    /// Returns whether anti-ringing plays a part.
    pub fn uses_anti_ringing(self) -> bool {
        match self {
            Self::Ewa | Self::EwaPyramid | Self::Reference { .. } => true,
            Self::Point | Self::Bilinear | Self::Labels(_) | Self::Classic(_) => false,
        }
    }

    /// Returns whether a pixel is the average of the texels in an ellipse.
    pub(crate) fn is_elliptical(self) -> bool {
        match self {
            Self::Ewa | Self::EwaPyramid => true,
            Self::Point | Self::Bilinear | Self::Labels(_) | Self::Classic(_) | Self::Reference { .. } => false,
        }
    }

    /// Returns whether the texels of a pixel can be listed; of other filters, what they reach is known.
    pub(crate) fn lists_texels(self) -> bool {
        match self {
            Self::Ewa | Self::Point | Self::Bilinear | Self::Labels(_) | Self::Reference { .. } => true,
            Self::EwaPyramid | Self::Classic(_) => false,
        }
    }

    /// Returns whether the filter picks one of two texels that are equally near, so that mirrored pictures may differ.
    pub(crate) fn chooses_texels(self) -> bool {
        match self {
            Self::Point | Self::Labels(_) => true,
            Self::Ewa | Self::EwaPyramid | Self::Bilinear | Self::Classic(_) | Self::Reference { .. } => false,
        }
    }
}

impl FilterSettings {
    /// EWA with the adaptive kernel and anti-ringing, which is used when nothing else is asked for.
    pub const DEFAULT: Self = Self { kind: FilterKind::Ewa, kernel: Kernel::ADAPTIVE, anti_ringing: true };
}

impl FilterSettings {
    /// Returns the filter that these settings name.
    fn chosen(&self) -> Box<dyn Filter> {
        let Self { kind, kernel, anti_ringing } = *self;
        match kind {
            FilterKind::Ewa => Box::new(Ewa { kernel, anti_ringing }),
            FilterKind::EwaPyramid => Box::new(EwaPyramid { kernel, anti_ringing }),
            FilterKind::Point => Box::new(Point),
            FilterKind::Bilinear => Box::new(Bilinear),
            FilterKind::Classic(classic) => Box::new(classic.with(kernel)),
            FilterKind::Labels(rule) => Box::new(Labels { rule, kernel }),
            FilterKind::Reference { samples } => Box::new(Reference { samples, kernel, anti_ringing }),
        }
    }

    /// Makes what the filter computes of a world's texels once for all pictures; `None` if pictures share nothing. The two passes
    /// of [`Classic::TwoPass`] are those of one picture.
    pub fn tables(&self, world: &World, texels: &[Rgba]) -> Option<ClassicTables> {
        match self.kind {
            FilterKind::Classic(classic) if self.has_tables() => Some(classic.with(self.kernel).tables(world, texels)),
            _ => None,
        }
    }

    /// Returns whether there are [`FilterSettings::tables`].
    pub fn has_tables(&self) -> bool {
        matches!(self.kind, FilterKind::Classic(classic) if classic != Classic::TwoPass)
    }

    /// Checks that the filter loses no precision over a world.
    ///
    /// # Errors
    /// When it would: see [`WeighedClassic::check`](super::WeighedClassic::check).
    pub fn check(&self, world: &World) -> Result<(), PrepareError> {
        if let FilterKind::Classic(classic) = self.kind { classic.with(self.kernel).check(world) } else { Ok(()) }
    }

    /// Returns the filter by which this one is judged: the reference, by the kernel that this one weighs by on the screen, or
    /// by that of the settings.
    #[must_use]
    pub fn judge(&self, samples: usize) -> Self {
        let own = if let FilterKind::Classic(classic) = self.kind { classic.with(self.kernel).shape() } else { None };
        Self { kind: FilterKind::Reference { samples }, kernel: own.unwrap_or(self.kernel), ..*self }
    }

    /// Returns a kernel that reaches all texels that are read for a pixel.
    pub(crate) fn reaching_kernel(&self) -> Kernel {
        let kernel = self.kernel;
        match self.kind {
            // A texel of the coarser level is at most as wide as a pixel. The kernel grows by its floor in such texels,
            // and by one texel for interpolation.
            FilterKind::EwaPyramid => Kernel { scale: kernel.scale + kernel.floor + 1.0, ..kernel },
            FilterKind::Classic(classic) => classic.with(kernel).reaching_kernel(),
            FilterKind::Ewa
            | FilterKind::Point
            | FilterKind::Bilinear
            | FilterKind::Labels(_)
            | FilterKind::Reference { .. } => kernel,
        }
    }

    /// Returns the reference filter with this number of sub-samples along a pixel's side, and with this kernel.
    pub(crate) fn reference(&self, samples: usize) -> Reference {
        Reference { samples, kernel: self.kernel, anti_ringing: self.anti_ringing }
    }
}

impl Filter for FilterSettings {
    fn prepare<'w>(&self, world: &'w World, light: &'w Light) -> Result<Box<dyn Prepared + 'w>, PrepareError> {
        self.chosen().prepare(world, light)
    }

    fn setup(&self, world: &World) -> SetupCost {
        self.chosen().setup(world)
    }
}

impl Default for FilterSettings {
    fn default() -> Self {
        Self::DEFAULT
    }
}
