use crate::camera::Footprint;
use crate::filter::traits::{Filter, PrepareError, Prepared, SetupCost, bounded};
use crate::filter::{lookup, reference};
use crate::raster::Rgba;
use crate::world::{Light, World};

/// Bilinear interpolation between the four texels around the middle of a footprint.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Bilinear;

impl Filter for Bilinear {
    fn prepare<'w>(&self, world: &'w World, light: &'w Light) -> Result<Box<dyn Prepared + 'w>, PrepareError> {
        light.check(world)?;
        Ok(Box::new(PreparedBilinear { world, light: light.texels() }))
    }

    fn setup(&self, _: &World) -> SetupCost {
        SetupCost::default()
    }
}

struct PreparedBilinear<'w> {
    world: &'w World,
    light: &'w [Rgba],
}

impl Prepared for PreparedBilinear<'_> {
    fn world(&self) -> &World {
        self.world
    }

    fn reads(&self, footprint: &Footprint) -> usize {
        bounded(footprint).map_or(0, |footprint| lookup::reads(self.world, footprint.direction))
    }

    fn average(&self, footprint: &Footprint) -> Rgba {
        let look = |footprint: Footprint| reference::look(self.world, footprint.direction, self.light);
        bounded(footprint).and_then(look).unwrap_or(Rgba::TRANSPARENT)
    }
}
