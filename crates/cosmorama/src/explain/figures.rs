use super::unfolded::Underlay;
use super::{footprints, ownership, unfolded};
use crate::camera::View;
use crate::render::Needs;
use crate::world::World;

/// Pictures of a conversion, each an SVG document. Their letters are drawn, so they need no font, and the same
/// conversion gives the same bytes.
///
/// They are the paper's figures of the same numbers (Greene & Heckbert 1986), for any world and target. The world needs
/// no light.
#[derive(Clone, Copy, Debug)]
pub struct Figures<'a> {
    /// Where light comes from.
    pub world: &'a World,
    /// Where it goes.
    pub target: &'a View,
}

impl Figures<'_> {
    /// Figure 3: the unfolded cube (or the world's other images), the needed regions bright, the edge of the target's
    /// field of view as a curve.
    pub fn unfolded(&self, needs: &Needs, underlays: &[Underlay]) -> String {
        unfolded::draw(self.world, self.target, needs, underlays)
    }

    /// Figure 4: which view gives which pixel of the target, the edges of the views as curves.
    pub fn ownership(&self) -> String {
        ownership::draw(self.world, self.target)
    }

    /// Figure 7: what a regular grid of the target's pixels covers in each view.
    pub fn footprints(&self) -> String {
        footprints::draw(self.world, self.target)
    }
}
