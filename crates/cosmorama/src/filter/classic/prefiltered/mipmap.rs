use crate::camera::Footprint;
use crate::filter::classic::method::Method;
use crate::filter::ewa_pyramid::Levels;
use crate::filter::lookup;
use crate::filter::reference::look;
use crate::filter::traits::{Prepared, SetupCost, bounded};
use crate::raster::Rgba;
use crate::world::World;

/// Squares of texels, averaged beforehand. A footprint's longer derivative chooses the level, so that what is narrow one
/// way is blurred that way.
#[derive(Clone, Copy)]
pub(in crate::filter::classic) enum MipMap {
    /// The nearest texel of the nearest level (Dungan, Stenger & Sutty 1978).
    Nearest,
    /// Bilinear interpolation on the two levels around, and between them (Williams 1983).
    Trilinear,
}

impl Method for MipMap {
    fn prepare<'w>(self: Box<Self>, world: &'w World, light: &'w [Rgba]) -> Box<dyn Prepared + 'w> {
        Box::new(PreparedMipMap { levels: Levels::new(world, light), choice: *self })
    }

    fn setup(&self, world: &World) -> SetupCost {
        SetupCost { texels: world.texel_count(), bytes: Levels::bytes(world) }
    }
}

struct PreparedMipMap<'w> {
    levels: Levels<'w>,
    choice: MipMap,
}

impl PreparedMipMap<'_> {
    /// Returns the level whose texels are as wide as the longer derivative, in the view that shows the middle.
    fn level(&self, footprint: &Footprint) -> f64 {
        let (world, _) = self.levels.get(0);
        let owner = world.owner(footprint.direction);
        let seen = owner.and_then(|(view, _)| world.sources()[view].view.texel_footprint(footprint));
        let longer = seen.map_or(1.0, |(_, jacobian)| jacobian.x_axis.length().max(jacobian.y_axis.length()));
        longer.max(1.0).log2().min(self.levels.coarsest() as f64)
    }
}

impl Prepared for PreparedMipMap<'_> {
    fn world(&self) -> &World {
        self.levels.get(0).0
    }

    fn reads(&self, footprint: &Footprint) -> usize {
        let Some(footprint) = bounded(footprint) else { return 0 };
        let level = self.level(&footprint);
        match self.choice {
            MipMap::Nearest => 1,
            MipMap::Trilinear => {
                let levels = level as usize..=level.ceil() as usize;
                levels.map(|level| lookup::reads(self.levels.get(level).0, footprint.direction)).sum()
            }
        }
    }

    fn average(&self, footprint: &Footprint) -> Rgba {
        let Some(footprint) = bounded(footprint) else { return Rgba::TRANSPARENT };
        let level = self.level(&footprint);
        match self.choice {
            MipMap::Nearest => {
                let (world, light) = self.levels.get(level.round() as usize);
                let mut found = Rgba::TRANSPARENT;
                lookup::nearest(world, footprint.direction, |texel, _| found = light[texel as usize]);
                found
            }
            MipMap::Trilinear => {
                let (finer, part) = (level as usize, level.fract() as f32);
                let at = |level| {
                    let (world, light) = self.levels.get(level);
                    look(world, footprint.direction, light).unwrap_or_default()
                };
                if part > 0.0 { at(finer) * (1.0 - part) + at(finer + 1) * part } else { at(finer) }
            }
        }
    }
}
