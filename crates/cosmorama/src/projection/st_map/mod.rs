//! Projections that are given by a table, like the st maps of compositing programs.

mod lattice;
mod piece;
#[cfg(test)]
mod tests;
mod tree;

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DVec2, DVec3, Vec3};
use rayon::prelude::*;
use thiserror::Error;

use self::lattice::{Jet, Links, Samples};
use self::piece::{LEAF, Leaf, MOST_PIECES, Piece};
use self::tree::{MOST_BEYOND, Tree};
use super::{Outline, PlanePoint, PlaneRect, Projection};
use crate::sphere::{Angle, Direction, DirectionJacobian};

/// Table that pairs places in a picture with the directions seen there, on a lattice of samples. An st map makes such a
/// table, together with the projection of the picture at its other end.
///
/// Directions are defined where there are samples, and half a sample beyond. Places are defined a little further.
///
/// The picture's plane is a square of side one around its middle, whatever the picture's shape: x from −½ (left) to ½,
/// y from −½ (bottom) to ½. Between samples the table is bicubic. Where neighbours are not connected, because one is
/// missing or the step between them is far longer than those beside it, each sample has the square around it to itself.
#[derive(Clone, Debug)]
pub struct StMapTable {
    places: Places,
    directions: Samples,
    links: Links,
    /// Leaves of the pieces, in their order in the trees.
    leaves: Vec<Leaf>,
    by_direction: Tree,
}

/// Bytes of a piece in a table: its leaf, its box, its entry in the tree with a share of the nodes above, and what is held of it while
/// trees are built.
const PIECE: u64 = 176;

/// Returns the number of tables: of directions, and of places.
fn tables(has_places: bool) -> u64 {
    if has_places { 2 } else { 1 }
}

/// Returns the number of leaves of a lattice.
fn leaves_of((width, height): (usize, usize)) -> u64 {
    (width.div_ceil(LEAF) as u64).saturating_mul(height.div_ceil(LEAF) as u64)
}

/// Returns the bytes of a value of each sample in each table, of its flags, and of pieces: one a leaf, at least.
fn bytes_of(size: (usize, usize), tables: u64, pieces: u64) -> u64 {
    let samples = (size.0 as u64).saturating_mul(size.1 as u64);
    let values = samples.saturating_mul(tables * size_of::<Vec3>() as u64 + 1);
    values.saturating_add(pieces.max(leaves_of(size)).saturating_mul(tables * PIECE))
}

/// Greatest number of rectangles of an outline; beyond it one rectangle is used.
const MOST_RECTS: usize = 64;

/// Positions of the samples in the picture.
#[derive(Clone, Debug)]
enum Places {
    /// At the centres of its pixels.
    Regular,
    /// Anywhere, by a table and its search tree.
    Table(Samples, Tree),
}

/// Reason why a table does not make a projection.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum StMapError {
    /// No four neighbouring samples are connected.
    #[error("no four neighbouring samples of the {width}x{height} hold places that belong together")]
    NoCells {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
    },
}

impl StMapTable {
    /// Creates the table of a picture; `direction` gives the direction of the pixel in column i of row j.
    ///
    /// # Errors
    /// When no four neighbouring pixels have a direction.
    pub fn of_pixels(
        width: usize,
        height: usize,
        direction: impl Fn(usize, usize) -> Option<Direction> + Sync,
    ) -> Result<Self, StMapError> {
        let directions = Samples::of(width, height, |i, j| direction(i, j).map(Direction::vector));
        Self::joined(directions, None)
    }

    /// Creates the table of samples anywhere in the picture; `sample` gives the place and the direction of the sample
    /// in column i of row j. Where several samples hold a place or a direction, as in a map that folds, the first wins.
    ///
    /// # Errors
    /// When no four neighbouring samples are connected.
    pub fn of_places(
        width: usize,
        height: usize,
        sample: impl Fn(usize, usize) -> Option<(PlanePoint, Direction)> + Sync,
    ) -> Result<Self, StMapError> {
        let place = |i, j| sample(i, j).map(|(point, _)| DVec3::new(point.x, point.y, 0.0));
        let directions = Samples::of(width, height, |i, j| sample(i, j).map(|(_, seen)| seen.vector()));
        let places = Samples::of(width, height, place);
        Self::joined(directions, Some(places))
    }

