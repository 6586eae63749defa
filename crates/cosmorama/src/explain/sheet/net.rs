use super::drawing::Rect;
use super::theme::{HEADER, MARGIN};
use crate::camera::PixelPoint;
use crate::sphere::{CubeFace, Direction};
use crate::world::{Source, World};

/// Widths of a cube face, of a single image, and of one of many.
const FACE: f64 = 240.0;
const LONE: f64 = 960.0;
const ONE_OF_MANY: f64 = 320.0;

/// Space between unrelated images.
const GUTTER: f64 = 24.0;

/// Places of the views' images on a sheet: the faces of a cube unfolded as a cross, other images side by side.
pub(crate) struct Net {
    /// The frame of each view, in the world's order.
    pub(crate) images: Vec<Rect>,
    /// Faces of the cube that are not in the world.
    pub(crate) lacking: Vec<(CubeFace, Rect)>,
    /// Whether the images are faces of one cube.
    is_cross: bool,
    /// Width and height of the sheet.
    pub(crate) size: (f64, f64),
}

impl Net {
    pub(crate) fn of(world: &World) -> Self {
        match faces(world) {
            Some(faces) => Self::cross(world, &faces),
            None => Self::rows(world),
        }
    }

    /// Returns an image's frame extended by a margin, and the margin, for the search of its field of view. A field that
    /// ends exactly on the edge between two faces is only found beyond it.
    pub(crate) fn outset(&self, frame: Rect) -> (Rect, f64) {
        (frame, if self.is_cross { 2.0 } else { 0.0 })
    }

    fn cross(world: &World, faces: &[CubeFace]) -> Self {
        let images = world.sources().iter().zip(faces).map(|(source, &face)| within_face(source, cell(face))).collect();
        let lacking = CubeFace::ALL.into_iter().filter(|face| !faces.contains(face));
        Self {
            images,
            lacking: lacking.map(|face| (face, cell(face))).collect(),
            is_cross: true,
            size: (4.0 * FACE + 2.0 * MARGIN, 3.0 * FACE + HEADER + MARGIN),
        }
    }

    fn rows(world: &World) -> Self {
        let count = world.sources().len();
        let columns = (count as f64).sqrt().ceil() as usize;
        let width = if count == 1 { LONE } else { ONE_OF_MANY };
        let (mut images, mut top) = (Vec::new(), HEADER);
        for row in world.sources().chunks(columns) {
            let heights: Vec<f64> = row.iter().map(|source| width / aspect(source)).collect();
            for (column, &height) in heights.iter().enumerate() {
                images.push(Rect { x: MARGIN + column as f64 * (width + GUTTER), y: top, width, height });
            }
            top += heights.iter().fold(0.0, |highest: f64, &height| highest.max(height)) + GUTTER;
        }
        let sheet_width = columns as f64 * (width + GUTTER) - GUTTER + 2.0 * MARGIN;
        Self { images, lacking: Vec::new(), is_cross: false, size: (sheet_width, top - GUTTER + MARGIN) }
    }
}

/// Returns width over height of an image as its pixels lie in the plane, limited to what fits a sheet.
fn aspect(source: &Source) -> f64 {
    let step = source.view.grid.step().abs();
    let (width, height) = (source.view.width() as f64 * step.x, source.view.height() as f64 * step.y);
    (width / height).clamp(0.25, 8.0)
}

/// Returns the face of each view; `None` if the views are not the faces of one cube.
fn faces(world: &World) -> Option<Vec<CubeFace>> {
    let sources = world.sources();
    if !sources.iter().all(|source| source.view.is_pinhole()) || sources.len() < 2 {
        return None;
    }
    let distinct = |found: Vec<CubeFace>| {
        let is_first = |(index, face): (usize, &CubeFace)| !found[..index].contains(face);
        found.iter().enumerate().all(is_first).then_some(found)
    };
    // The faces of a cube that is turned in the world are recognised by their names.
    let named = |source: &Source| CubeFace::ALL.into_iter().find(|face| face.name() == source.name);
    let by_orientation = sources.iter().map(facing).collect::<Option<Vec<_>>>();
    by_orientation.or_else(|| sources.iter().map(named).collect()).and_then(distinct)
}

/// Returns the face whose orientation a view has.
fn facing(source: &Source) -> Option<CubeFace> {
    const TOLERANCE: f64 = 1e-6;
    let orientation = &source.view.orientation;
    let is_at = |axis: Direction, place: Direction| orientation.to_world(axis).angle_to(place).radians() < TOLERANCE;
    CubeFace::ALL.into_iter().find(|face| is_at(Direction::FRONT, face.forward()) && is_at(Direction::UP, face.up()))
}

/// Returns the square of a face on the sheet; the back is beyond the right face.
fn cell(face: CubeFace) -> Rect {
    let (column, row) = match face {
        CubeFace::Left => (0.0, 1.0),
        CubeFace::Front => (1.0, 1.0),
        CubeFace::Right => (2.0, 1.0),
        CubeFace::Back => (3.0, 1.0),
        CubeFace::Up => (1.0, 0.0),
        CubeFace::Down => (1.0, 2.0),
    };
    Rect { x: MARGIN + column * FACE, y: HEADER + row * FACE, width: FACE, height: FACE }
}

/// Returns the part of a face's square that an image shows. It may be a window of the face, or extend beyond it.
fn within_face(source: &Source, cell: Rect) -> Rect {
    let grid = &source.view.grid;
    let start = grid.to_plane(PixelPoint::new(0.0, 0.0));
    let end = grid.to_plane(PixelPoint::new(grid.width() as f64, grid.height() as f64));
    let reach = [start.x, start.y, end.x, end.y].into_iter().fold(1.0, |reach: f64, value| reach.max(value.abs()));
    let across = |x: f64| cell.x + (x / reach + 1.0) / 2.0 * cell.width;
    let down = |y: f64| cell.y + (1.0 - y / reach) / 2.0 * cell.height;
    let (left, right) = (across(start.x.min(end.x)), across(start.x.max(end.x)));
    let (top, bottom) = (down(start.y.max(end.y)), down(start.y.min(end.y)));
    Rect { x: left, y: top, width: right - left, height: bottom - top }
}
