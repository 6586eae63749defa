use super::{FaceOrder, FacePart, FacePlacement, LayoutError, LayoutKind};
use crate::camera::{CameraModel, Canvas, CubeFaceCamera, Mirror, PixelRect, Placement};
use crate::sphere::{Angle, CubeFace};

/// The six faces of a cube in one picture.
#[derive(Clone, Debug, PartialEq)]
pub struct CubeLayout {
    kind: LayoutKind,
    cells: [Cell; 6],
    half: Option<CubeFace>,
    overlap: usize,
}

/// A square of a layout's grid.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cell {
    column: usize,
    row: usize,
    face: CubeFace,
    lies: FacePlacement,
}

/// A face in a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedFace {
    /// Face of the cube.
    pub face: CubeFace,
    /// Placement of the face's picture.
    pub lies: FacePlacement,
    /// Rectangle of the face's pixels.
    pub rect: PixelRect,
    /// The whole face; in half a cube only a part of it may be there.
    pub canvas: Canvas,
}

impl PlacedFace {
    /// Returns the placement of the face's picture in the world, where the face is one of a cube of perspective views.
    pub fn placement(&self) -> Placement {
        Placement {
            orientation: self.lies.orientation(self.face),
            mirror: Mirror { x: self.lies.mirrored, y: false },
            canvas: Some(self.canvas),
            ..Placement::new(CameraModel::CubeFace(CubeFaceCamera))
        }
    }
}

/// Rectangle in units of half a face: columns `left..right`, rows `top..bottom`.
type Halves = PixelRect;

impl CubeLayout {
    /// Returns a layout with the faces in its usual order.
    pub fn new(kind: LayoutKind) -> Self {
        let (places, faces, turns) = (kind.places(), kind.faces(), kind.turns());
        let cell = |i: usize| {
            let (column, row) = places[i];
            Cell { column, row, face: faces[i], lies: FacePlacement::turned(turns[i]) }
        };
        Self { kind, cells: std::array::from_fn(cell), half: None, overlap: 0 }
    }

    /// Returns this layout with its faces, and their turns if the order has some, replaced by those of `order`.
    #[must_use]
    pub fn with_order(mut self, order: &FaceOrder) -> Self {
        for (cell, face) in self.cells.iter_mut().zip(order.faces) {
            cell.face = face;
        }
        match order.turns {
            Some(turns) => self.with_turns(turns),
            None => self,
        }
    }

    /// Returns this layout with the picture of each cell turned clockwise by so many quarters, cells in reading order.
    #[must_use]
    pub fn with_turns(mut self, turns: [u8; 6]) -> Self {
        for (cell, turns) in self.cells.iter_mut().zip(turns) {
            cell.lies = FacePlacement::turned(turns);
        }
        self
    }

    /// Cuts the layout down to the half cube around a face. Faces keep their places; places that show nothing are removed.
    #[must_use]
    pub fn with_half(self, half: CubeFace) -> Self {
        Self { half: Some(half), ..self }
    }

    /// Divides each face of the outer columns into two halves, which lie side by side and both show the columns around its
    /// middle. So GoPro's MAX stores them, since each half was seen by another lens. Layouts that are not three columns wide stay
    /// as they are.
    #[must_use]
    pub fn with_overlap(self, overlap: usize) -> Self {
        let overlap = if self.kind.grid().0 == 3 { overlap } else { 0 };
        Self { overlap, ..self }
    }

    /// Returns the angle that both halves of a divided face show, in the middle of faces of `edge` equal angles.
    pub fn shared(&self, edge: usize) -> Angle {
        Angle::from_degrees(90.0 * self.overlap as f64 / edge as f64)
    }

    /// Returns the layout of the mirrored picture: cells change places. The picture in each cell is mirrored by its view, not here.
    #[must_use]
    pub fn mirrored(mut self, mirror: Mirror) -> Self {
        let (columns, rows) = self.kind.grid();
        for cell in &mut self.cells {
            cell.column = if mirror.x { columns - 1 - cell.column } else { cell.column };
            cell.row = if mirror.y { rows - 1 - cell.row } else { cell.row };
        }
        self
    }

    /// Returns the kind of layout.
    pub fn kind(&self) -> LayoutKind {
        self.kind
    }

    /// Returns the picture's size for faces of `edge`×`edge` pixels.
    ///
    /// # Errors
    /// When the edge is odd and faces are to be halved.
    pub fn size(&self, edge: usize) -> Result<(usize, usize), LayoutError> {
        self.check_edge(edge)?;
        let bounds = self.bounds();
        Ok((bounds.width() * edge / 2 + 2 * self.overlap, bounds.height() * edge / 2))
    }

