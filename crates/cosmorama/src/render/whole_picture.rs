//! Whole pictures, and the plans that make many of them: methods of [`Resampler`].

use rayon::prelude::*;

use super::apply::fixed::FixedArithmetic;
use super::apply::float::{FloatArithmetic, Uncoded};
use super::batch::window::Level;
use super::picture::two_pass;
use super::plan::{self, Arithmetic, Plan};
use super::progress::{Progress, Stopped, Watch};
use super::scan::sampling::Sampling;
use super::{Resampler, picture, pyramid};
use crate::filter::lookup::labels::PreparedLabels;
use crate::filter::{Classic, ClassicTables, Filter, FilterKind, Labels, reference};
use crate::raster::{FixedCodec, FixedLight, Image, Rgba};

impl Resampler<'_> {
    /// Renders one frame without storing the geometry. `texels` is the world's buffer of light.
    ///
    /// A [`Plan`] makes the same pixels. Whether the filter loses precision over the world, [`FilterSettings::check`](crate::filter::FilterSettings::check) tells
    /// beforehand.
    ///
    /// Pixels are premultiplied by their coverage: transparent outside the lens. A pixel just beyond the world's last
    /// texel takes what its kernel still reaches. [`super::ScreenMask`] tells which pixels see nothing.
    ///
    /// # Panics
    /// If `texels` is not as long as [`World::texel_count`](crate::world::World::texel_count) says.
    pub fn render(&self, texels: &[Rgba]) -> Image<Rgba> {
        self.render_over(texels, Rgba::TRANSPARENT)
    }

    /// Renders over a background in linear, premultiplied light.
    ///
    /// # Panics
    /// As [`Resampler::render`].
    pub fn render_over(&self, texels: &[Rgba], background: Rgba) -> Image<Rgba> {
        self.light((texels, None), background, Watch::NONE)
    }

    /// Renders over a background by tables of the light that were made before, for other pictures, too: [`FilterSettings::tables`](crate::filter::FilterSettings::tables).
    ///
    /// # Panics
    /// As [`Resampler::render`].
    pub fn render_by(&self, tables: Option<&ClassicTables>, texels: &[Rgba], background: Rgba) -> Image<Rgba> {
        self.light((texels, tables), background, Watch::NONE)
    }

    /// Renders light over a background, until the work is done or stopped. What tables the filter has are made unless they are given.
    pub(super) fn light(
        &self,
        (texels, tables): (&[Rgba], Option<&ClassicTables>),
        background: Rgba,
        watch: Watch,
    ) -> Image<Rgba> {
        assert_eq!(texels.len(), self.world.texel_count(), "one texel of light for each texel of the world");
        let mut image = match self.filter.kind {
            FilterKind::Ewa | FilterKind::Point | FilterKind::Bilinear => {
                return plan::render(
                    (self, Sampling::default()),
                    FloatArithmetic { texels, background, pixels: Uncoded },
                    Level::new(),
                    watch,
                );
            }
            FilterKind::Reference { samples } => {
                let filter = self.filter.reference(samples);
                self.by_rows(watch, |row| reference::fill_row(self.world, self.target, &filter, texels, row))
            }
            FilterKind::Labels(rule) => {
                let labels = Labels { rule, kernel: self.filter.kernel };
                let prepared = PreparedLabels::new(&labels, self.world, texels);
                self.by_rows(watch, |row| prepared.fill_row(self.target, row))
            }
            FilterKind::Classic(Classic::TwoPass) => {
                two_pass::render((self.world, self.target), &self.filter.kernel, texels, watch)
            }
            FilterKind::Classic(classic) => {
                let made = || classic.with(self.filter.kernel).tables(self.world, texels);
                let prepared = tables.cloned().unwrap_or_else(made).over(self.world, texels);
                self.by_rows(watch, |row| picture::fill_row(&*prepared, self.target, row))
            }
            FilterKind::EwaPyramid => pyramid::render(self, texels, watch),
        };
        image.lay_over(background);
        image
    }

    /// Renders light, of some patches or through a lens, by an elliptical filter. Other pixels are transparent.
    pub(crate) fn render_sampled(
        &self,
        sampling: Sampling,
        texels: &[Rgba],
        progress: &dyn Progress,
    ) -> Result<Image<Rgba>, Stopped> {
        let arithmetic = FloatArithmetic { texels, background: Rgba::TRANSPARENT, pixels: Uncoded };
        Watch::over(progress, |watch| plan::render((self, sampling), arithmetic, Level::new(), watch))
    }

    /// Renders one opaque frame of 8 bits from light of 15 bits. The code values of each pixel differ by at most one
    /// from those of [`Resampler::render`].
    ///
    /// # Panics
    /// If `light` is not that of the world's texels.
    pub fn render_fixed(&self, light: &FixedLight, codec: &FixedCodec) -> Image<[u8; 3]> {
        self.codes(light, codec, Watch::NONE)
    }

    /// Renders the code values of a picture, until the work is done or stopped.
    pub(super) fn codes(&self, light: &FixedLight, codec: &FixedCodec, watch: Watch) -> Image<[u8; 3]> {
        assert!(light.sizes().eq(self.world.view_sizes()), "light of the world's views");
        if !Arithmetic::Fixed.has_plan_of(self.filter.kind) {
            let texels: Vec<Rgba> = (0..light.len()).map(|texel| light.rgba(texel)).collect();
            return codec.encode(&self.light((&texels, None), Rgba::TRANSPARENT, watch));
        }
        plan::render((self, Sampling::default()), FixedArithmetic { light, codec }, Level::new(), watch)
    }

    /// Compiles the geometry for any number of frames. Returns `None` for `reference`, and for `ewa-pyramid` in
    /// integers.
    pub fn plan(&self, arithmetic: Arithmetic) -> Option<Plan> {
        Plan::new(self, arithmetic, Watch::NONE)
    }

    /// Fills a picture row by row.
    fn by_rows(&self, watch: Watch, fill: impl Fn((usize, &mut [Rgba])) + Sync) -> Image<Rgba> {
        let target = self.target;
        let mut image = Image::filled(target.width(), target.height(), Rgba::TRANSPARENT);
        let parts = watch.parts(target.height());
        image.pixels_mut().par_chunks_mut(target.width().max(1)).enumerate().for_each(|row| {
            parts.part(|| fill(row));
        });
        image
    }

    /// Estimates the number of bytes that [`Resampler::plan`] would hold, from some of the rows and without keeping
    /// anything. It is 0 where there is no plan.
    pub fn plan_bytes_estimate(&self, arithmetic: Arithmetic) -> usize {
        plan::bytes_estimate(self, arithmetic)
    }

    /// Returns the greatest number of bytes that the filter keeps beside the world's light while a frame is made: the levels
    /// of a pyramid, a table of sums, or sums of two passes.
    pub fn filter_bytes(&self) -> usize {
        match self.filter.kind {
            FilterKind::EwaPyramid => pyramid::bytes(self),
            FilterKind::Classic(Classic::TwoPass) => two_pass::bytes(self.target),
            _ => self.filter.setup(self.world).bytes,
        }
    }
}
