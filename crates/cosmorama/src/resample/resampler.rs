use super::plan::{self, FixedPlan, Plan};
use super::window::Level;
use super::{Filter, FilterKind, reference};
use crate::raster::{FixedCodec, FixedLight, Image, Rgba};
use crate::world::{View, World};

/// A conversion from a world to a target view.
#[derive(Clone, Copy, Debug)]
pub struct Resampler<'a> {
    /// Where light comes from.
    pub world: &'a World,
    /// Where it goes.
    pub target: &'a View,
    /// How.
    pub filter: Filter,
}

impl Resampler<'_> {
    /// One frame, computed without storing the geometry. `texels` is the world's buffer of light.
    ///
    /// A [`Plan`] makes the same pixels.
    ///
    /// Pixels are premultiplied by their coverage: transparent outside the lens. A pixel just beyond the world's last texel
    /// takes what its kernel still reaches; [`super::ScreenMask`] tells which pixels see nothing.
    ///
    /// # Panics
    /// If `texels` is not as long as [`World::texel_count`] says.
    pub fn render(&self, texels: &[Rgba]) -> Image<Rgba> {
        assert_eq!(texels.len(), self.world.texel_count(), "one texel of light for each texel of the world");
        if let FilterKind::Reference { samples } = self.filter.kind {
            return reference::render(self.world, self.target, &self.filter, samples, texels);
        }
        plan::render(self, texels, Level::new())
    }

    /// One frame of 8 bits, opaque, of light that has 15: the code values of each pixel, within one of those of
    /// [`Resampler::render`].
    ///
    /// # Panics
    /// If `light` is not that of the world's texels.
    pub fn render_fixed(&self, light: &FixedLight, codec: &FixedCodec) -> Image<[u8; 3]> {
        assert_eq!(light.len(), self.world.texel_count(), "one texel of light for each texel of the world");
        if let FilterKind::Reference { .. } = self.filter.kind {
            let texels: Vec<Rgba> = (0..light.len()).map(|texel| light.rgba(texel)).collect();
            return codec.encode(&self.render(&texels));
        }
        plan::render_fixed(self, light, codec)
    }

    /// The geometry, for any number of frames; `None` for the reference filter, which has too many samples to store.
    pub fn plan(&self) -> Option<Plan> {
        (!self.is_reference()).then(|| Plan::new(self))
    }

    /// The geometry for frames of 8 bits.
    pub fn fixed_plan(&self) -> Option<FixedPlan> {
        (!self.is_reference()).then(|| FixedPlan::new(self))
    }

    /// About how many bytes [`Resampler::plan`] would hold: found from every sixteenth band of rows, keeping nothing.
    pub fn plan_bytes_estimate(&self) -> usize {
        if self.is_reference() { 0 } else { Plan::bytes_estimate(self) }
    }

    /// The same of [`Resampler::fixed_plan`].
    pub fn fixed_plan_bytes_estimate(&self) -> usize {
        if self.is_reference() { 0 } else { FixedPlan::bytes_estimate(self) }
    }

    fn is_reference(&self) -> bool {
        matches!(self.filter.kind, FilterKind::Reference { .. })
    }
}