    /// Returns the edge of the faces in a picture of this size.
    ///
    /// # Errors
    /// When the picture's shape differs from the layout's.
    pub fn edge(&self, width: usize, height: usize) -> Result<usize, LayoutError> {
        let bounds = self.bounds();
        if self.overlap > 0 {
            return self.divided_edge(width, height);
        }
        let edge = 2 * width / bounds.width();
        let fits = edge > 0 && edge * bounds.width() == 2 * width && edge * bounds.height() == 2 * height;
        if !fits {
            let divisor = greatest_common_divisor(bounds.width(), bounds.height());
            return Err(LayoutError::Shape {
                kind: self.kind,
                width,
                height,
                shape: (bounds.width() / divisor, bounds.height() / divisor),
                fits: LayoutKind::ALL.into_iter().filter(|kind| kind.has_shape(width, height)).collect(),
            });
        }
        self.check_edge(edge)?;
        Ok(edge)
    }

    /// Returns the faces of a picture whose faces have `edge`×`edge` pixels.
    pub fn faces(&self, edge: usize) -> Vec<PlacedFace> {
        if self.overlap > 0 {
            return self.cells.iter().flat_map(|cell| self.divided(cell, edge)).collect();
        }
        let bounds = self.bounds();
        let half = |halves: usize| halves * edge / 2;
        let place = |cell: &Cell| {
            let kept = self.kept(cell)?;
            let rect = PixelRect {
                left: half(kept.left - bounds.left),
                top: half(kept.top - bounds.top),
                right: half(kept.right - bounds.left),
                bottom: half(kept.bottom - bounds.top),
            };
            let canvas = Canvas {
                width: edge,
                height: edge,
                left: half(kept.left - 2 * cell.column) as i64,
                top: half(kept.top - 2 * cell.row) as i64,
            };
            Some(PlacedFace { face: cell.face, lies: cell.lies, rect, canvas })
        };
        self.cells.iter().filter_map(place).collect()
    }

    fn check_edge(&self, edge: usize) -> Result<(), LayoutError> {
        let is_halved = self.half.is_some() || self.overlap > 0;
        if is_halved && edge % 2 == 1 {
            return Err(LayoutError::Odd { edge });
        }
        if edge < self.overlap { Err(LayoutError::Narrow { edge, overlap: self.overlap }) } else { Ok(()) }
    }

    /// Returns the edge of the faces in a picture of this size, the outer ones of which are divided.
    fn divided_edge(&self, width: usize, height: usize) -> Result<usize, LayoutError> {
        let (edge, overlap) = (height / 2, self.overlap);
        if (width, height) != (3 * edge + 2 * overlap, 2 * edge) {
            return Err(LayoutError::Overlap { width, height, overlap });
        }
        self.check_edge(edge)?;
        Ok(edge)
    }

    /// Returns the pictures of a cell in a layout whose outer faces are divided: two in an outer column, one in the middle.
    fn divided(&self, cell: &Cell, edge: usize) -> Vec<PlacedFace> {
        let (top, half) = (cell.row * edge, (edge + self.overlap) / 2);
        let begin = cell.column * edge + if cell.column > 0 { self.overlap } else { 0 };
        let part = |left: usize, columns: std::ops::Range<usize>| PlacedFace {
            face: cell.face,
            lies: cell.lies,
            rect: PixelRect { left, top, right: left + columns.len(), bottom: top + edge },
            canvas: Canvas { width: edge, height: edge, left: columns.start as i64, top: 0 },
        };
        if cell.column == 1 {
            return vec![part(begin, 0..edge)];
        }
        vec![part(begin, 0..half), part(begin + half, edge - half..edge)]
    }

    /// Returns the remaining part of a cell, in halves of a face from the grid's corner.
    fn kept(&self, cell: &Cell) -> Option<Halves> {
        let part = FacePart::of(cell.face, cell.lies, self.half)?.halves;
        let (left, top) = (2 * cell.column, 2 * cell.row);
        Some(Halves {
            left: left + part.left,
            top: top + part.top,
            right: left + part.right,
            bottom: top + part.bottom,
        })
    }

    /// Returns the bounds of the picture in halves of a face: the whole grid, or the part that a half cube uses.
    fn bounds(&self) -> Halves {
        let (columns, rows) = self.kind.grid();
        let all = Halves { left: 0, top: 0, right: 2 * columns, bottom: 2 * rows };
        if self.half.is_none() {
            return all;
        }
        self.cells.iter().filter_map(|cell| self.kept(cell)).reduce(Halves::union).unwrap_or(all)
    }
}

