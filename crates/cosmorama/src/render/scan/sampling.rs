use crate::camera::{Footprint, View};
use crate::render::scan::wanted::Wanted;

/// Choice of what a scan visits, if not the whole of a target with its own pixels.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sampling<'a> {
    /// Patches to compute, if not all.
    pub(crate) wanted: Option<&'a Wanted>,
    /// View whose pixels are averaged: the target only says around which directions. Then pictures of any density hold what
    /// the lens would see there.
    pub(crate) lens: Option<&'a View>,
}

impl<'a> Sampling<'a> {
    /// Returns the sampling of some patches by the target's own pixels.
    pub(crate) const fn only(wanted: &'a Wanted) -> Self {
        Self { wanted: Some(wanted), lens: None }
    }

    /// Returns the footprint of the lens around the direction of another; `None` where it has none.
    pub(crate) fn footprint(&self, own: &Footprint) -> Option<Footprint> {
        let Some(lens) = self.lens else { return Some(*own) };
        Some(Footprint { jacobian: lens.texel(lens.pixel(own.direction)?)?, ..*own })
    }
}
