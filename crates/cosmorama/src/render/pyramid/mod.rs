//! EWA at a bounded cost, from smaller copies of the world wherever a pixel holds many texels.
//!
//! Heckbert 1989 interpolates between two EWA look-ups, in the two levels of a pyramid that fit the ellipse best.

pub(crate) mod level_map;

use rayon::prelude::*;

use super::apply::float::{FloatArithmetic, Uncoded};
use super::batch::window::Level as Instructions;
use super::progress::Watch;
use super::pyramid::level_map::LevelMap;
use super::scan::sampling::Sampling;
use super::scan::wanted::Wanted;
use super::{Plan, Resampler, plan};
use crate::camera::ScreenPixel;
use crate::filter::ewa_pyramid::halving::Halving;
use crate::filter::ewa_pyramid::level::part;
use crate::filter::rim::field_edge::FieldEdge;
use crate::filter::{FilterKind, FilterSettings, KernelTable, PixelTaps};
use crate::raster::{Image, Rgba};
use crate::world::World;

/// Worlds that a conversion is made from. The first is the given one; where the filter asks for it, each further one
/// has half as many texels each way.
pub(crate) struct Pyramid<'a> {
    resampler: &'a Resampler<'a>,
    /// Halved worlds, largest first, each with the mapping that makes its light from the level before.
    levels: Vec<(World, Halving)>,
    map: LevelMap,
}

impl<'a> Pyramid<'a> {
    /// Makes as many levels as the target needs.
    pub(crate) fn new(resampler: &'a Resampler<'a>) -> Self {
        let Resampler { world, target, filter } = resampler;
        let mut levels: Vec<(World, Halving)> = Vec::new();
        if filter.kind != FilterKind::EwaPyramid {
            return Self { resampler, levels, map: LevelMap::finest(target) };
        }
        let edge = edge(resampler);
        let mut map = LevelMap::new(world, target, &filter.kernel, edge);
        while levels.len() < map.coarsest() {
            let finer = levels.last().map_or(*world, |(world, _)| world);
            let Some(coarser) = finer.halved() else { break };
            let halving = Halving::new(finer, &coarser, edge);
            levels.push((coarser, halving));
        }
        map.limit(levels.len());
        Self { resampler, levels, map }
    }

    fn world(&self, level: usize) -> &World {
        level.checked_sub(1).map_or(self.resampler.world, |halved| &self.levels[halved].0)
    }

    /// Returns the conversion from one level.
    fn level(&self, level: usize) -> Resampler<'_> {
        let kind = match self.resampler.filter.kind {
            FilterKind::EwaPyramid => FilterKind::Ewa,
            other => other,
        };
        let filter = FilterSettings { kind, ..self.resampler.filter };
        Resampler { world: self.world(level), target: self.resampler.target, filter }
    }

    /// Returns the patches that need a level; `None` if none does.
    fn wanted(&self, level: usize) -> Option<Wanted> {
        let wanted = plan::wanted(&self.level(level), |rect| self.map.needs(level, rect));
        wanted.any().then_some(wanted)
    }
}

/// Counter of the texels that a pixel takes from all levels together.
pub(crate) struct TexelCount<'a> {
    map: &'a LevelMap,
    levels: Vec<PixelTaps<'a>>,
}

impl<'a> TexelCount<'a> {
    /// Makes the counter for the pixels of a target; `table` belongs to the filter's kernel.
    pub(crate) fn new(pyramid: &'a Pyramid<'a>, table: &'a KernelTable) -> Self {
        let Resampler { target, .. } = pyramid.resampler;
        let taps = |level| PixelTaps::new(pyramid.world(level), target, &pyramid.resampler.filter, table);
        Self { map: &pyramid.map, levels: (0..=pyramid.levels.len()).map(taps).collect() }
    }

    /// Counts the texels of one pixel.
    pub(crate) fn of(&mut self, (column, row): (usize, usize), screen: &ScreenPixel) -> usize {
        let number = self.map.at(row, column);
        let mut count = 0;
        for (level, taps) in self.levels.iter_mut().enumerate() {
            if part(number, level) > 0.0 {
                taps.for_each_texel((column, row), screen, |_| count += 1);
            }
        }
        count
    }
}

/// Returns the edge of the target's field of view, as the filter uses it. `None` if the field is smaller than a few
/// texels, since its pixels are then made from all texels around it.
fn edge<'a>(resampler: &Resampler<'a>) -> Option<FieldEdge<'a>> {
    let pitch = resampler.world.sources().iter().map(|source| source.texel_pitch).fold(0.0, f64::max);
    FieldEdge::of(resampler.target).filter(|edge| edge.is_wider_than(pitch))
}

/// Returns an upper bound of the bytes that the levels of a conversion take, without computing them.
pub(crate) fn bytes(resampler: &Resampler) -> usize {
    let Resampler { world, target, filter } = resampler;
    if LevelMap::new(world, target, &filter.kernel, edge(resampler)).coarsest() == 0 {
        return 0;
    }
    // All coarser levels together have a third of the texels, or little more where sizes are odd. For each texel they
    // keep its light, its solid angle and a few bits.
    let texels = world.texel_count() / 5 * 2;
    texels * (size_of::<Rgba>() + size_of::<f32>() + size_of::<u16>())
        + target.width() * target.height() * size_of::<Rgba>()
}

