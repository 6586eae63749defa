use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use super::bounding_cone::SeenCone;
use crate::sphere::Direction;

/// Views of a world by direction: for each cell of some grids on the sphere, those that may show something near it, in their order.
///
/// Worlds of thousands of views would otherwise be searched from the first view to the last for every pixel.
#[derive(Clone, Debug)]
pub(crate) struct ViewIndex {
    /// Number of all views.
    count: usize,
    /// Views that show so much that they stand in no grid.
    wide: Vec<u32>,
    /// Grids, the coarsest first.
    grids: Vec<Grid>,
}

/// Narrow views by the cells of one grid.
#[derive(Clone, Debug)]
struct Grid {
    /// Cells along each edge of a cube's face.
    edge: usize,
    /// Place of each cell's first view, and behind the last cell's.
    starts: Vec<u32>,
    views: Vec<u32>,
}

/// Views that may show something near a direction, in their order: all of them, or those of a cell and the wide ones.
pub(crate) enum Near<'a> {
    All(Range<usize>),
    Cell { narrow: &'a [u32], wide: &'a [u32] },
}

/// Number of views up to which all are tried.
const FEW: usize = 32;

/// Greatest number of cells along an edge.
const MOST: usize = 64;

/// Angle, in radians, by which cells overlap: more than directions on their borders are rounded.
const ROUNDING: f64 = 1e-6;

/// Half the angle of a view, in radians, from which on it is wide: it would stand in a tenth of all cells, or more.
const WIDE: f64 = 0.5;

impl ViewIndex {
    /// Sorts views by their cones; a view without a cone may show anything. `None` where they are few.
    pub(crate) fn of(cones: &[Option<SeenCone>]) -> Option<Self> {
        if cones.len() <= FEW {
            return None;
        }
        let is_narrow = |cone: &Option<SeenCone>| cone.is_some_and(|cone| cone.half().radians() < WIDE);
        let of_kind = |kind: bool| (0..).zip(cones).filter(move |(_, cone)| is_narrow(cone) == kind);
        let narrow: Vec<(u32, SeenCone)> = of_kind(true).filter_map(|(view, cone)| Some((view, (*cone)?))).collect();
        let wide = of_kind(false).map(|(view, _)| view).collect();
        let mut grids = vec![Grid::of(1, |_| narrow.clone())];
        // Up to about as many cells as views.
        for edge in (1..).map(|level| 1 << level).take_while(|edge| *edge <= MOST && 2 * edge * edge <= narrow.len()) {
            let coarser = &grids[grids.len() - 1];
            let within = |cell: usize| {
                let within = coarser.at(coarser.holding(edge, cell));
                let cone = |view: &u32| narrow.binary_search_by_key(view, |(view, _)| *view).map(|at| narrow[at]);
                within.iter().flat_map(cone).collect()
            };
            let grid = Grid::of(edge, within);
            grids.push(grid);
        }
        Some(Self { count: cones.len(), wide, grids })
    }

    /// Visits, in their order, the views that may show something within `radius` radians of a direction. Some of them may not.
    pub(crate) fn near(&self, direction: Direction, radius: f64) -> Near<'_> {
        match self.grids.iter().rev().find(|grid| radius <= grid.around()) {
            Some(grid) => Near::Cell { narrow: grid.at(cell(grid.edge, direction.vector())), wide: &self.wide },
            None => Near::All(0..self.count),
        }
    }
}

impl Grid {
    /// Sorts the views into the cells of a grid; `within` lists those that a cell may have.
    fn of(edge: usize, within: impl Fn(usize) -> Vec<(u32, SeenCone)> + Sync) -> Self {
        let list = |cell: usize| -> Vec<u32> {
            let (middle, radius) = bounds(edge, cell);
            let reach = radius + around(edge) + ROUNDING;
            within(cell).into_iter().filter(|(_, cone)| cone.reaches(middle, reach)).map(|(view, _)| view).collect()
        };
        let lists: Vec<Vec<u32>> = (0..6 * edge * edge).into_par_iter().map(list).collect();
        let mut starts = vec![0];
        for list in &lists {
            starts.push(starts[starts.len() - 1] + list.len() as u32);
        }
        Self { edge, starts, views: lists.concat() }
    }

