use super::Gather;
use crate::camera::{ScreenPixel, View};
use crate::filter::kernel::KernelTable;
use crate::filter::rim::field_edge::FieldEdge;
use crate::filter::taps::Taps;
use crate::filter::{FilterKind, FilterSettings, LabelRule, lookup, reference};
use crate::world::World;

/// Finder of the texels that make up single pixels of a target.
pub(crate) struct PixelTaps<'a> {
    world: &'a World,
    target: &'a View,
    filter: &'a FilterSettings,
    gather: Gather<'a>,
    taps: Taps,
}

impl<'a> PixelTaps<'a> {
    /// Makes the finder for the pixels of `target`, as `filter` computes them from `world`; `table` belongs to the
    /// filter's kernel.
    pub(crate) fn new(world: &'a World, target: &'a View, filter: &'a FilterSettings, table: &'a KernelTable) -> Self {
        Self { world, target, filter, gather: Gather::new(world, FieldEdge::of(target), table), taps: Taps::default() }
    }

    /// Returns the gather, which finds the texels where the filter is EWA.
    pub(crate) fn gather(&self) -> &Gather<'a> {
        &self.gather
    }

    /// Returns the taps of a pixel, whose weights add to one. `None` for the reference filter, which has too many to
    /// list, and for filters that have none.
    pub(crate) fn taps(&mut self, screen: &ScreenPixel) -> Option<&Taps> {
        let (direction, taps) = (screen.footprint.direction, &mut self.taps);
        match self.filter.kind {
            FilterKind::Ewa | FilterKind::EwaPyramid | FilterKind::Labels(LabelRule::Vote) => {
                self.gather.taps(&screen.footprint, taps)
            }
            FilterKind::Point | FilterKind::Labels(LabelRule::Nearest) => {
                taps.clear();
                lookup::nearest(self.world, direction, |texel, weight| taps.push_under(texel, weight as f32));
            }
            FilterKind::Bilinear => {
                taps.clear();
                lookup::bilinear(self.world, direction, |texel, weight| taps.push_under(texel, weight as f32));
                taps.normalise();
            }
            FilterKind::Classic(_) | FilterKind::Reference { .. } => return None,
        }
        Some(&self.taps)
    }

    /// Calls `visit` with the index of every texel that the filter reads for a pixel, perhaps more than once.
    pub(crate) fn for_each_texel(&mut self, pixel: (usize, usize), screen: &ScreenPixel, mut visit: impl FnMut(usize)) {
        if let FilterKind::Reference { samples } = self.filter.kind {
            let mut read = |texel: u32, _: f64| visit(texel as usize);
            reference::for_each_texel(self.world, self.target, &self.filter.reference(samples), pixel, &mut read);
        } else if let Some(taps) = self.taps(screen) {
            taps.as_slice().iter().for_each(|tap| visit(tap.texel as usize));
        }
    }
}