/// Renders one frame without a plan.
pub(crate) fn render(resampler: &Resampler, texels: &[Rgba], watch: Watch) -> Image<Rgba> {
    let (pyramid, background) = (Pyramid::new(resampler), Rgba::TRANSPARENT);
    if pyramid.levels.is_empty() {
        let light = FloatArithmetic { texels, background, pixels: Uncoded };
        return plan::render((&pyramid.level(0), Sampling::default()), light, Instructions::new(), watch);
    }
    let halvings: Vec<&Halving> = pyramid.levels.iter().map(|(_, halving)| halving).collect();
    let mut image = Image::zeroed(resampler.target.width(), resampler.target.height());
    mix(&mut image, &pyramid.map, &halvings, texels, |level, texels| {
        if watch.is_stopped() {
            return None;
        }
        let (resampler, wanted) = (pyramid.level(level), pyramid.wanted(level)?);
        let (light, task) =
            (FloatArithmetic { texels, background, pixels: Uncoded }, watch.task(level, halvings.len() + 1));
        Some(plan::render((&resampler, Sampling::only(&wanted)), light, Instructions::new(), task))
    });
    image
}

/// Adds up a picture from its levels in a transparent image, after making the light of each in turn. `picture` makes
/// the pixels of a level from its light, or `None` if there are none.
fn mix(
    image: &mut Image<Rgba>,
    map: &LevelMap,
    halvings: &[&Halving],
    texels: &[Rgba],
    picture: impl Fn(usize, &[Rgba]) -> Option<Image<Rgba>>,
) {
    let width = image.width();
    image.pixels_mut().par_iter_mut().for_each(|pixel| *pixel = Rgba::TRANSPARENT);
    let mut light = Vec::new();
    for level in 0..=halvings.len() {
        if level > 0 {
            let finer = if level == 1 { texels } else { &light };
            light = halvings[level - 1].light(finer);
        }
        let Some(picture) = picture(level, if level == 0 { texels } else { &light }) else { continue };
        let rows = image.pixels_mut().par_chunks_mut(width.max(1)).enumerate();
        rows.for_each(|(j, row)| {
            for ((pixel, made), number) in row.iter_mut().zip(picture.row(j)).zip(map.row(j)) {
                *pixel += *made * part(number, level);
            }
        });
    }
}

/// Geometry of a conversion by a pyramid, for any number of frames. It holds how each level is made, which of its
/// texels make each pixel, and the level's part in the pixel.
#[derive(Clone, Debug)]
pub(crate) struct PyramidPlan {
    size: (usize, usize),
    map: LevelMap,
    halvings: Vec<Halving>,
    /// Plan of each level; `None` where nothing is made from it.
    plans: Vec<Option<Plan>>,
}

impl PyramidPlan {
    pub(crate) fn new(resampler: &Resampler, watch: Watch) -> Self {
        let pyramid = Pyramid::new(resampler);
        let task = |level| watch.task(level, pyramid.levels.len() + 1);
        let plan = |level| Some(Plan::of_part(&pyramid.level(level), &pyramid.wanted(level)?, task(level)));
        let plans = (0..=pyramid.levels.len()).map(plan).collect();
        let Pyramid { levels, map, .. } = pyramid;
        let size = (resampler.target.width(), resampler.target.height());
        Self { size, map, halvings: levels.into_iter().map(|(_, halving)| halving).collect(), plans }
    }

    /// Makes one frame in front of a background, in an image of the target's size.
    pub(crate) fn apply_into(&self, texels: &[Rgba], background: Rgba, image: &mut Image<Rgba>) {
        assert_eq!((image.width(), image.height()), self.size, "an image as large as the target");
        let halvings: Vec<&Halving> = self.halvings.iter().collect();
        mix(image, &self.map, &halvings, texels, |level, texels| Some(self.plans[level].as_ref()?.apply(texels)));
        image.lay_over(background);
    }

    /// Returns the number of columns and rows of the target.
    pub(crate) fn size(&self) -> (usize, usize) {
        self.size
    }

    /// Estimates the bytes that the plan of a conversion would hold.
    pub(crate) fn bytes_estimate(resampler: &Resampler) -> usize {
        let pyramid = Pyramid::new(resampler);
        let levels =
            (0..=pyramid.levels.len()).filter_map(|level| Some((pyramid.level(level), pyramid.wanted(level)?)));
        let plans: usize = levels.map(|(level, wanted)| plan::float_bytes_estimate(&level, &wanted)).sum();
        plans + pyramid.levels.iter().map(|(_, halving)| halving.bytes()).sum::<usize>()
    }

    /// Returns the number of bytes that the plan holds.
    pub(crate) fn bytes(&self) -> usize {
        let plans: usize = self.plans.iter().flatten().map(Plan::bytes).sum();
        plans + self.halvings.iter().map(Halving::bytes).sum::<usize>()
    }
}