    fn joined(directions: Samples, places: Option<Samples>) -> Result<Self, StMapError> {
        let tables: Vec<&Samples> = std::iter::once(&directions).chain(&places).collect();
        let links = Links::of(&tables);
        let pieces = Piece::all(&links);
        if pieces.is_empty() {
            return Err(StMapError::NoCells { width: directions.width, height: directions.height });
        }
        let by_direction = Tree::new(&directions, &links, &pieces, 0.0);
        let places = places.map_or(Places::Regular, |places| {
            let tree = Tree::new(&places, &links, &pieces, MOST_BEYOND);
            Places::Table(places, tree)
        });
        let mut leaves: Vec<_> = pieces.into_iter().map(|piece| piece.leaf).collect();
        // It may have kept the memory of the pieces.
        leaves.shrink_to_fit();
        Ok(Self { places, directions, links, leaves, by_direction })
    }

    /// Returns the columns and rows of samples.
    pub fn size(&self) -> (usize, usize) {
        (self.directions.width, self.directions.height)
    }

    /// Returns the place in the picture at a point of the lattice or just outside it, and its derivatives.
    fn place(&self, x: f64, y: f64) -> Option<[DVec2; 3]> {
        let (width, height) = (self.directions.width as f64, self.directions.height as f64);
        match &self.places {
            Places::Regular => Some([
                DVec2::new(x / width - 0.5, 0.5 - y / height),
                DVec2::new(width.recip(), 0.0),
                DVec2::new(0.0, -height.recip()),
            ]),
            Places::Table(places, _) => {
                let Jet { value, dx, dy } = self.links.jet(places, x, y, MOST_BEYOND)?;
                Some([value, dx, dy].map(|vector| vector.truncate()))
            }
        }
    }

    /// Finds the point of the lattice at a place in the picture. It also finds places just outside the outermost
    /// samples, so that a filter finds texels on all sides of a footprint there.
    fn find_place(&self, point: PlanePoint) -> Option<(f64, f64)> {
        let (width, height) = (self.directions.width as f64, self.directions.height as f64);
        match &self.places {
            Places::Regular => Some(((point.x + 0.5) * width, (0.5 - point.y) * height)),
            Places::Table(places, tree) => {
                tree.find(self.lattice(places), DVec3::new(point.x, point.y, 0.0), MOST_BEYOND)
            }
        }
    }

    fn lattice<'a>(&'a self, samples: &'a Samples) -> (&'a Samples, &'a Links, &'a [Leaf]) {
        (samples, &self.links, &self.leaves)
    }

    /// Returns, piece by piece, the parts of the picture that may hold directions within `radius` of a direction.
    fn rects_within(&self, centre: Direction, radius: Angle) -> impl Iterator<Item = PlaneRect> {
        let chord = 2.0 * (radius.radians().min(PI) / 2.0).sin();
        let (width, height) = (self.directions.width as f64, self.directions.height as f64);
        let rect = move |piece: usize| match &self.places {
            Places::Regular => {
                let [(left, top), (right, bottom)] = self.leaves[piece].rectangle(&self.directions);
                PlaneRect {
                    min: PlanePoint::new(left / width - 0.5, 0.5 - bottom / height),
                    max: PlanePoint::new(right / width - 0.5, 0.5 - top / height),
                }
            }
            Places::Table(_, tree) => {
                let held = tree.bounds(piece);
                let corner = |at: Vec3| PlanePoint::new(f64::from(at.x), f64::from(at.y));
                PlaneRect { min: corner(held.min), max: corner(held.max) }
            }
        };
        self.by_direction.within(centre.vector().as_vec3(), chord as f32).map(rect)
    }

    /// Estimates the memory, in bytes, that a table of so many columns and rows takes, with or without places of its
    /// own, if it is torn everywhere.
    pub fn bytes_at_most(size: (usize, usize), has_places: bool) -> u64 {
        let most = leaves_of(size).saturating_mul(MOST_PIECES as u64);
        bytes_of(size, tables(has_places), most)
    }

    fn bytes(&self) -> u64 {
        let has_places = matches!(self.places, Places::Table(..));
        bytes_of(self.size(), tables(has_places), self.leaves.len() as u64)
    }

    /// Returns how far outside the lattice places are defined.
    fn beyond(&self) -> f64 {
        match self.places {
            Places::Regular => 0.0,
            Places::Table(..) => MOST_BEYOND,
        }
    }

    /// Returns the direction at a point of the lattice, with its derivatives along the lattice.
    fn direction(&self, x: f64, y: f64) -> Option<(Direction, DirectionJacobian)> {
        let Jet { value, dx, dy } = self.links.jet(&self.directions, x, y, self.beyond())?;
        let (direction, length) = (Direction::new(value)?, value.length());
        let unit = direction.vector();
        let tangent = |moved: DVec3| (moved - unit * unit.dot(moved)) / length;
        Some((direction, DirectionJacobian { dx: tangent(dx), dy: tangent(dy) }))
    }
}

