use crate::camera::FaceMapping;
use crate::sphere::CubeFace::{self, Back, Down, Front, Left, Right, Up};

/// Arrangement of the six faces in the squares of a grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LayoutKind {
    /// Six faces side by side.
    StripH,
    /// Six faces one below the other.
    StripV,
    /// Three columns, two rows.
    ThreeByTwo,
    /// Two columns, three rows.
    TwoByThree,
    /// Horizontal cross: left, front, right and back in a row, up and down above and below the front.
    CrossH,
    /// Vertical cross: the back is below the down face, upside down.
    CrossV,
    /// Equi-angular cube map (EAC) of three columns and two rows: left, front and right above; down, back and up below,
    /// turned by quarters.
    Eac,
}

impl LayoutKind {
    /// All layouts.
    pub const ALL: [Self; 7] =
        [Self::StripH, Self::StripV, Self::ThreeByTwo, Self::TwoByThree, Self::CrossH, Self::CrossV, Self::Eac];

    /// Returns the name in `layout=`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::StripH => "strip-h",
            Self::StripV => "strip-v",
            Self::ThreeByTwo => "3x2",
            Self::TwoByThree => "2x3",
            Self::CrossH => "cross-h",
            Self::CrossV => "cross-v",
            Self::Eac => "eac",
        }
    }

    /// Returns the columns and rows of its grid.
    pub const fn grid(self) -> (usize, usize) {
        match self {
            Self::StripH => (6, 1),
            Self::StripV => (1, 6),
            Self::ThreeByTwo | Self::Eac => (3, 2),
            Self::TwoByThree => (2, 3),
            Self::CrossH => (4, 3),
            Self::CrossV => (3, 4),
        }
    }

    /// Returns whether a picture of this size consists of square faces in this layout.
    pub const fn has_shape(self, width: usize, height: usize) -> bool {
        let (columns, rows) = self.grid();
        let whole = width > 0 && width.is_multiple_of(columns) && height.is_multiple_of(rows);
        whole && width / columns == height / rows
    }

    /// Returns the mapping of its faces.
    pub const fn mapping(self) -> FaceMapping {
        match self {
            Self::Eac => FaceMapping::EquiAngular,
            _ => FaceMapping::Perspective,
        }
    }

    /// Returns column and row of each of its cells, in reading order.
    pub(crate) const fn places(self) -> [(usize, usize); 6] {
        match self {
            Self::StripH => [(0, 0), (1, 0), (2, 0), (3, 0), (4, 0), (5, 0)],
            Self::StripV => [(0, 0), (0, 1), (0, 2), (0, 3), (0, 4), (0, 5)],
            Self::ThreeByTwo | Self::Eac => [(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1)],
            Self::TwoByThree => [(0, 0), (1, 0), (0, 1), (1, 1), (0, 2), (1, 2)],
            Self::CrossH => [(1, 0), (0, 1), (1, 1), (2, 1), (3, 1), (1, 2)],
            Self::CrossV => [(1, 0), (0, 1), (1, 1), (2, 1), (1, 2), (1, 3)],
        }
    }

    /// Returns the face in each cell unless another order is given; in strips and grids it is ffmpeg's.
    pub(crate) const fn faces(self) -> [CubeFace; 6] {
        match self {
            Self::StripH | Self::StripV | Self::ThreeByTwo | Self::TwoByThree => [Right, Left, Up, Down, Front, Back],
            Self::CrossH => [Up, Left, Front, Right, Back, Down],
            Self::CrossV => [Up, Left, Front, Right, Down, Back],
            Self::Eac => [Left, Front, Right, Down, Back, Up],
        }
    }

    /// Returns the clockwise quarter turns of the picture in each cell.
    pub(crate) const fn turns(self) -> [u8; 6] {
        match self {
            Self::StripH | Self::StripV | Self::ThreeByTwo | Self::TwoByThree | Self::CrossH => [0; 6],
            Self::CrossV => [0, 0, 0, 0, 0, 2],
            // The faces of the lower row are continuous, too.
            Self::Eac => [0, 0, 0, 3, 1, 3],
        }
    }
}

impl std::fmt::Display for LayoutKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}
