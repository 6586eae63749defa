//! EWA on a pyramid: a bounded number of texels, however wide a footprint is.

pub(crate) mod halving;
pub(crate) mod level;
pub(crate) mod texture;

use halving::Halving;
use level::{LevelNeed, LevelRule, part};

use super::Kernel;
use super::ewa::{Averager, Ewa, Pinholes};
use super::traits::{Filter, PrepareError, Prepared, SetupCost, bounded};
use crate::camera::Footprint;
use crate::raster::Rgba;
use crate::world::{Light, World};

/// EWA on a pyramid: the ellipse is averaged on the levels of halved worlds that fit it best, at a bounded cost
/// (Heckbert 1989).
///
/// A footprint reads at most [`MOST_TEXELS`](super::MOST_TEXELS) texels of a view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EwaPyramid {
    /// Kernel that weighs the texels.
    pub kernel: Kernel,
    /// Whether the average is clamped, per channel, to the texels under the footprint.
    pub anti_ringing: bool,
}

impl Default for EwaPyramid {
    fn default() -> Self {
        let Ewa { kernel, anti_ringing } = Ewa::default();
        Self { kernel, anti_ringing }
    }
}

impl Filter for EwaPyramid {
    fn prepare<'w>(&self, world: &'w World, light: &'w Light) -> Result<Box<dyn Prepared + 'w>, PrepareError> {
        light.check(world)?;
        let levels = Levels::new(world, light.texels());
        let pinholes = (0..=levels.coarsest()).map(|level| Pinholes::of(levels.get(level).0)).collect();
        let average = Averager::new(&Ewa { kernel: self.kernel, anti_ringing: self.anti_ringing });
        let rule = LevelRule::new(world, &self.kernel);
        Ok(Box::new(PreparedPyramid { levels, pinholes, rule, average }))
    }

    fn setup(&self, world: &World) -> SetupCost {
        SetupCost { texels: world.texel_count(), bytes: Levels::bytes(world) }
    }
}

/// A world with its light, and halved copies.
pub(crate) struct Levels<'w> {
    world: &'w World,
    light: &'w [Rgba],
    /// Halved worlds and their light, from level 1 on.
    coarser: Vec<(World, Vec<Rgba>)>,
}

impl<'w> Levels<'w> {
    /// Halves a world until nothing is left to halve.
    pub(crate) fn new(world: &'w World, light: &'w [Rgba]) -> Self {
        let mut coarser: Vec<(World, Vec<Rgba>)> = Vec::new();
        loop {
            let (finer, texels) = coarser.last().map_or((world, light), |(world, texels)| (world, texels));
            let Some(halved) = finer.halved() else { break };
            let texels = Halving::new(finer, &halved, None).light(texels);
            coarser.push((halved, texels));
        }
        Self { world, light, coarser }
    }

    /// Returns the bytes that a world's coarser levels take. All together they have a third of its texels, and keep light
    /// and solid angle of each.
    pub(crate) fn bytes(world: &World) -> usize {
        world.texel_count() / 3 * (size_of::<Rgba>() + size_of::<f32>())
    }

    /// Returns a level's world and its light; level 0 is the whole one.
    pub(crate) fn get(&self, level: usize) -> (&World, &[Rgba]) {
        level.checked_sub(1).map_or((self.world, self.light), |at| (&self.coarser[at].0, &self.coarser[at].1))
    }

    /// Returns the halved worlds and their light, from level 1 on.
    pub(crate) fn into_coarser(self) -> Vec<(World, Vec<Rgba>)> {
        self.coarser
    }

    /// Returns the number of the coarsest level.
    pub(crate) fn coarsest(&self) -> usize {
        self.coarser.len()
    }
}

struct PreparedPyramid<'w> {
    levels: Levels<'w>,
    /// Pinhole views of each level, if all views of the level are pinholes.
    pinholes: Vec<Option<Pinholes>>,
    rule: LevelRule,
    average: Averager,
}

impl PreparedPyramid<'_> {
    /// Returns the level number for a footprint, as [`LevelRule`] defines it, and the view that shows the footprint's
    /// centre.
    fn number(&self, footprint: &Footprint) -> (f32, Option<usize>) {
        let holder = self.pinholes[0].as_ref().and_then(|pinholes| pinholes.holder(footprint.direction));
        let view = holder.or_else(|| self.levels.world.owner_view(footprint.direction));
        let level = self.rule.level(view, footprint, LevelNeed::default());
        let coarsest = self.levels.coarsest() as f32;
        (level.map_or(0.0, |level| level as f32).clamp(0.0, coarsest), view)
    }
}

impl Prepared for PreparedPyramid<'_> {
    fn world(&self) -> &World {
        self.levels.world
    }

    fn reads(&self, footprint: &Footprint) -> usize {
        let Some(footprint) = bounded(footprint) else { return 0 };
        let levels = parts(self.number(&footprint).0);
        levels.map(|(level, _)| self.average.reads(self.levels.get(level).0, &footprint)).sum()
    }

    fn average(&self, footprint: &Footprint) -> Rgba {
        let Some(footprint) = bounded(footprint) else { return Rgba::TRANSPARENT };
        let (number, view) = self.number(&footprint);
        let mut sum = Rgba::TRANSPARENT;
        for (level, part) in parts(number) {
            let (world, light) = self.levels.get(level);
            sum += self.average.of((world, self.pinholes[level].as_ref()), light, &footprint, view) * part;
        }
        sum
    }
}

/// Returns the levels that give a part, and their parts.
fn parts(number: f32) -> impl Iterator<Item = (usize, f32)> {
    let finer = number as usize;
    (finer..=finer + 1).map(move |level| (level, part(number, level))).filter(|(_, part)| *part > 0.0)
}
