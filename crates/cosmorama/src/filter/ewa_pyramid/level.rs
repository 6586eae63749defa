use std::f64::consts::PI;

use glam::{DMat2, DVec2};

use crate::camera::{Footprint, PixelPoint};
use crate::filter::Kernel;
use crate::filter::gather::ellipse::semi_axes;
use crate::filter::gather::{is_regular, reach, texels_of};
use crate::projection::{Projection, ProjectionKind};
use crate::sphere::Direction;
use crate::world::{Source, World};

/// Least number of texels on the finer of two levels within the kernel's unit, along its minor axis. The greatest
/// number is twice as many. For the default kernel this makes 1.75 to 3.5 texels a pixel. A greater value is nearer to
/// exact EWA, but reads more texels.
const UNIT: f64 = 1.4;

/// Ratio of length to width above which a kernel is widened, so that the number of its texels stays bounded.
const LONGEST: f64 = 16.0;

/// Part of the interval between two levels, at its end, in which the two are blended. Before it only the finer level is
/// read, which is nearer to exact EWA.
const BLENDED: f32 = 0.25;

/// Number of levels by which the level is finer beside a steep rim of a view, where the size of texels changes quickly.
/// It applies beside the edge of a target's field of view as well.
const FINER: f64 = 2.0;

/// Distance from a steep rim, in pixels, within which levels are finer.
const BESIDE_RIM: f64 = 4.0;

/// Greatest number of texels of a view that [`EwaPyramid`](super::EwaPyramid) averages for one footprint, both levels
/// together, in any projection. Tests hold it at poles, rims and seams.
pub const MOST_TEXELS: usize = 1 << 14;

/// Greatest number of texels of one view under a kernel on one level, as measured across the kernel. Where there would
/// be more, as around a pole at which texels converge, a coarser level is taken. A coarser level that is blended in has
/// at most half as many.
const MOST_ON_LEVEL: f64 = 10_000.0;

/// Radius around a footprint within which its level must suit other footprints, as a part of
/// [`LevelNeed::pixels_around`]. Less than one suffices, since levels are interpolated between pixels.
const AROUND: f64 = 0.75;

/// Rule that chooses the level of a pyramid for a footprint, as a real number. Its whole part is the finer of two
/// levels.
///
/// The number is the logarithm, to base 2, of the footprint's minor axis in texels of the view that shows it. Where
/// derivatives do not tell how many texels a footprint holds, the number is great enough to leave no more than
/// [`MOST_ON_LEVEL`].
pub(crate) struct LevelRule {
    kernel: Kernel,
    /// Geometry of the views: for each view, its levels from the finest on.
    views: Vec<Vec<Source>>,
    densities: Vec<Density>,
}

/// Texels in a steradian of a view.
#[derive(Clone, Copy, Debug)]
enum Density {
    /// At most so many.
    Bounded(f64),
    /// In rows of one latitude, whose texels are equally far apart in longitude: so many at the equator.
    Rows(f64),
    /// Any number: texels converge.
    Unbounded,
}

/// Conditions that a level must meet.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LevelNeed {
    /// Whether the edge of a target's field of view may cut the footprint.
    pub(crate) is_cut: bool,
    /// Distance around the footprint, in pixels, within which the level must suit all footprints.
    pub(crate) pixels_around: f64,
}

impl LevelRule {
    /// Makes the rule for a world's views.
    pub(crate) fn new(world: &World, kernel: &Kernel) -> Self {
        let levels = |source: &Source| std::iter::successors(Some(source.clone()), Source::coarser).collect();
        let views = world.sources().iter();
        Self {
            kernel: *kernel,
            views: views.clone().map(levels).collect(),
            densities: views.map(Density::of).collect(),
        }
    }

    /// Returns the level for a footprint that `view` shows, or that lies beside all views. `None` where no view is
    /// near.
    pub(crate) fn level(&self, view: Option<usize>, footprint: &Footprint, need: LevelNeed) -> Option<f64> {
        view.and_then(|view| self.level_in(view, footprint, need)).or_else(|| self.level_beside(footprint, need))
    }

    /// Returns the level for a footprint that is in a view; `None` where derivatives do not tell how many texels it has
    /// there.
    fn level_in(&self, view: usize, footprint: &Footprint, need: LevelNeed) -> Option<f64> {
        let source = &self.views[view][0];
        let pixels = BESIDE_RIM + need.pixels_around;
        let (_, jacobian) = source.view.texel_footprint(footprint)?;
        // Around a pole, a footprint holds whole rows on every level, so that widening it would not help.
        let longest = if source.period.is_some() { f64::INFINITY } else { LONGEST };
        let level = level_of(jacobian, &self.kernel, longest);
        if !level.is_finite() {
            return None;
        }
        let rim = if need.is_cut { 1.0 } else { nearness_of_rim(source, footprint, pixels) };
        let level = level - FINER * rim;
        if rim == 0.0 && is_regular(&self.kernel, source, footprint) {
            return Some(level);
        }
        Some(level.max(self.least(view, footprint, level, need)))
    }

    /// Returns the level for a footprint beside all views, or on a pole of one. It follows from the size of the texels
    /// that the kernel may reach. `None` where it reaches none.
    fn level_beside(&self, footprint: &Footprint, need: LevelNeed) -> Option<f64> {
        let pixel = footprint.jacobian.solid_angle().sqrt();
        let level = |(view, levels): (usize, &Vec<Source>)| {
            let source = &levels[0];
            if texels_of(&self.kernel, source, footprint, 0.0) == 0.0 {
                return None;
            }
            let texel = source.texel_pitch_at(footprint.direction).min(source.texel_pitch);
            let level = level_of(DMat2::from_diagonal(DVec2::splat(pixel / texel)), &self.kernel, LONGEST);
            Some(level.max(self.least(view, footprint, level, need)))
        };
        self.views.iter().enumerate().filter_map(level).reduce(f64::max)
    }