impl Samples {
    fn of(width: usize, height: usize, value: impl Fn(usize, usize) -> Option<DVec3> + Sync) -> Self {
        // Filled in place: lists of rows that are joined would take the memory twice.
        let mut values = vec![Vec3::NAN; width * height];
        values.par_chunks_exact_mut(width.max(1)).enumerate().for_each(|(j, row)| {
            for (i, sample) in row.iter_mut().enumerate() {
                *sample = value(i, j).map_or(Vec3::NAN, DVec3::as_vec3);
            }
        });
        Self { width, height, values }
    }
}

/// A projection that is given by a table.
///
/// Clones share the table.
#[derive(Clone, Debug)]
pub struct StMap(Arc<StMapTable>);

impl StMap {
    /// Creates the projection of a table.
    pub fn new(table: StMapTable) -> Self {
        Self(Arc::new(table))
    }

    /// Returns the memory that its table takes, in bytes.
    pub fn bytes(&self) -> u64 {
        self.0.bytes()
    }
}

/// Two projections are equal if they share one table.
impl PartialEq for StMap {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl Projection for StMap {
    fn project(&self, direction: Direction) -> Option<PlanePoint> {
        let table = &*self.0;
        let (x, y) = table.by_direction.find(table.lattice(&table.directions), direction.vector(), 0.0)?;
        let [place, ..] = table.place(x, y)?;
        Some(PlanePoint::new(place.x, place.y))
    }

    fn unproject(&self, point: PlanePoint) -> Option<Direction> {
        let (x, y) = self.0.find_place(point)?;
        self.0.direction(x, y).map(|(direction, _)| direction)
    }

    fn jacobian(&self, point: PlanePoint) -> Option<DirectionJacobian> {
        self.unproject_with_jacobian(point).map(|(_, jacobian)| jacobian)
    }

    fn unproject_with_jacobian(&self, point: PlanePoint) -> Option<(Direction, DirectionJacobian)> {
        let (x, y) = self.0.find_place(point)?;
        let (direction, lattice) = self.0.direction(x, y)?;
        let [_, along, down] = self.0.place(x, y)?;
        // ∂direction/∂place = ∂direction/∂lattice · (∂place/∂lattice)⁻¹.
        let determinant = along.perp_dot(down);
        if determinant == 0.0 {
            return None;
        }
        let jacobian = DirectionJacobian {
            dx: (lattice.dx * down.y - lattice.dy * along.y) / determinant,
            dy: (lattice.dy * along.x - lattice.dx * down.x) / determinant,
        };
        Some((direction, jacobian))
    }

    /// Returns π: a table has no known singularity, and beyond its end nothing is seen.
    fn margin(&self, _: Direction) -> f64 {
        PI
    }

    fn cap_bounds(&self, centre: Direction, radius: Angle) -> PlaneRect {
        let corners = self.0.rects_within(centre, radius).flat_map(|rect| [rect.min, rect.max]);
        let bounds = corners.fold(PlaneRect::NOTHING, PlaneRect::with);
        let nowhere = PlanePoint::new(0.0, 0.0);
        if bounds.min.x <= bounds.max.x { bounds } else { PlaneRect { min: nowhere, max: nowhere } }
    }

    /// Returns a rectangle for each piece of the map that a cap lies in: where the map is torn, these are several.
    fn cap_outline(&self, centre: Direction, radius: Angle) -> Outline {
        let rects: Vec<PlaneRect> = self.0.rects_within(centre, radius).take(MOST_RECTS + 1).collect();
        Outline::Rects(if rects.len() > MOST_RECTS { vec![self.cap_bounds(centre, radius)] } else { rects })
    }
}
