use cosmorama::camera::{CameraError, Canvas, PixelRect, Placement, View};
use cosmorama::layout::{CubeLayout, LayoutError, PlacedFace, PlacedLens};
use cosmorama::sphere::{Angle, CubeFace, Orientation};
use cosmorama::world::Blend;
use cosmorama_spec::{Cube, Dual};

use crate::diagnostic::Result;
use crate::packing::face_view::face_placement;

/// One of several pictures in one image.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    /// Name in messages.
    pub(crate) name: &'static str,
    /// Face of the cube, if it is one.
    pub(crate) face: Option<CubeFace>,
    /// Rectangle of its pixels.
    pub(crate) rect: PixelRect,
    /// Camera model and orientation, and its place in its whole picture.
    pub(crate) placement: Placement,
    /// Whole picture, of which half a cube may use only a part.
    pub(crate) canvas: Canvas,
    /// Whether it is one of two halves of a face, which overlap.
    pub(crate) is_divided: bool,
    /// Blending with others that show the same directions.
    pub(crate) blend: Blend,
}

impl Piece {
    /// Returns the faces of a cube of `edge`×`edge` pixels.
    pub(crate) fn faces(cube: &Cube, layout: &CubeLayout, edge: usize) -> Vec<Self> {
        let shared = layout.shared(edge);
        let blend = if shared > Angle::ZERO {
            Blend { priority: 0, feather: cube.feather.unwrap_or(shared) }
        } else {
            cube.blend()
        };
        let piece = |PlacedFace { face, lies, rect, canvas }| Self {
            name: face.name(),
            face: Some(face),
            rect,
            placement: face_placement(cube, face, lies, Some(canvas), Orientation::IDENTITY),
            canvas,
            is_divided: shared > Angle::ZERO && rect.width() < canvas.width,
            blend,
        };
        let wanted = layout.faces(edge).into_iter().filter(|placed| cube.faces.contains(&placed.face));
        wanted.map(piece).collect()
    }

    /// Returns the two fisheyes in an image of this size.
    pub(crate) fn lenses(dual: &Dual, (width, height): (usize, usize)) -> Result<Vec<Self>, LayoutError> {
        let piece = |PlacedLens { side, rect, placement }: PlacedLens| {
            let canvas = Canvas { width: rect.width(), height: rect.height(), left: 0, top: 0 };
            let orientation = placement.orientation.within(dual.orientation);
            let placement = Placement { orientation, canvas: Some(canvas), ..placement };
            let blend = dual.picture.blend();
            Self { name: side.name(), face: None, rect, placement, canvas, is_divided: false, blend }
        };
        Ok(dual.picture.lenses(width, height, dual.mirror)?.map(piece).into())
    }

    /// Returns the geometry of the picture's pixels, with all of it turned by `outer`.
    pub(crate) fn view(&self, outer: Orientation) -> Result<View, CameraError> {
        let placement = Placement { orientation: self.placement.orientation.within(outer), ..self.placement.clone() };
        placement.view(self.rect.width(), self.rect.height())
    }

    /// Returns the geometry of the whole picture.
    pub(crate) fn nominal(&self) -> Result<View, CameraError> {
        Placement { canvas: None, ..self.placement.clone() }.view(self.canvas.width, self.canvas.height)
    }
}
