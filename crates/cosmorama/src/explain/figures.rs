use super::path::figure;
use super::unfolded::Underlay;
use super::{footprints, ownership, unfolded};
use crate::camera::View;
use crate::render::Needs;
use crate::world::World;

/// Drawings of a conversion as SVG documents. Letters are drawn as shapes, so that no font is needed and the same
/// conversion gives the same bytes.
///
/// They are figures 3, 4 and 7 of the paper (Greene & Heckbert 1986), for any world and target. The world needs no
/// light.
#[derive(Clone, Copy, Debug)]
pub struct Figures<'a> {
    /// World that is converted.
    pub world: &'a World,
    /// View that is made.
    pub target: &'a View,
}

impl Figures<'_> {
    /// Draws figure 3: the unfolded cube, or the world's other images, with needed regions bright and the edge of the
    /// target's field of view as a curve.
    pub fn unfolded(&self, needs: &Needs, underlays: &[Underlay]) -> String {
        unfolded::draw(self.world, self.target, needs, underlays)
    }

    /// Draws the path of a camera over the unfolded world, from the views of all its frames. Bright is what some frame sees; dots
    /// are the middles of frames.
    pub fn path(world: &World, frames: &[Vec<View>]) -> String {
        figure::draw(world, frames)
    }

    /// Draws figure 4: which view gives which pixel of the target, with the edges of views as curves.
    pub fn ownership(&self) -> String {
        ownership::draw(self.world, self.target)
    }

    /// Draws figure 7: the footprints of a regular grid of target pixels in each view.
    pub fn footprints(&self) -> String {
        footprints::draw(self.world, self.target)
    }
}