    /// Returns the least level, `from` or coarser, on which a footprint holds at most [`MOST_ON_LEVEL`] texels of a
    /// view.
    fn least(&self, view: usize, footprint: &Footprint, from: f64, need: LevelNeed) -> f64 {
        let beside = AROUND * need.pixels_around * width(footprint);
        let levels = &self.views[view];
        let first = (from.max(0.0) as usize).min(levels.len() - 1);
        let radius = beside + reach(&self.kernel, footprint, levels[first].texel_pitch, self.kernel.floor);
        let density = self.densities[view].within(&levels[0], footprint.direction, radius);
        let around = PI * radius * radius * density * 0.25f64.powi(first as i32);
        let all = levels[first].view.width() * levels[first].view.height();
        if around.min(all as f64) < 0.5 * MOST_ON_LEVEL {
            // Nothing needs to be measured.
            return from;
        }
        let mut finer: Option<f64> = None;
        for (level, source) in levels.iter().enumerate().skip(first) {
            let texels = texels_of(&self.kernel, source, footprint, beside);
            if texels <= MOST_ON_LEVEL {
                // As the count on this level rises to the limit, the number rises to the next level, so that the latter
                // is blended in gradually.
                let before = match finer {
                    Some(finer) => (MOST_ON_LEVEL / texels).ln() / (finer / texels).ln(),
                    None => (MOST_ON_LEVEL / texels).log2(),
                };
                return (level + 1) as f64 - before;
            }
            finer = Some(texels);
        }
        (levels.len() - 1) as f64
    }
}

impl Density {
    fn of(source: &Source) -> Self {
        const STEPS: usize = 32;
        let view = &source.view;
        if matches!(view.projection, ProjectionKind::Equirectangular(_)) {
            let step = view.grid.step();
            return Self::Rows((step.x * step.y).abs().recip());
        }
        if source.period.is_some() || !source.has_bounded_texels() {
            return Self::Unbounded;
        }
        let at = |size: usize, step: usize| size as f64 * step as f64 / STEPS as f64;
        let points = (0..=STEPS).flat_map(|j| (0..=STEPS).map(move |i| (i, j)));
        let point = |(i, j)| PixelPoint::new(at(view.width(), i), at(view.height(), j));
        let least = points.filter_map(|at| view.solid_angle(point(at))).fold(f64::INFINITY, f64::min);
        Self::Bounded(least.recip())
    }

    /// Returns the greatest number of texels in a steradian within `radius` radians of a direction; infinite at a pole.
    fn within(self, source: &Source, direction: Direction, radius: f64) -> f64 {
        match self {
            Self::Bounded(most) => most,
            // The margin is the cosine of the latitude, which falls by no more than the angle.
            Self::Rows(equator) => equator / (source.view.margin(direction) - radius).max(0.0),
            Self::Unbounded => f64::INFINITY,
        }
    }
}

/// Returns the larger side of a pixel as an angle, in radians.
pub(crate) fn width(footprint: &Footprint) -> f64 {
    footprint.jacobian.dx.length().max(footprint.jacobian.dy.length())
}

/// Returns how near a footprint is to a steep rim of a view: 1 within `pixels` of it, falling to 0 one pixel further
/// away.
fn nearness_of_rim(source: &Source, footprint: &Footprint, pixels: f64) -> f64 {
    if !source.view.projection.has_steep_rim() {
        return 0.0;
    }
    (pixels + 1.0 - source.view.margin(footprint.direction) / width(footprint)).clamp(0.0, 1.0)
}

/// Returns the level for a footprint with this Jacobian, in texels; 0 or less means the finest level.
pub(super) fn level_of(jacobian: DMat2, kernel: &Kernel, longest: f64) -> f64 {
    let [major, minor] = semi_axes(jacobian);
    let width = minor.max(major / longest);
    // A pixel that holds no more than one texel needs no coarser level.
    (width / (UNIT / kernel.scale).max(1.0)).log2().max(-1.0)
}

/// Returns whether a level is coarser than both levels that a level number blends.
pub(crate) fn is_beyond(number: f32, level: usize) -> bool {
    level > 0 && number <= level as f32 - BLENDED
}

/// Returns whether a level is finer than both levels that a level number blends.
pub(crate) fn is_before(number: f32, level: usize) -> bool {
    number >= level as f32 + 1.0
}

/// Returns the weight of a level in a pixel with this level number.
pub(crate) fn part(number: f32, level: usize) -> f32 {
    let beyond = number.max(0.0) - level as f32;
    let coarser = |way: f32| ((way - 1.0) / BLENDED + 1.0).clamp(0.0, 1.0);
    if beyond < 0.0 { coarser(beyond + 1.0) } else { 1.0 - coarser(beyond) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_add_to_one() {
        for number in [-1.0, 0.0, 0.2, 0.5, 1.0, 1.7, 3.0, 3.4f32] {
            let parts: Vec<f32> = (0..6).map(|level| part(number, level)).collect();
            assert!((parts.iter().sum::<f32>() - 1.0).abs() < 1e-6, "{number}: {parts:?}");
            for (level, part) in parts.iter().enumerate() {
                let is_left_out = is_beyond(number, level) || is_before(number, level);
                assert!(*part == 0.0 || !is_left_out, "{number}: {parts:?}");
            }
        }
    }
}
