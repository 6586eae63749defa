use std::sync::Arc;

use cosmorama::camera::{Canvas, View};
use cosmorama::world::{Blend, ViewMask, WorldView};
use cosmorama_io::Header;

use crate::packing::Place;
use crate::source::ViewFiles;

/// A view of the input: an image, a face of a cube, or one of two lenses.
#[derive(Clone)]
pub struct InputView {
    /// Name in messages.
    pub name: String,
    /// Files of the view.
    pub files: ViewFiles,
    /// Place in a file that several views share.
    pub part: Option<Place>,
    /// Header of the first file; `None` without a file.
    pub header: Option<Header>,
    /// Geometry of the whole picture.
    pub nominal: View,
    /// Part of the whole picture that the file holds; `None` without a file.
    pub window: Option<(View, Canvas)>,
    /// Blending with other views that show the same directions.
    pub blend: Blend,
    /// Mask, if not all pixels count.
    pub mask: Option<Arc<ViewMask>>,
    /// Whether anything of the view is needed; other views are not read.
    pub wanted: bool,
}

/// Texels of the largest whole picture that is surveyed however little of it a file holds.
const SURVEYED: usize = 1 << 24;

/// Texels of a huge whole picture for each one of its file, from which on the file alone is surveyed.
const LITTLE: usize = 64;

impl InputView {
    /// Takes what the file holds for the whole picture, where it is little of a huge one. A survey of the whole would take minutes and
    /// gigabytes, by what a short header declares; so the rest counts as shown by no view.
    pub(super) fn narrow_to_file(&mut self) {
        let texels = |view: &View| view.width().saturating_mul(view.height());
        let whole = texels(&self.nominal);
        let is_little = |(held, _): &(View, Canvas)| texels(held).saturating_mul(LITTLE) < whole;
        if whole > SURVEYED && self.window.as_ref().is_some_and(is_little) {
            self.take_for_whole();
        }
    }

    /// Takes what the file holds for the whole picture.
    pub(crate) fn take_for_whole(&mut self) {
        if let Some((held, canvas)) = &mut self.window {
            self.nominal = held.clone();
            *canvas = Canvas { width: held.width(), height: held.height(), left: 0, top: 0 };
        }
    }

    /// Converts the input's view to a view of a world, with the geometry of its whole picture or of its file.
    pub(crate) fn world_view(&self, view: View) -> WorldView {
        WorldView { name: self.name.clone(), view, blend: self.blend, mask: self.mask.clone() }
    }

    /// Returns the view with its header and the geometry of its file, if there is a file and the view is wanted.
    pub(crate) fn present(&self) -> Option<(&Self, &Header, &View)> {
        self.there().filter(|_| self.wanted)
    }

    /// Returns the view with its header and the geometry of its file, if there is a file, wanted or not.
    pub(crate) fn there(&self) -> Option<(&Self, &Header, &View)> {
        Some((self, self.header.as_ref()?, &self.window.as_ref()?.0))
    }
}
