//! Wider kernels where views with texels of different sizes meet, so that there are texels on both sides of the edge.

use crate::filter::Kernel;
use crate::sphere::Direction;
use crate::world::{Source, World};

/// Views of different texel sizes that meet at one direction.
///
/// Across the edge between a coarse and a fine view, the coarse view's kernel reaches farther than the fine view's
/// kernel reaches back. Half a large texel from the edge, only large texels would count, all of them on one side.
/// Therefore the kernel for each view widens with the direction's distance beyond that view's edge, up to the size of
/// the coarsest kernel there. It keeps its size on the edge itself, and where views have equal texels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Meeting {
    direction: Direction,
    /// Least size of the kernel's unit, in texels.
    floor: f64,
    /// Least reach of the kernel, in texels.
    reach: f64,
    /// Texel pitch of the coarsest view, in radians. It falls to zero as the direction leaves the reach of that view's
    /// kernel.
    coarsest: f64,
}

impl Meeting {
    /// Returns the views that meet at a direction; `None` in a world whose views have equal texels.
    pub(crate) fn at(world: &World, kernel: &Kernel, direction: Direction) -> Option<Self> {
        if world.has_equal_pitches() {
            return None;
        }
        let (floor, reach) = (kernel.floor, kernel.floor * kernel.radius());
        let pitch = |source: &Source| {
            let is_near = source.reaches(direction, reach * source.texel_pitch);
            let beyond = is_near.then(|| source.texels_beyond(direction))??;
            Some(source.texel_pitch_at(direction) * (1.0 - beyond / reach))
        };
        let near = world.near(direction, || reach * world.largest_pitch());
        let coarsest = near.filter_map(|view| pitch(&world.sources()[view])).fold(0.0, f64::max);
        Some(Self { direction, floor, reach, coarsest })
    }

    /// Returns the texel pitch of the coarsest view, in radians. No view's kernel is wider than one of such texels.
    pub(crate) fn coarsest(&self) -> f64 {
        self.coarsest
    }

    /// Returns the factor by which the kernel is wider for the texels of a view.
    pub(crate) fn widening(&self, source: &Source) -> f64 {
        let most = self.coarsest / source.texel_pitch_at(self.direction);
        if most <= 1.0 || !source.reaches(self.direction, self.reach * self.coarsest) {
            return 1.0;
        }
        source.texels_beyond(self.direction).map_or(1.0, |beyond| (1.0 + beyond / self.floor).min(most))
    }
}
