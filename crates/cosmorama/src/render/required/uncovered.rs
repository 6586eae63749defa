use std::fmt;

use crate::sphere::{Direction, Extent};

/// Target pixels that look where no view does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uncovered {
    /// How many there are, in all targets together.
    pub pixels: usize,
    /// Index of the target of the first of them.
    pub target: usize,
    /// The column of the first of them.
    pub column: usize,
    /// Its row.
    pub row: usize,
    /// Where it looks.
    pub direction: Direction,
    /// Where all of them look.
    pub extent: Extent,
}

impl Uncovered {
    /// One pixel of a target, and where it looks.
    pub(crate) fn pixel(target: usize, (column, row): (usize, usize), direction: Direction) -> Self {
        Self { pixels: 1, target, column, row, direction, extent: Extent::of(direction) }
    }

    /// Both together.
    pub(crate) fn union(self, other: Self) -> Self {
        let place = |uncovered: &Self| (uncovered.target, uncovered.row, uncovered.column);
        let first = if place(&other) < place(&self) { other } else { self };
        Self { pixels: self.pixels + other.pixels, extent: self.extent.union(other.extent), ..first }
    }
}

impl fmt::Display for Uncovered {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (yaw, pitch) = self.direction.longitude_latitude();
        let (yaw, pitch) = (yaw.degrees(), pitch.degrees());
        let Self { pixels, column, row, extent, .. } = self;
        if *pixels == 1 {
            return write!(
                f,
                "1 pixel looks where no view does: column {column}, row {row} (yaw {yaw:.1}°, pitch {pitch:.1}°)"
            );
        }
        write!(
            f,
            "{pixels} pixels look where no view does, within {extent}: first column {column}, row {row} (yaw {yaw:.1}°, pitch \
             {pitch:.1}°)"
        )
    }
}
