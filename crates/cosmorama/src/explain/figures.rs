use super::sheet::drawing::{Anchor, Drawing};
use super::sheet::theme::{INK, LABEL, MARGIN, PAPER, TITLE};
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

/// A picture of a view to draw a figure over.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Underlay {
    /// Index of the view in the world.
    pub view: usize,
    /// Its picture: an address, or a data URI such as `data:image/png;base64,…`. It is stretched over the view.
    pub href: String,
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

/// A sheet with a title and a line under it.
pub(crate) fn sheet((width, height): (f64, f64), title: &str, subtitle: &str) -> Drawing {
    let mut drawing = Drawing::new(width, height, PAPER);
    drawing.label(title, (MARGIN, MARGIN + TITLE * 0.5), TITLE, Anchor::Start, INK);
    drawing.label(subtitle, (MARGIN, MARGIN + TITLE * 0.5 + 21.0), LABEL * 0.8, Anchor::Start, INK);
    drawing
}

/// `1024×960`.
pub(crate) fn size_text((width, height): (usize, usize)) -> String {
    format!("{width}×{height}")
}