fn greatest_common_divisor(a: usize, b: usize) -> usize {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::PixelPoint;
    use crate::sphere::{Direction, Orientation};

    #[test]
    fn a_placed_face_looks_along_its_face_and_is_turned_with_its_picture() {
        for placed in CubeLayout::new(LayoutKind::CrossV).faces(8) {
            let view = placed.placement().view(8, 8).unwrap();
            let towards = |y: f64| view.direction(PixelPoint::new(4.0, y)).unwrap();
            let (_, up) = placed.lies.axes(placed.face);
            assert!(towards(4.0).dot(placed.face.forward()) > 0.999_999, "{placed:?}");
            assert!(towards(0.0).dot(up) > 0.5, "{placed:?}");
        }
    }

    #[test]
    fn the_axes_of_a_turned_picture_are_a_cameras() {
        for face in CubeFace::ALL {
            for quarter_turns in 0..4 {
                let (right, up) = FacePlacement { quarter_turns, mirrored: false }.axes(face);
                let camera = Orientation::from_axes(right, up, face.forward());
                assert_eq!(camera.to_world(Direction::FRONT).vector(), face.forward().vector());
            }
        }
    }

    #[test]
    fn every_layout_fills_its_shape_without_overlap() {
        for kind in LayoutKind::ALL {
            let layout = CubeLayout::new(kind);
            let (width, height) = layout.size(8).unwrap();
            assert_eq!(layout.edge(width, height), Ok(8), "{kind}");
            let faces = layout.faces(8);
            assert_eq!(faces.len(), 6);
            let mut used = vec![0; width * height];
            for placed in &faces {
                for y in placed.rect.top..placed.rect.bottom {
                    (placed.rect.left..placed.rect.right).for_each(|x| used[y * width + x] += 1);
                }
            }
            assert_eq!(used.iter().sum::<usize>(), 6 * 64, "{kind}");
            assert!(used.iter().all(|&count| count <= 1), "{kind}");
        }
    }

    #[test]
    fn another_shape_names_the_layouts_that_have_it() {
        let error = CubeLayout::new(LayoutKind::CrossH).edge(768, 512).unwrap_err().to_string();
        assert_eq!(error, "768x512 pixels are no cross-h of square faces, whose shape is 4:3; of that shape: 3x2, eac");
        let error = CubeLayout::new(LayoutKind::Eac).edge(1920, 1080).unwrap_err().to_string();
        assert!(error.ends_with("no layout has that shape"), "{error}");
        assert!(CubeLayout::new(LayoutKind::StripH).edge(0, 0).is_err());
    }

    // The sizes and places in the frames of GoPro's MAX: 4096 columns, outer faces of 1376, halves of 688.
    #[test]
    fn outer_faces_are_divided_into_halves_that_overlap() {
        let layout = CubeLayout::new(LayoutKind::Eac).with_overlap(32);
        assert_eq!(layout.size(1344), Ok((4096, 2688)));
        assert_eq!((layout.edge(4096, 2688), layout.edge(2272, 1472)), (Ok(1344), Ok(736)));
        let faces = layout.faces(1344);
        let places: Vec<_> =
            faces[..5].iter().map(|placed| (placed.face, placed.rect.left, placed.canvas.left)).collect();
        let (left, front, right) = (CubeFace::Left, CubeFace::Front, CubeFace::Right);
        assert_eq!(places, [(left, 0, 0), (left, 688, 656), (front, 1376, 0), (right, 2720, 0), (right, 3408, 656)]);
        assert_eq!((faces.len(), faces[9].rect.right, faces[9].rect.bottom), (10, 4096, 2688));
        // Both halves show the middle, and the columns beside it as far as they overlap.
        let [a, b] = [&faces[0], &faces[1]].map(|placed| (placed.placement(), placed.rect));
        let seen = |(placement, rect): &(Placement, PixelRect), x: f64| {
            placement.view(rect.width(), rect.height()).unwrap().direction(PixelPoint::new(x, 600.0)).unwrap()
        };
        assert!(seen(&a, 672.0).angle_to(seen(&b, 16.0)).degrees() < 1e-9);
        assert!((layout.shared(1344).degrees() - 90.0 / 42.0).abs() < 1e-12);
        for (width, height) in [(4032, 2688), (4096, 2690), (0, 0)] {
            assert!(matches!(layout.edge(width, height), Err(LayoutError::Overlap { .. })), "{width} {height}");
        }
        assert_eq!(layout.edge(163, 66), Err(LayoutError::Odd { edge: 33 }));
        assert_eq!(layout.size(30), Err(LayoutError::Narrow { edge: 30, overlap: 32 }));
        // Other layouts have no outer columns.
        assert_eq!(CubeLayout::new(LayoutKind::StripH).with_overlap(32).size(64), Ok((384, 64)));
    }

    #[test]
    fn half_a_cross_is_cut_off() {
        let cross = CubeLayout::new(LayoutKind::CrossH);
        let sky = cross.clone().with_half(CubeFace::Up);
        assert_eq!(sky.size(8), Ok((32, 12)));
        assert_eq!(sky.faces(8).len(), 5);
        assert_eq!(sky.size(7), Err(LayoutError::Odd { edge: 7 }));
        let front = sky.faces(8).into_iter().find(|placed| placed.face == CubeFace::Front).unwrap();
        assert_eq!(front.rect, PixelRect { left: 8, top: 8, right: 16, bottom: 12 });
        assert_eq!(front.canvas, Canvas { width: 8, height: 8, left: 0, top: 0 });
        // The hemicube of radiosity: the front, and half of each neighbour around it.
        assert_eq!(cross.with_half(CubeFace::Front).size(8), Ok((16, 16)));
        // In a vertical cross the back is upside down.
        let down = CubeLayout::new(LayoutKind::CrossV).with_half(CubeFace::Down);
        let back = down.faces(8).into_iter().find(|placed| placed.face == CubeFace::Back).unwrap();
        assert_eq!((back.rect.height(), back.canvas.top), (4, 0));
    }
}
