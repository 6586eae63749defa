use std::collections::HashMap;

use cosmorama::filter::LabelRule;
use cosmorama::raster::Rgba;
use cosmorama::world::World;
use cosmorama_io::PlaneSamples;

use super::ViewPlanes;
use crate::job::ConvertJob;

/// Labels of a frame. Each texel stands for its labels by its number. So labels are copied bit by bit, whatever their
/// type and however many channels belong together.
pub(super) struct LabelTexels<'a> {
    views: &'a [ViewPlanes<'a>],
    /// Views of each world.
    worlds: Vec<Vec<LabelView>>,
}

/// A view's texels.
struct LabelView {
    /// Index among all views that are present.
    view: usize,
    /// Number of its first texel.
    first: usize,
    /// Number of its texels.
    count: usize,
    width: usize,
}

/// Map from labels to the first texel that has them.
#[derive(Default)]
struct Firsts {
    all: HashMap<Vec<u32>, usize>,
    /// Labels seen last, with their first texel: equal labels come in runs.
    last: Option<(Vec<u32>, usize)>,
}

impl Firsts {
    /// Returns the first texel with these labels, which may be this one.
    fn of(&mut self, bits: Vec<u32>, number: usize) -> usize {
        match &self.last {
            Some((last, first)) if *last == bits => *first,
            _ => {
                let first = *self.all.entry(bits.clone()).or_insert(number);
                self.last = Some((bits, first));
                first
            }
        }
    }
}

/// Numbers up to which floats are exact.
const EXACT: usize = 1 << 24;

impl<'a> LabelTexels<'a> {
    /// Numbers the texels of a job's worlds.
    pub(super) fn new(job: &ConvertJob, views: &'a [ViewPlanes<'a>]) -> Self {
        let mut present = 0..;
        let of_world = |world: &World| {
            let sources = world.sources().iter();
            let view = |(source, view): (&cosmorama::world::Source, usize)| LabelView {
                view,
                first: source.offset,
                count: source.texels().len(),
                width: source.view.width(),
            };
            sources.zip(&mut present).map(view).collect()
        };
        Self { views, worlds: job.worlds.iter().map(of_world).collect() }
    }

    /// Fills texels with their numbers; for votes, with the number of the first texel that has the same labels.
    pub(super) fn fill(&self, rule: LabelRule, worlds: &mut [Vec<Rgba>]) {
        for (views, texels) in self.worlds.iter().zip(worlds) {
            let mut firsts = Firsts::default();
            for view in views {
                let numbers = view.first..view.first + view.count;
                for (number, texel) in numbers.clone().zip(&mut texels[numbers]) {
                    let stands =
                        if rule == LabelRule::Vote { firsts.of(self.bits(view, number), number) } else { number };
                    *texel = coded(stands);
                }
            }
        }
    }

    /// Copies a label of the texel that a pixel stands for; a transparent pixel has none.
    pub(super) fn copy(&self, (world, pixel): (usize, Rgba), channel: usize, (into, at): (&mut PlaneSamples, usize)) {
        let Some(number) = decoded(pixel) else { return };
        let views = &self.worlds[world];
        let Some(view) = views.partition_point(|view| view.first <= number).checked_sub(1).map(|index| &views[index])
        else {
            return;
        };
        let planes = &self.views[view.view];
        let (from, index) = (planes.planes[channel], self.index(view, number));
        if from.kind() == into.kind() {
            into.set_bits(at, from.bits(index));
        } else {
            into.set_number(at, from.number(index));
        }
    }

    fn index(&self, view: &LabelView, number: usize) -> usize {
        let within = number - view.first;
        self.views[view.view].row(within / view.width) + within % view.width
    }

    fn bits(&self, view: &LabelView, number: usize) -> Vec<u32> {
        let index = self.index(view, number);
        self.views[view.view].planes.iter().map(|plane| plane.bits(index)).collect()
    }
}

/// Writes a number as a pixel, in floats that hold it exactly.
fn coded(number: usize) -> Rgba {
    Rgba([(number % EXACT) as f32, (number / EXACT) as f32, 0.0, 1.0])
}

/// Returns the number in a pixel; `None` for a transparent one.
fn decoded(Rgba([low, high, _, seen]): Rgba) -> Option<usize> {
    (seen > 0.0).then(|| high as usize * EXACT + low as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_texels_come_back() {
        for number in [0, 1, EXACT - 1, EXACT, 3 * EXACT + 12345, u32::MAX as usize] {
            assert_eq!(decoded(coded(number)), Some(number));
        }
        assert_eq!(decoded(Rgba::TRANSPARENT), None);
    }
}
