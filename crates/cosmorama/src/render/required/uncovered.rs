use std::fmt;

use crate::sphere::{Direction, Extent};

/// Target pixels whose direction no view covers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uncovered {
    /// Number of these pixels, in all targets together.
    pub pixels: usize,
    /// Index of the first pixel's target.
    pub target: usize,
    /// Column of the first pixel.
    pub column: usize,
    /// Row of the first pixel.
    pub row: usize,
    /// Direction of the first pixel.
    pub direction: Direction,
    /// Extent of the directions of all these pixels.
    pub extent: Extent,
}

impl Uncovered {
    /// Returns one uncovered pixel of a target, with its direction.
    pub(crate) fn pixel(target: usize, (column, row): (usize, usize), direction: Direction) -> Self {
        Self { pixels: 1, target, column, row, direction, extent: Extent::of(direction) }
    }

    /// Merges two sets of uncovered pixels.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
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
