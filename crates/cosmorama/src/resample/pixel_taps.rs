use super::gather::Gather;
use super::kernel::KernelTable;
use super::{Filter, FilterKind, Taps, lookup, reference};
use crate::world::{ScreenPixel, View, World};

/// The texels that single pixels of a target are made of.
pub(crate) struct PixelTaps<'a> {
    world: &'a World,
    target: &'a View,
    filter: &'a Filter,
    gather: Gather<'a>,
    taps: Taps,
}

impl<'a> PixelTaps<'a> {
    /// Pixels of `target` made by `filter` from `world`; `table` is that of the filter's kernel.
    pub(crate) fn new(world: &'a World, target: &'a View, filter: &'a Filter, table: &'a KernelTable) -> Self {
        Self { world, target, filter, gather: Gather::new(world, table), taps: Taps::default() }
    }

    /// Gives the index of every texel that the filter reads for a pixel to `visit`, some of them perhaps twice.
    pub(crate) fn for_each_texel(&mut self, pixel: (usize, usize), screen: &ScreenPixel, mut visit: impl FnMut(usize)) {
        let direction = screen.footprint.direction;
        let mut read = |texel: u32, _: f64| visit(texel as usize);
        match self.filter.kind {
            FilterKind::Ewa => {
                self.gather.taps(&screen.footprint, &mut self.taps);
                self.taps.as_slice().iter().for_each(|tap| visit(tap.texel as usize));
            }
            FilterKind::Point => lookup::nearest(self.world, direction, read),
            FilterKind::Bilinear => lookup::bilinear(self.world, direction, read),
            FilterKind::Reference { samples } => {
                reference::for_each_texel(self.world, self.target, self.filter, samples, pixel, &mut read);
            }
        }
    }
}
