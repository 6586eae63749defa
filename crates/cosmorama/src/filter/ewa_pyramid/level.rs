use glam::{DMat2, DVec2};

use crate::camera::Footprint;
use crate::filter::Kernel;
use crate::filter::gather::ellipse::semi_axes;
use crate::filter::gather::{is_regular, texels_of};
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
/// most: in any projection, at poles, rims and seams, of footprints up to 15° wide. Tests hold it. Wider ones beside the edge of a
/// cylinder that ends may take more: 62 112 were found of 36°.
pub const MOST_TEXELS: usize = 1 << 15;

/// Texels of one view that a kernel has on one level, at most, as measured from side to side; where it would have more, around a
/// pole or a rim at which texels come together, a coarser level is taken. A coarser level that is mixed in has half as many or
/// less. What is gathered may be more than what is measured: over the seam of a Mercator map, the most that tests have found,
/// 16 786 on both levels together.
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
        Self { kernel: *kernel, views: world.sources().iter().map(levels).collect() }
    }

    /// The level for a footprint that is in a view; `None` where it has no texels there.
    pub(crate) fn level(&self, view: usize, footprint: &Footprint, need: LevelNeed) -> Option<f64> {
        let source = &self.views[view][0];
        let pixels = BESIDE_RIM + need.pixels_around;
        let (_, jacobian) = source.view.texel_footprint(footprint)?;
        // Around a pole whole rows are in a footprint however coarse they are.
        let longest = if source.period.is_some() { f64::INFINITY } else { LONGEST };
        let level = level_of(jacobian, &self.kernel, longest);
        if !level.is_finite() {
            return None;
        }
        let is_finer = need.is_cut || is_beside_rim(source, footprint, pixels);
        let level = if is_finer { level - FINER } else { level };
        if !is_finer && is_regular(&self.kernel, source, footprint) {
            return Some(level);
        }
        Some(level.max(self.least(view, footprint, level, AROUND * need.pixels_around * width(footprint))))
    }

    /// The level for a footprint that is in no view, but beside one: from how large the texels of those are that its kernel may
    /// reach. `None` where there is none.
    pub(crate) fn level_beside(&self, footprint: &Footprint) -> Option<f64> {
        let pixel = footprint.jacobian.solid_angle().sqrt();
        let level = |(view, levels): (usize, &Vec<Source>)| {
            let source = &levels[0];
            if texels_of(&self.kernel, source, footprint, 0.0) == 0.0 {
                return None;
            }
            let texel = source.texel_pitch_at(footprint.direction).min(source.texel_pitch);
            let level = level_of(DMat2::from_diagonal(DVec2::splat(pixel / texel)), &self.kernel, LONGEST);
            Some(level.max(self.least(view, footprint, level, 0.0)))
        };
        self.views.iter().enumerate().filter_map(level).reduce(f64::max)
    }

    /// The least level from one on in which a view has few enough texels for a footprint.
    fn least(&self, view: usize, footprint: &Footprint, from: f64, around: f64) -> f64 {
        let levels = &self.views[view];
        let first = (from.max(0.0) as usize).min(levels.len() - 1);
        let mut finer: Option<f64> = None;
        for (level, source) in levels.iter().enumerate().skip(first) {
            let texels = texels_of(&self.kernel, source, footprint, around);
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

/// The angle that a pixel is wide or high, in radians.
pub(crate) fn width(footprint: &Footprint) -> f64 {
    footprint.jacobian.dx.length().max(footprint.jacobian.dy.length())
}

/// Whether a steep rim of a view is within so many pixels of a footprint.
fn is_beside_rim(source: &Source, footprint: &Footprint, pixels: f64) -> bool {
    source.view.projection.has_steep_rim() && source.view.margin(footprint.direction) < pixels * width(footprint)
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
