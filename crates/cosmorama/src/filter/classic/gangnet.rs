use glam::DVec2;

use super::region::{add, reached};
use super::screen_kernel::ScreenKernel;
use crate::camera::Footprint;
use crate::filter::traits::{Prepared, bounded};
use crate::filter::{lookup, semi_axes};
use crate::raster::Rgba;
use crate::world::World;

/// Samples on a grid of the screen, in the round kernel, each mapped to the texels and interpolated there: the screen is
/// sampled as finely as the texture is (Gangnet, Perny & Coueignoux 1982).
pub(super) struct PreparedGangnet<'w> {
    pub(super) world: &'w World,
    pub(super) light: &'w [Rgba],
    pub(super) kernel: ScreenKernel,
}

/// Greatest number of samples along the kernel's radius.
const MOST: f64 = 256.0;

impl PreparedGangnet<'_> {
    /// Returns the samples along the kernel's radius: as many as the finest view has texels there.
    fn samples(&self, footprint: &Footprint) -> i64 {
        let sources = self.world.sources().iter();
        let seen = sources.filter_map(|source| reached(source, footprint));
        let texels = seen.map(|seen| semi_axes(seen.jacobian)[0]).fold(1.0, f64::max);
        texels.min(MOST).ceil() as i64
    }

    /// Calls `visit` with the texels around each sample and their weights.
    fn for_each_texel(&self, footprint: &Footprint, mut visit: impl FnMut(u32, f64)) {
        let count = self.samples(footprint);
        for (i, j) in (-count..=count).flat_map(|j| (-count..=count).map(move |i| (i, j))) {
            let at = DVec2::new(i as f64, j as f64) * (ScreenKernel::RADIUS / count as f64);
            let weight = self.kernel.weight(at.length_squared());
            let there = if weight > 0.0 { footprint.direction_at(at.x, at.y) } else { None };
            let Some(there) = there.filter(|there| there.dot(footprint.direction) > 0.0) else { continue };
            lookup::bilinear(self.world, there, |texel, part| visit(texel, weight * part));
        }
    }
}

impl Prepared for PreparedGangnet<'_> {
    fn world(&self) -> &World {
        self.world
    }

    fn reads(&self, footprint: &Footprint) -> usize {
        let mut count = 0;
        let footprint = bounded(footprint);
        footprint.iter().for_each(|footprint| self.for_each_texel(footprint, |_, _| count += 1));
        count
    }

    fn average(&self, footprint: &Footprint) -> Rgba {
        let Some(footprint) = bounded(footprint) else { return Rgba::TRANSPARENT };
        let (mut sum, mut weights) = ([0f64; 4], 0f64);
        self.for_each_texel(&footprint, |texel, weight| {
            add(&mut sum, self.light[texel as usize], weight);
            weights += weight;
        });
        if weights > 0.0 { Rgba(sum.map(|channel| (channel / weights) as f32)) } else { Rgba::TRANSPARENT }
    }
}
