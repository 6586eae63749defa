use std::f64::consts::PI;

use glam::{DMat2, DVec2};

use crate::camera::{Footprint, PixelPoint};
use crate::filter::Kernel;
use crate::filter::gather::ellipse::semi_axes;
use crate::filter::gather::{is_regular, reach, texels_of};
use crate::projection::Projection;
use crate::world::{Source, World};

/// Texels of the finer of two levels that the kernel's unit is at least, across its minor axis, and half of what it is at most:
/// 1.75 to 3.5 texels a pixel by default. The more, the nearer to exact EWA, and the more texels.
const UNIT: f64 = 1.4;

/// A kernel longer than so many times its width is widened: the number of its texels stays bounded.
const LONGEST: f64 = 16.0;

/// The last part of the way from one level to the next, on which the two are mixed; before, the finer one is nearer to exact EWA.
const BLENDED: f32 = 0.25;

/// Beside a steep rim of a view, where a texel's width and length change within few of them, levels are finer by so many, and so
/// they are beside the edge of a target's field of view.
const FINER: f64 = 2.0;

/// Within so many pixels of a steep rim.
const BESIDE_RIM: f64 = 4.0;

/// Texels of a view that a footprint's average is made of by [`EwaPyramid`](super::EwaPyramid), those of both levels together, at
/// most: of any footprint in any projection, at poles, rims and seams. Tests hold it.
pub const MOST_TEXELS: usize = 1 << 14;

/// Texels of one view that a kernel has on one level, at most, as measured from side to side; where it would have more, around a
/// pole or a rim at which texels come together, a coarser level is taken. A coarser level that is mixed in has half as many or
/// less.
const MOST_ON_LEVEL: f64 = 10_000.0;

/// What lies within so many pixels both ways is in a circle of so many, about, since levels are interpolated between.
const AROUND: f64 = 0.75;

/// Which level of a pyramid a footprint is made from, as a number: the finer of two by its whole part.
///
/// It is the logarithm of the footprint's minor axis among the texels of the view that shows it, and where derivatives do not tell
/// how many texels that makes, no less than what leaves so few of them as [`MOST_ON_LEVEL`].
pub(crate) struct LevelRule {
    kernel: Kernel,
    /// The views' geometry: for each view, its levels from the finest on.
    views: Vec<Vec<Source>>,
    /// Texels in a steradian of each view, at most; infinite where they come together.
    densities: Vec<f64>,
}

/// What a level must do for.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LevelNeed {
    /// Whether the edge of a target's field of view may cut the footprint.
    pub(crate) is_cut: bool,
    /// For all footprints within so many pixels.
    pub(crate) pixels_around: f64,
}

impl LevelRule {
    /// The rule for a world's views.
    pub(crate) fn new(world: &World, kernel: &Kernel) -> Self {
        let levels = |source: &Source| std::iter::successors(Some(source.clone()), Source::coarser).collect();
        let views = world.sources().iter();
        Self { kernel: *kernel, views: views.clone().map(levels).collect(), densities: views.map(density).collect() }
    }

    /// The level for a footprint that looks into a view, or beside all of them; `None` where no view is near.
    pub(crate) fn level(&self, view: Option<usize>, footprint: &Footprint, need: LevelNeed) -> Option<f64> {
        view.and_then(|view| self.level_in(view, footprint, need)).or_else(|| self.level_beside(footprint, need))
    }

    /// The level for a footprint that is in a view; `None` where derivatives do not tell how many texels it has there.
    fn level_in(&self, view: usize, footprint: &Footprint, need: LevelNeed) -> Option<f64> {
        let source = &self.views[view][0];
        let pixels = BESIDE_RIM + need.pixels_around;
        let (_, jacobian) = source.view.texel_footprint(footprint)?;
        // Around a pole whole rows are in a footprint however coarse they are.
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

    /// The level for a footprint beside all views, or on a pole of one: from how large the texels of those are that its kernel may
    /// reach. `None` where there is none.
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

    /// The least level from one on in which a view has few enough texels for a footprint.
    fn least(&self, view: usize, footprint: &Footprint, from: f64, need: LevelNeed) -> f64 {
        let beside = AROUND * need.pixels_around * width(footprint);
        let levels = &self.views[view];
        let first = (from.max(0.0) as usize).min(levels.len() - 1);
        let radius = beside + reach(&self.kernel, footprint, levels[first].texel_pitch, self.kernel.floor);
        let around = PI * radius * radius * self.densities[view] * 0.25f64.powi(first as i32);
        let all = levels[first].view.width() * levels[first].view.height();
        if around.min(all as f64) < 0.5 * MOST_ON_LEVEL {
            // Nothing needs to be measured.
            return from;
        }
        let mut finer: Option<f64> = None;
        for (level, source) in levels.iter().enumerate().skip(first) {
            let texels = texels_of(&self.kernel, source, footprint, beside);
            if texels <= MOST_ON_LEVEL {
                // So much before this level there are as many as may be: what is mixed from there on comes in slowly.
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

/// Texels in a steradian of a source, at most; infinite where they come together.
fn density(source: &Source) -> f64 {
    const STEPS: usize = 32;
    if source.period.is_some() || !source.has_bounded_texels() {
        return f64::INFINITY;
    }
    let at = |size: usize, step: usize| size as f64 * step as f64 / STEPS as f64;
    let points = (0..=STEPS).flat_map(|j| (0..=STEPS).map(move |i| (i, j)));
    let point = |(i, j)| PixelPoint::new(at(source.view.width(), i), at(source.view.height(), j));
    points.filter_map(|at| source.view.solid_angle(point(at))).fold(f64::INFINITY, f64::min).recip()
}

/// The angle that a pixel is wide or high, in radians.
pub(crate) fn width(footprint: &Footprint) -> f64 {
    footprint.jacobian.dx.length().max(footprint.jacobian.dy.length())
}

/// How near a steep rim of a view is to a footprint: one within so many pixels, falling to nothing a pixel further.
fn nearness_of_rim(source: &Source, footprint: &Footprint, pixels: f64) -> f64 {
    if !source.view.projection.has_steep_rim() {
        return 0.0;
    }
    (pixels + 1.0 - source.view.margin(footprint.direction) / width(footprint)).clamp(0.0, 1.0)
}

/// The level for a footprint in texels: 0, or less, where it is the finest.
fn level_of(jacobian: DMat2, kernel: &Kernel, longest: f64) -> f64 {
    let [major, minor] = semi_axes(jacobian);
    let width = minor.max(major / longest);
    // Where a pixel holds no more than one texel, nothing needs be smaller.
    (width / (UNIT / kernel.scale).max(1.0)).log2().max(-1.0)
}

/// Whether a level is coarser than those that a number stands for.
pub(crate) fn is_beyond(number: f32, level: usize) -> bool {
    level > 0 && number <= level as f32 - BLENDED
}

/// Whether a level is finer than those that a number stands for.
pub(crate) fn is_before(number: f32, level: usize) -> bool {
    number >= level as f32 + 1.0
}

/// The part of a pixel of this number that is made from a level.
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
