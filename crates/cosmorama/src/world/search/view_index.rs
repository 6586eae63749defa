use glam::DVec3;
use rayon::prelude::*;

use super::bounding_cone::SeenCone;
use crate::sphere::Direction;

/// Views of a world by direction: for each cell of a grid on the sphere, those that may show some of it, in their order.
///
/// Worlds of thousands of views would otherwise be searched from the first view to the last for every pixel.
#[derive(Clone, Debug)]
pub(crate) struct ViewIndex {
    /// Cells along each edge of a cube's face.
    edge: usize,
    /// Place of each cell's first view, and behind the last cell's.
    starts: Vec<u32>,
    views: Vec<u32>,
}

/// Number of views up to which all are tried.
const FEW: usize = 32;

/// Greatest number of cells along an edge.
const MOST: usize = 64;

/// Angle, in radians, by which cells overlap: more than directions on their borders are rounded.
const ROUNDING: f64 = 1e-6;

impl ViewIndex {
    /// Sorts views by their cones; a view without a cone may show anything. `None` where they are few.
    pub(crate) fn of(cones: &[Option<SeenCone>]) -> Option<Self> {
        if cones.len() <= FEW {
            return None;
        }
        // About as many cells as views.
        let edge = (1..MOST).take_while(|edge| 6 * edge * edge < cones.len()).last().unwrap_or(1);
        let list = |cell: usize| -> Vec<u32> {
            let (middle, radius) = bounds(edge, cell);
            let reaches = |cone: &SeenCone| cone.reaches(middle, radius + ROUNDING);
            let may_show = |(_, cone): &(u32, &Option<SeenCone>)| cone.as_ref().is_none_or(reaches);
            (0..).zip(cones).filter(may_show).map(|(index, _)| index).collect()
        };
        let lists: Vec<Vec<u32>> = (0..6 * edge * edge).into_par_iter().map(list).collect();
        let mut starts = vec![0];
        for list in &lists {
            starts.push(starts[starts.len() - 1] + list.len() as u32);
        }
        Some(Self { edge, starts, views: lists.concat() })
    }

    /// Visits the views that may show a direction, in their order.
    pub(crate) fn at(&self, direction: Direction) -> impl Iterator<Item = usize> + '_ {
        let cell = cell(self.edge, direction.vector());
        let views = &self.views[self.starts[cell] as usize..self.starts[cell + 1] as usize];
        views.iter().map(|view| *view as usize)
    }
}

/// Returns the cell of a direction: by its longest component, and the two others over that.
fn cell(edge: usize, vector: DVec3) -> usize {
    let size = vector.abs();
    let axis = if size.x >= size.y && size.x >= size.z { 0 } else { 1 + usize::from(size.z > size.y) };
    let longest = vector[axis];
    let place = |other: f64| (((other / longest + 1.0) * 0.5 * edge as f64) as usize).min(edge - 1);
    let face = 2 * axis + usize::from(longest < 0.0);
    (face * edge + place(vector[(axis + 2) % 3])) * edge + place(vector[(axis + 1) % 3])
}

/// Returns the middle of a cell, and the greatest angle between it and a direction of the cell, in radians.
fn bounds(edge: usize, cell: usize) -> (Direction, f64) {
    let (face, row, column) = (cell / (edge * edge), cell / edge % edge, cell % edge);
    let (axis, side) = (face / 2, if face % 2 == 0 { 1.0 } else { -1.0 });
    let at = |column: f64, row: f64| {
        let place = |steps: f64| side * (2.0 * steps / edge as f64 - 1.0);
        let mut vector = DVec3::ZERO;
        vector[axis] = side;
        vector[(axis + 1) % 3] = place(column);
        vector[(axis + 2) % 3] = place(row);
        Direction::from_unit(vector.normalize())
    };
    let (column, row) = (column as f64, row as f64);
    let middle = at(column + 0.5, row + 0.5);
    // Farthest from the middle are the corners.
    let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
    let apart = corners.map(|(right, down)| middle.angle_to(at(column + right, row + down)).radians());
    (middle, apart.into_iter().fold(0.0, f64::max))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_direction_is_within_the_bounds_of_its_cell() {
        for edge in [1, 2, 7, 64] {
            for direction in Direction::spread(20_000) {
                let (middle, radius) = bounds(edge, cell(edge, direction.vector()));
                assert!(middle.angle_to(direction).radians() <= radius + ROUNDING, "{edge} {direction:?}");
            }
        }
        for axis in
            [Direction::UP, Direction::DOWN, Direction::LEFT, Direction::RIGHT, Direction::FRONT, Direction::BACK]
        {
            let (middle, radius) = bounds(8, cell(8, axis.vector()));
            assert!(middle.angle_to(axis).radians() <= radius + ROUNDING, "{axis:?}");
        }
    }
}
