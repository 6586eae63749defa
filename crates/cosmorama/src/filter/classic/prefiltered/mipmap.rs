use crate::camera::Footprint;
use crate::filter::classic::method::Method;
use crate::filter::classic::tables::{Lit, Tables};
use crate::filter::ewa_pyramid::Levels;
use crate::filter::lookup;
use crate::filter::reference::look;
use crate::filter::traits::SetupCost;
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
    fn tables(self: Box<Self>, world: &World, light: &[Rgba]) -> Box<dyn Tables> {
        Box::new(Squares { coarser: Levels::new(world, light).into_coarser(), choice: *self })
    }

    fn setup(&self, world: &World) -> SetupCost {
        SetupCost { texels: world.texel_count(), bytes: Levels::bytes(world) }
    }
}

/// Averages of squares of texels.
struct Squares {
    /// Halved worlds and their light, from level 1 on.
    coarser: Vec<(World, Vec<Rgba>)>,
    choice: MipMap,
}

impl Squares {
    /// Returns the level whose texels are as wide as the longer derivative, in the view that shows the middle.
    fn level(&self, world: &World, footprint: &Footprint) -> f64 {
        let owner = world.owner(footprint.direction);
        let seen = owner.and_then(|(view, _)| world.sources()[view].view.texel_footprint(footprint));
        let longer = seen.map_or(1.0, |(_, jacobian)| jacobian.x_axis.length().max(jacobian.y_axis.length()));
        longer.max(1.0).log2().min(self.coarser.len() as f64)
    }

    /// Returns a level's world and its light.
    fn get<'a>(&'a self, of: Lit<'a>, level: usize) -> Lit<'a> {
        level.checked_sub(1).map_or(of, |at| Lit { world: &self.coarser[at].0, light: &self.coarser[at].1 })
    }
}

impl Tables for Squares {
    fn reads(&self, of: Lit, footprint: &Footprint) -> usize {
        let level = self.level(of.world, footprint);
        match self.choice {
            MipMap::Nearest => 1,
            MipMap::Trilinear => {
                let levels = level as usize..=level.ceil() as usize;
                levels.map(|level| lookup::reads(self.get(of, level).world, footprint.direction)).sum()
            }
        }
    }

    fn average(&self, of: Lit, footprint: &Footprint) -> Rgba {
        let level = self.level(of.world, footprint);
        match self.choice {
            MipMap::Nearest => {
                let Lit { world, light } = self.get(of, level.round() as usize);
                let mut found = Rgba::TRANSPARENT;
                lookup::nearest(world, footprint.direction, |texel, _| found = light[texel as usize]);
                found
            }
            MipMap::Trilinear => {
                let (finer, part) = (level as usize, level.fract() as f32);
                let at = |level| {
                    let Lit { world, light } = self.get(of, level);
                    look(world, footprint.direction, light).unwrap_or_default()
                };
                if part > 0.0 { at(finer) * (1.0 - part) + at(finer + 1) * part } else { at(finer) }
            }
        }
    }
}
