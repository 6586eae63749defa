use super::nearest;
use crate::camera::Footprint;
use crate::filter::traits::{Filter, PrepareError, Prepared, SetupCost, bounded};
use crate::raster::Rgba;
use crate::world::{Light, World};

/// The one texel that the middle of a footprint sees, without filtering.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Point;

impl Filter for Point {
    fn prepare<'w>(&self, world: &'w World, light: &'w Light) -> Result<Box<dyn Prepared + 'w>, PrepareError> {
        light.check(world)?;
        Ok(Box::new(PreparedPoint { world, light: light.texels() }))
    }

    fn setup(&self, _: &World) -> SetupCost {
        SetupCost::default()
    }
}

struct PreparedPoint<'w> {
    world: &'w World,
    light: &'w [Rgba],
}

impl Prepared for PreparedPoint<'_> {
    fn world(&self) -> &World {
        self.world
    }

    fn reads(&self, footprint: &Footprint) -> usize {
        let Some(footprint) = bounded(footprint) else { return 0 };
        let mut count = 0;
        nearest(self.world, footprint.direction, |_, _| count += 1);
        count
    }

    fn average(&self, footprint: &Footprint) -> Rgba {
        let mut found = Rgba::TRANSPARENT;
        if let Some(footprint) = bounded(footprint) {
            nearest(self.world, footprint.direction, |texel, _| found = self.light[texel as usize]);
        }
        found
    }
}
