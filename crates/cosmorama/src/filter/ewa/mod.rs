//! EWA of a footprint, in any world.

mod blocks;
pub(crate) mod cubic;
mod direct;
pub(crate) mod gaussian;
pub(crate) mod lanes;
pub(crate) mod paper;
mod pinhole;
mod prefetch;
mod rows;
pub(crate) mod scratch_pool;
mod tap_lender;

use direct::Direct;
pub(crate) use pinhole::Pinholes;

pub(crate) use tap_lender::TapLender;

use super::Kernel;
use super::taps;
use super::traits::{Filter, PrepareError, Prepared, SetupCost, bounded};
use crate::camera::Footprint;
use crate::raster::Rgba;
use crate::world::{Light, World};

/// Elliptical weighted average (Greene & Heckbert 1986), across the edges of views.
///
/// Its cost grows with the number of texels under a footprint: [`EwaPyramid`](super::EwaPyramid) bounds it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ewa {
    /// Kernel that weighs the texels.
    pub kernel: Kernel,
    /// Whether the average is clamped, per channel, to the texels under the footprint.
    pub anti_ringing: bool,
}

impl Default for Ewa {
    fn default() -> Self {
        Self { kernel: Kernel::ADAPTIVE, anti_ringing: true }
    }
}

impl Ewa {
    /// Prepares the filter for texels in the order of a world's light, all of them finite.
    pub fn of_texels<'w>(&self, world: &'w World, light: &'w [Rgba]) -> Box<dyn Prepared + 'w> {
        Box::new(PreparedEwa { world, pinholes: Pinholes::of(world), light, average: Averager::new(self) })
    }
}

impl Filter for Ewa {
    fn prepare<'w>(&self, world: &'w World, light: &'w Light) -> Result<Box<dyn Prepared + 'w>, PrepareError> {
        light.check(world)?;
        Ok(self.of_texels(world, light.texels()))
    }

    fn setup(&self, _: &World) -> SetupCost {
        SetupCost::default()
    }
}

struct PreparedEwa<'w> {
    world: &'w World,
    pinholes: Option<Pinholes>,
    light: &'w [Rgba],
    average: Averager,
}

impl Prepared for PreparedEwa<'_> {
    fn world(&self) -> &World {
        self.world
    }

    fn reads(&self, footprint: &Footprint) -> usize {
        bounded(footprint).map_or(0, |footprint| self.average.reads(self.world, &footprint))
    }

    fn average(&self, footprint: &Footprint) -> Rgba {
        let views = (self.world, self.pinholes.as_ref());
        let average = |footprint| self.average.of(views, self.light, &footprint, None);
        bounded(footprint).map_or(Rgba::TRANSPARENT, average)
    }
}

/// Average of footprints in any world by one kernel.
pub(crate) struct Averager {
    taps: TapLender,
    anti_ringing: bool,
    /// Fast average for the kernels that it supports.
    direct: Option<Direct>,
}

impl Averager {
    /// Makes the average of a filter.
    pub(crate) fn new(filter: &Ewa) -> Self {
        let (kernel, anti_ringing) = (&filter.kernel, filter.anti_ringing);
        Self { taps: TapLender::new(kernel), anti_ringing, direct: Direct::new(kernel, anti_ringing) }
    }

    /// Averages a footprint; `view` is the view that shows it, if that is known.
    pub(crate) fn of(
        &self,
        views: (&World, Option<&Pinholes>),
        light: &[Rgba],
        footprint: &Footprint,
        view: Option<usize>,
    ) -> Rgba {
        let direct = self.direct.as_ref().and_then(|direct| direct.average(views, light, footprint, view));
        direct.unwrap_or_else(|| self.by_taps(views.0, light, footprint))
    }

    /// Returns the number of texels of a footprint's average.
    pub(crate) fn reads(&self, world: &World, footprint: &Footprint) -> usize {
        self.taps.lend(world, footprint, |taps| taps.as_slice().len())
    }

    /// Averages a footprint by a list of taps, which works anywhere: at seams, poles and rims, too.
    pub(crate) fn by_taps(&self, world: &World, light: &[Rgba], footprint: &Footprint) -> Rgba {
        let average = |taps: &taps::Taps| taps::average(taps.list(), |texel| light[texel as usize], self.anti_ringing);
        self.taps.lend(world, footprint, average)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{FieldStop, PixelGrid, View};
    use crate::projection::{PlanePoint, PlaneRect, ProjectionKind};
    use crate::sphere::{CubeFace, Direction};
    use crate::world::panorama;

    /// Returns light that differs in each texel.
    fn noise(count: usize) -> Vec<Rgba> {
        let value = |texel: usize| (texel.wrapping_mul(2_654_435_761) >> 7) % 1000;
        (0..count).map(|texel| value(texel) as f32 / 999.0).map(|v| Rgba::opaque(v, v * v, 1.0 - v)).collect()
    }

    /// Returns footprints all over the sphere, from narrow to wide, some of them long, in any orientation.
    fn footprints(narrowest: f64, growth: f64) -> impl Iterator<Item = Footprint> {
        Direction::spread(4000).enumerate().map(move |(k, at)| {
            let (right, up) = at.vector().any_orthonormal_pair();
            let (sin, cos) = (k as f64).sin_cos();
            let width = narrowest * growth.powi(k as i32);
            let long = [1.0, 2.0, 0.3][k % 3];
            Footprint::new(at, (right * cos + up * sin) * width, (up * cos - right * sin) * width * long)
        })
    }

    /// Compares the fast average with a list of taps, and returns the number of footprints that have a fast average.
    fn check(world: &World, footprints: impl Iterator<Item = Footprint>) -> usize {
        let light = noise(world.texel_count());
        let averager = Averager::new(&Ewa::default());
        let direct = averager.direct.as_ref().expect("a kernel of cubics");
        let pinholes = Pinholes::of(world);
        let mut count = 0;
        for footprint in footprints {
            let Some(found) = direct.average((world, pinholes.as_ref()), &light, &footprint, None) else { continue };
            let expected = averager.by_taps(world, &light, &footprint);
            let error = (0..4).map(|c| (found.0[c] - expected.0[c]).abs()).fold(0.0, f32::max);
            assert!(error < 2e-3, "{found:?}, not {expected:?}: {footprint:?}");
            count += 1;
        }
        count
    }

    #[test]
    fn the_direct_way_averages_as_taps_do() {
        let world = World::new([("all".to_owned(), panorama(800, 400))]).expect("a view");
        let count = check(&world, footprints(0.004, 1.0008));
        assert!(count > 2000, "{count} by the direct way");
    }

    #[test]
    fn a_kernel_is_a_conic_of_each_face() {
        let rect = PlaneRect { min: PlanePoint::new(-1.0, -1.0), max: PlanePoint::new(1.0, 1.0) };
        let face = |face: CubeFace| View {
            projection: ProjectionKind::PERSPECTIVE,
            orientation: face.orientation(),
            grid: PixelGrid::spanning(64, 64, rect),
            stop: FieldStop::NONE,
        };
        let world = World::new(CubeFace::ALL.map(|at| (at.name().to_owned(), face(at)))).expect("six faces");
        // Up to 0.4 radians: across edges, corners, and horizons of faces.
        let count = check(&world, footprints(0.03, 1.00065));
        assert!(count > 3500, "{count} by the direct way");
    }
}
