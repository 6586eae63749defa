//! Pixels that the input leaves: what no view covers, texels that are missing, and what lies around the picture.

use cosmorama::filter::Ewa;
use cosmorama::raster::{Image, Rgba};
use cosmorama::render::Continuation;

use super::pictures::Engine;
use crate::diagnostic::{MISSING, Result, bail};
use crate::engine::{FrameLight, Posed, Texels};
use crate::input::InputView;
use crate::job::coverage::Coverage;

impl Engine<'_> {
    /// Applies the opacity of the input.
    pub(super) fn thin(&self, image: &mut Image<Rgba>) {
        let opacity = self.job.opacity;
        if opacity < 1.0 {
            image.pixels_mut().iter_mut().for_each(|pixel| *pixel = *pixel * opacity);
        }
    }

    /// Fills what no view of the input covers.
    pub(super) fn fill_unseen(
        &self,
        (posed, index): (&Posed, usize),
        light: &FrameLight,
        image: &mut Image<Rgba>,
    ) -> Result<()> {
        let (job, target) = (self.job, &posed.views[index]);
        match job.coverage {
            Coverage::Complete => {}
            Coverage::Fill(colour) => posed.mask(job, index).fill_unseen(image, colour),
            Coverage::Continue(beyond) => {
                let Texels::Float(worlds) = light.texels() else { bail!("light of 8 bits where floats were expected") };
                let place = target.world(worlds.len());
                let world = job.world(target);
                let Some(edge) = self.edges[place].get_or_init(|| Continuation::of(world)) else { return Ok(()) };
                let filter = Ewa { kernel: job.filter.kernel, anti_ringing: job.filter.anti_ringing };
                let prepared = filter.of_texels(world, &worlds[place]);
                posed.mask(job, index).fill_by(image, |i, j| {
                    let seen = target.view.screen_pixel(i, j).map(|screen| screen.footprint);
                    let instead = seen.and_then(|pixel| edge.footprint(world, &pixel, beyond));
                    instead.map_or(Rgba::TRANSPARENT, |footprint| prepared.average(&footprint))
                });
            }
        }
        Ok(())
    }

    /// Fills pixels of opaque inputs whose texels are missing: the remaining texels make the pixel, and a pixel without
    /// any is treated as one without a view.
    pub(super) fn close_holes(
        &self,
        (posed, index): (&Posed, usize),
        (frame, light): (Option<u64>, &FrameLight),
        image: &mut Image<Rgba>,
    ) -> Result<()> {
        if !self.has_holes(light) {
            return Ok(());
        }
        let fill = self.job.fill_for_missing();
        let empty = posed.mask(self.job, index).close_holes(image, fill.unwrap_or(Rgba::TRANSPARENT));
        if empty > 0 && fill.is_none() {
            let culprit =
                |(view, count): (&InputView, usize)| format!("{} ({count})", view.files.path(frame).display());
            let culprits: Vec<_> = self.incomplete(light).map(culprit).collect();
            bail!(
                NotANumber: "in {}, {}{} nothing but missing pixels (NaN), found in {}; render those again, or fill the \
                 gaps with {MISSING} COLOR or {MISSING} transparent",
                posed.views[index].name,
                // Of a strip.
                if self.job.is_by_strips() { "at least " } else { "" },
                counted(empty, "sees", "see"),
                culprits.join(", ")
            );
        }
        Ok(())
    }

    pub(super) fn lay_background(&self, (posed, index): (&Posed, usize), image: &mut Image<Rgba>) {
        let background = self.job.light.background;
        if !self.job.light.channels.has_alpha() {
            image.lay_over(background);
        } else if background != Rgba::TRANSPARENT {
            posed.mask(self.job, index).surround(image, background);
        }
    }
}

/// Counts pixels, with the verb for one and that for several.
pub(super) fn counted(pixels: usize, one: &str, several: &str) -> String {
    if pixels == 1 { format!("1 pixel {one}") } else { format!("{pixels} pixels {several}") }
}
