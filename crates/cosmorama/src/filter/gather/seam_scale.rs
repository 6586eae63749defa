//! Where views of different texels meet, a kernel must find texels on both sides of the edge.

use crate::filter::Kernel;
use crate::sphere::Direction;
use crate::world::{Source, World};

/// What of a world's views meets at one direction.
///
/// Beside an edge, the kernel of a coarse view reaches further beyond it than that of a fine one reaches back: half a large
/// texel from the edge only large ones would count, all to one side. So as far as a direction lies beyond a view's edge, so
/// much wider is the kernel among that view's texels, up to the coarsest kernel there. It is as it was on the edge itself, and
/// everywhere where views are alike.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Meeting {
    direction: Direction,
    /// Texels that the kernel's unit is at least.
    floor: f64,
    /// Texels that the kernel reaches at least.
    reach: f64,
    /// Texel pitch of the coarsest view, in radians, reduced with distance from where its kernel starts to reach.
    coarsest: f64,
}

impl Meeting {
    /// What meets at a direction; `None` in a world whose views are alike.
    pub(crate) fn at(world: &World, kernel: &Kernel, direction: Direction) -> Option<Self> {
        let sources = world.sources();
        let pitches = || sources.iter().map(|source| source.texel_pitch);
        if pitches().all(|pitch| pitch == sources[0].texel_pitch) {
            return None;
        }
        let (floor, reach) = (kernel.floor, kernel.floor * kernel.radius());
        let pitch = |source: &Source| {
            let is_near = source.reaches(direction, reach * source.texel_pitch);
            let beyond = is_near.then(|| source.texels_beyond(direction))??;
            Some(source.texel_pitch_at(direction) * (1.0 - beyond / reach))
        };
        let coarsest = sources.iter().filter_map(pitch).fold(0.0, f64::max);
        Some(Self { direction, floor, reach, coarsest })
    }

    /// By how much a kernel is wider among the texels of a view.
    pub(crate) fn widening(&self, source: &Source) -> f64 {
        let most = self.coarsest / source.texel_pitch_at(self.direction);
        if most <= 1.0 || !source.reaches(self.direction, self.reach * self.coarsest) {
            return 1.0;
        }
        source.texels_beyond(self.direction).map_or(1.0, |beyond| (1.0 + beyond / self.floor).min(most))
    }
}
