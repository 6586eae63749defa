use super::nearest;
use crate::camera::{Footprint, View};
use crate::filter::ewa::TapLender;
use crate::filter::taps::Tap;
use crate::filter::traits::{Filter, PrepareError, Prepared, SetupCost, bounded};
use crate::filter::{CrossSection, Kernel};
use crate::raster::Rgba;
use crate::world::{Light, World};

/// Rule by which a pixel takes one texel's value, for labels. Labels are names, such as object numbers, so that a
/// mixture of two means nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LabelRule {
    /// The texel that the pixel's centre sees.
    #[default]
    Nearest,
    /// The value with the most weight under the pixel.
    Vote,
}

/// Values that are chosen, never mixed: identifiers, classes, masks.
///
/// Every average is the value of some texel. It is opaque or transparent as that texel is, at the rim of a lens, too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Labels {
    /// Rule by which a value is chosen.
    pub rule: LabelRule,
    /// Weights of votes.
    pub kernel: Kernel,
}

impl Labels {
    /// Usual weights of votes: a cone, one pixel and at least one texel in radius. It is positive, and greatest in the
    /// middle, so that a pixel inside a texel takes that texel's value.
    pub const KERNEL: Kernel = Kernel::uniform(CrossSection::Tent);
}

impl Filter for Labels {
    fn prepare<'w>(&self, world: &'w World, light: &'w Light) -> Result<Box<dyn Prepared + 'w>, PrepareError> {
        light.check(world)?;
        Ok(Box::new(PreparedLabels::new(self, world, light.texels())))
    }

    fn setup(&self, _: &World) -> SetupCost {
        SetupCost::default()
    }
}

/// A world of labels, ready to be looked at.
pub(crate) struct PreparedLabels<'w> {
    world: &'w World,
    light: &'w [Rgba],
    /// Lists of taps, for votes.
    taps: Option<TapLender>,
}

impl<'w> PreparedLabels<'w> {
    /// Prepares the choice among a world's labels.
    pub(crate) fn new(labels: &Labels, world: &'w World, light: &'w [Rgba]) -> Self {
        Self { world, light, taps: (labels.rule == LabelRule::Vote).then(|| TapLender::new(&labels.kernel)) }
    }

    /// Fills a row of a target. A pixel that the rim of the lens cuts shows its label unchanged if at least half of it
    /// is inside.
    pub(crate) fn fill_row(&self, target: &View, (j, row): (usize, &mut [Rgba])) {
        for (i, pixel) in row.iter_mut().enumerate() {
            if let Some(screen) = target.screen_pixel(i, j).filter(|screen| screen.coverage >= 0.5) {
                *pixel = self.average(&screen.footprint);
            }
        }
    }
}

impl Prepared for PreparedLabels<'_> {
    fn world(&self) -> &World {
        self.world
    }

    fn reads(&self, footprint: &Footprint) -> usize {
        match (&self.taps, bounded(footprint)) {
            (Some(taps), Some(footprint)) => taps.lend(self.world, &footprint, |taps| taps.as_slice().len()),
            (Some(_), None) => 0,
            (None, _) => 1,
        }
    }

    fn average(&self, footprint: &Footprint) -> Rgba {
        let Some(footprint) = bounded(footprint) else { return Rgba::TRANSPARENT };
        match &self.taps {
            Some(taps) => taps.lend(self.world, &footprint, |taps| winner(taps.as_slice(), self.light)),
            None => {
                let mut found = Rgba::TRANSPARENT;
                nearest(self.world, footprint.direction, |texel, _| found = self.light[texel as usize]);
                found
            }
        }
    }
}

/// Returns the value with the most weight. Of two values with equal weights it returns the one with the smaller bits,
/// so that the order of taps does not matter.
fn winner(taps: &[Tap], light: &[Rgba]) -> Rgba {
    let mut votes: Vec<([u32; 4], f64)> = Vec::new();
    for tap in taps {
        let value = light[tap.texel as usize].0.map(f32::to_bits);
        match votes.iter_mut().find(|(other, _)| *other == value) {
            Some((_, weight)) => *weight += f64::from(tap.weight),
            None => votes.push((value, f64::from(tap.weight))),
        }
    }
    let better = |(value, weight): &([u32; 4], f64), (other, most): &([u32; 4], f64)| {
        weight.total_cmp(most).then_with(|| other.cmp(value))
    };
    votes.into_iter().max_by(better).map_or(Rgba::TRANSPARENT, |(value, _)| Rgba(value.map(f32::from_bits)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_most_weight_wins_and_order_does_not_count() {
        let light = [0.0, 0.25, 0.5, 0.25].map(|value| Rgba::opaque(value, value, value));
        let taps =
            |weights: [f32; 4]| (0..4).zip(weights).map(|(texel, weight)| Tap { texel, weight }).collect::<Vec<_>>();
        // Two texels of one value outvote a heavier one.
        assert_eq!(winner(&taps([0.1, 0.25, 0.4, 0.25]), &light), light[1]);
        assert_eq!(winner(&taps([0.1, 0.15, 0.6, 0.15]), &light), light[2]);
        let even = taps([0.25, 0.25, 0.5, 0.25]);
        let mut reversed = even.clone();
        reversed.reverse();
        assert_eq!(winner(&even, &light), winner(&reversed, &light));
        assert_eq!(winner(&[], &light), Rgba::TRANSPARENT);
    }
}