    /// Returns the views of a cell.
    fn at(&self, cell: usize) -> &[u32] {
        &self.views[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }

    /// Returns the cell that holds one of a grid of twice the edge.
    fn holding(&self, edge: usize, cell: usize) -> usize {
        let (face, row, column) = place(edge, cell);
        (face * self.edge + row / 2) * self.edge + column / 2
    }

    /// Returns the angle around a cell, in radians, within which its views are listed.
    fn around(&self) -> f64 {
        around(self.edge)
    }
}

impl Iterator for Near<'_> {
    type Item = usize;

    fn next(&mut self) -> Option<usize> {
        let (narrow, wide) = match self {
            Self::All(all) => return all.next(),
            Self::Cell { narrow, wide } => (narrow, wide),
        };
        let is_wide = match (narrow.first(), wide.first()) {
            (Some(narrow), Some(wide)) => wide < narrow,
            (narrow, _) => narrow.is_none(),
        };
        let list = if is_wide { wide } else { narrow };
        let left = *list;
        let (first, rest) = left.split_first()?;
        *list = rest;
        Some(*first as usize)
    }
}

/// Returns the angle around the cells of a grid, in radians, within which their views are listed: about half a cell's edge.
fn around(edge: usize) -> f64 {
    1.0 / edge as f64
}

/// Returns the face, the row and the column of a cell.
fn place(edge: usize, cell: usize) -> (usize, usize, usize) {
    (cell / (edge * edge), cell / edge % edge, cell % edge)
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
    let (face, row, column) = place(edge, cell);
    let (axis, side) = (face / 2, if face % 2 == 0 { 1.0 } else { -1.0 });
    let at = |column: f64, row: f64| {
        let across = |steps: f64| side * (2.0 * steps / edge as f64 - 1.0);
        let mut vector = DVec3::ZERO;
        vector[axis] = side;
        vector[(axis + 1) % 3] = across(column);
        vector[(axis + 2) % 3] = across(row);
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
    use crate::camera::{CameraModel, FieldOfView, PerspectiveCamera, View};
    use crate::sphere::{Angle, Orientation};

    /// Makes the cones of views of these fields in degrees, all over the sphere; none for 0, as of a panorama.
    fn cones(fields: &[f64], count: usize) -> Vec<Option<SeenCone>> {
        let cone = |(direction, field): (Direction, &f64)| {
            let (yaw, pitch) = direction.longitude_latitude();
            let camera = PerspectiveCamera::new(FieldOfView::Horizontal(Angle::from_degrees(*field)));
            let view = (*field > 0.0).then(|| CameraModel::Perspective(camera).view(16, 8).expect("a size"))?;
            SeenCone::of(&View { orientation: Orientation::from_yaw_pitch_roll(yaw, pitch, Angle::ZERO), ..view })
        };
        Direction::spread(count).zip(fields.iter().cycle()).map(cone).collect()
    }

    #[test]
    fn what_is_near_is_found_in_order() {
        for (fields, count) in [(&[4.0][..], 3000), (&[4.0, 4.0, 90.0, 0.0, 20.0], 700), (&[0.0], 40), (&[4.0], 33)] {
            let cones = cones(fields, count);
            let index = ViewIndex::of(&cones).expect("many views");
            for (direction, radius) in Direction::spread(500).zip([0.0, 1e-3, 0.02, 0.1, 0.7, 4.0].iter().cycle()) {
                let found: Vec<usize> = index.near(direction, *radius).collect();
                assert!(found.is_sorted_by(|a, b| a < b), "{found:?}");
                for (view, cone) in cones.iter().enumerate() {
                    let reaches = cone.is_none_or(|cone| cone.reaches(direction, *radius));
                    assert!(
                        !reaches || found.binary_search(&view).is_ok(),
                        "{view} of {fields:?} is near {direction:?}"
                    );
                }
            }
        }
        assert!(ViewIndex::of(&cones(&[4.0], FEW)).is_none());
    }

    /// Checks that what is tried for a pixel stays about the same, however many small views there are.
    #[test]
    fn few_of_many_views_are_tried() {
        for count in [1000, 10_000] {
            let index = ViewIndex::of(&cones(&[180.0 / f64::sqrt(count as f64)], count)).expect("many views");
            let tried = Direction::spread(500).map(|direction| index.near(direction, 0.0).count()).max();
            assert!(tried.is_some_and(|tried| tried < 60), "{tried:?} of {count}");
        }
    }

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
