//! Wider kernels where views of different texels meet, so that there are texels on both sides of the edge.

use crate::filter::Kernel;
use crate::sphere::Direction;
use crate::world::{Source, World};

/// Views of different texel sizes that meet at one direction.
///
/// Beside an edge, the kernel of a coarse view reaches further beyond it than that of a fine view reaches back. Half a
/// large texel from the edge only large texels would count, all to one side. So among the texels of a view, the kernel
/// widens with the direction's distance beyond that view's edge, up to the coarsest kernel there. On the edge itself it
/// is unchanged, and so it is where views are alike.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Meeting {
    direction: Direction,
    /// Least unit of the kernel, in texels.
    floor: f64,
    /// Least reach of the kernel, in texels.
    reach: f64,
    /// Texel pitch of the coarsest view, in radians, reduced with distance from where its kernel starts to reach.
    coarsest: f64,
}

impl Meeting {
    /// Returns the views that meet at a direction; `None` in a world whose views are alike.
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

    /// Returns the factor by which a kernel is wider among the texels of a view.
    pub(crate) fn widening(&self, source: &Source) -> f64 {
        let most = self.coarsest / source.texel_pitch_at(self.direction);
        if most <= 1.0 || !source.reaches(self.direction, self.reach * self.coarsest) {
            return 1.0;
        }
        source.texels_beyond(self.direction).map_or(1.0, |beyond| (1.0 + beyond / self.floor).min(most))
    }
}
