use super::tables::Tables;
use crate::filter::Kernel;
use crate::filter::traits::{PrepareError, SetupCost};
use crate::raster::Rgba;
use crate::world::World;

/// Method of a filter of the table, before it meets a world.
pub(super) trait Method {
    /// Prepares the filter for texels in the order of a world's light, all of them finite.
    fn tables(self: Box<Self>, world: &World, light: &[Rgba]) -> Box<dyn Tables>;

    /// Returns the cost of preparing the filter.
    fn setup(&self, _world: &World) -> SetupCost {
        SetupCost::default()
    }

    /// Checks that the filter loses no precision over a world.
    fn check(&self, _world: &World) -> Result<(), PrepareError> {
        Ok(())
    }

    /// Returns the kernel by which the filter weighs on the screen; `None` if it has a shape of its own.
    fn kernel(&self) -> Option<Kernel> {
        None
    }

    /// Returns the greatest offset along a side of a footprint, in pixels, of a texel that counts.
    fn reach(&self) -> f64 {
        1.0
    }
}
