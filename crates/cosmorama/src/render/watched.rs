use super::progress::Watch;
use super::{Arithmetic, Plan, Progress, Resampler, Stopped};
use crate::filter::ClassicTables;
use crate::raster::{FixedCodec, FixedLight, Image, Rgba};

/// A [`Resampler`] whose work is watched, and may be stopped.
///
/// Its methods make the same pixels as the resampler's.
///
/// ```
/// use std::ops::ControlFlow;
///
/// use cosmorama::prelude::*;
///
/// let (world, light) = World::from_panorama(Image::filled(64, 32, Rgba::opaque(0.5, 0.5, 0.5)))?;
/// let dome = CameraModel::from(FulldomeCamera::default()).view(32, 32)?;
/// let told = |fraction: f64| {
///     println!("{:.0} %", 100.0 * fraction);
///     ControlFlow::Continue(())
/// };
/// let frame = Resampler::new(&world, &dome).watched(&told).render(light.texels())?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy)]
pub struct Watched<'a> {
    /// Conversion to do.
    pub resampler: Resampler<'a>,
    /// Receiver of its progress.
    pub progress: &'a dyn Progress,
}

impl<'a> Resampler<'a> {
    /// Returns the conversion with a receiver of its progress.
    pub const fn watched(self, progress: &'a dyn Progress) -> Watched<'a> {
        Watched { resampler: self, progress }
    }
}

impl Watched<'_> {
    /// Renders one frame, like [`Resampler::render`].
    ///
    /// # Errors
    /// If the work is stopped.
    ///
    /// # Panics
    /// As [`Resampler::render`].
    pub fn render(&self, texels: &[Rgba]) -> Result<Image<Rgba>, Stopped> {
        self.render_over(texels, Rgba::TRANSPARENT)
    }

    /// Renders over a background, like [`Resampler::render_over`].
    ///
    /// # Errors
    /// If the work is stopped.
    ///
    /// # Panics
    /// As [`Resampler::render`].
    pub fn render_over(&self, texels: &[Rgba], background: Rgba) -> Result<Image<Rgba>, Stopped> {
        self.render_by(None, texels, background)
    }

    /// Renders over a background by tables of the light that were made before, if there are any, like [`Resampler::render_by`].
    ///
    /// # Errors
    /// If the work is stopped.
    ///
    /// # Panics
    /// As [`Resampler::render`].
    pub fn render_by(
        &self,
        tables: Option<&ClassicTables>,
        texels: &[Rgba],
        background: Rgba,
    ) -> Result<Image<Rgba>, Stopped> {
        Watch::over(self.progress, |watch| self.resampler.light((texels, tables), background, watch))
    }

    /// Renders one frame of 8 bits, like [`Resampler::render_fixed`].
    ///
    /// # Errors
    /// If the work is stopped.
    ///
    /// # Panics
    /// As [`Resampler::render_fixed`].
    pub fn render_fixed(&self, light: &FixedLight, codec: &FixedCodec) -> Result<Image<[u8; 3]>, Stopped> {
        Watch::over(self.progress, |watch| self.resampler.codes(light, codec, watch))
    }

    /// Compiles the geometry, like [`Resampler::plan`].
    ///
    /// # Errors
    /// If the work is stopped.
    pub fn plan(&self, arithmetic: Arithmetic) -> Result<Option<Plan>, Stopped> {
        Watch::over(self.progress, |watch| Plan::new(&self.resampler, arithmetic, watch))
    }
}
