use glam::DVec2;

use super::weighing::{ScreenKernel, Weighing, reached};
use crate::camera::Footprint;
use crate::filter::{Kernel, lookup, semi_axes};
use crate::world::World;

/// Samples on a grid of the screen, in the round kernel, each mapped to the texels and interpolated there: the screen is
/// sampled as finely as the texture is (Gangnet, Perny & Coueignoux 1982).
pub(super) struct Gangnet(pub(super) ScreenKernel);

/// Greatest number of samples along the kernel's radius.
const MOST: f64 = 256.0;

impl Gangnet {
    /// Returns the samples along the kernel's radius: as many as the finest view has texels there.
    fn samples(&self, world: &World, footprint: &Footprint) -> i64 {
        let radius = self.0.radius();
        let seen = world.sources().iter().filter_map(|source| reached(source, footprint, radius));
        let texels = seen.map(|seen| semi_axes(seen.jacobian)[0] * radius).fold(1.0, f64::max);
        texels.min(MOST).ceil() as i64
    }
}

impl Weighing for Gangnet {
    fn for_each_texel(&self, world: &World, footprint: &Footprint, mut visit: impl FnMut(usize, f64)) {
        let count = self.samples(world, footprint);
        for (i, j) in (-count..=count).flat_map(|j| (-count..=count).map(move |i| (i, j))) {
            let at = DVec2::new(i as f64, j as f64) * (self.0.radius() / count as f64);
            let weight = self.0.weight(at.length_squared());
            let there = if weight > 0.0 { footprint.direction_at(at.x, at.y) } else { None };
            let Some(there) = there.filter(|there| there.dot(footprint.direction) > 0.0) else { continue };
            lookup::bilinear(world, there, |texel, part| visit(texel as usize, weight * part));
        }
    }
    fn kernel(&self) -> Option<Kernel> {
        Some(self.0.kernel())
    }

    fn reach(&self) -> f64 {
        self.0.radius()
    }
}
