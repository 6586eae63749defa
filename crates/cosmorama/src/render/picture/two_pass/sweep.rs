use std::ops::AddAssign;

use glam::DVec4;

use crate::camera::View;
use crate::filter::TwoPass;
use crate::raster::Rgba;
use crate::world::World;

/// Light of a pixel, by the views that have been summed.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sum {
    /// Light, times the share that it is of.
    pub(super) light: DVec4,
    /// Share of the pixel's weight that views have.
    pub(super) share: f64,
}

impl AddAssign for Sum {
    fn add_assign(&mut self, other: Self) {
        self.light += other.light;
        self.share += other.share;
    }
}

/// A picture to be made of a world.
pub(super) struct Sweep<'a> {
    pub(super) world: &'a World,
    pub(super) target: &'a View,
    pub(super) light: &'a [Rgba],
    pub(super) kernel: TwoPass,
}
