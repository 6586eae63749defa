//! Projections that are given by a table, as the st maps of compositing programs are.

mod lattice;
mod tree;

use std::f64::consts::PI;

use glam::{DVec2, DVec3, Vec3};
use thiserror::Error;

use self::lattice::{Jet, Links, Samples};
use self::tree::{MOST_BEYOND, Tree};
use super::{PlanePoint, PlaneRect, Projection};
use crate::sphere::{Angle, Direction, DirectionJacobian};

/// Pairs of a point of a picture and the direction seen there, on a lattice of samples: what an st map together with the
/// projection of the picture at its other end says.
///
/// Directions are known where there are samples, and half a sample beyond. Places are known a little further.
///
/// The picture's plane is a square of side one around its middle, whatever the picture's shape: x from −½ (left) to ½, y from
/// −½ (bottom) to ½. Between samples the table is bicubic; where neighbours do not belong together, because one is
/// missing or the step between them is far longer than those beside it, each sample has the square around it for itself.
#[derive(Clone, Debug)]
pub struct StMapTable {
    places: Places,
    directions: Samples,
    links: Links,
    by_direction: Tree,
}

/// Where in the picture the samples are.
#[derive(Clone, Debug)]
enum Places {
    /// At the middles of its pixels.
    Regular,
    /// Anywhere.
    Table(Samples, Tree),
}

/// Why no projection can be made of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum StMapError {
    /// Nothing to interpolate between.
    #[error("no four neighbouring samples of the {width}x{height} hold places that belong together")]
    NoCells {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
    },
}

impl StMapTable {
    /// The table of a picture of which `direction` says where the pixel in column i of row j looks.
    ///
    /// # Errors
    /// When no four neighbours look anywhere.
    pub fn of_pixels(
        width: usize,
        height: usize,
        direction: impl Fn(usize, usize) -> Option<Direction>,
    ) -> Result<Self, StMapError> {
        let directions = Samples::of(width, height, |i, j| direction(i, j).map(Direction::vector));
        let links = Links::of(&[&directions]);
        Self::joined(Places::Regular, directions, links)
    }

    /// The table of samples anywhere in the picture: `sample` gives the place and the direction of that in column i of row j.
    /// Where several samples hold a place or a direction, as in a map that folds, the first of them has it.
    ///
    /// # Errors
    /// When no four neighbours belong together.
    pub fn of_places(
        width: usize,
        height: usize,
        sample: impl Fn(usize, usize) -> Option<(PlanePoint, Direction)>,
    ) -> Result<Self, StMapError> {
        let place = |i, j| sample(i, j).map(|(point, _)| DVec3::new(point.x, point.y, 0.0));
        let directions = Samples::of(width, height, |i, j| sample(i, j).map(|(_, seen)| seen.vector()));
        let places = Samples::of(width, height, place);
        let links = Links::of(&[&directions, &places]);
        let tree = Tree::new(&places, &links);
        Self::joined(Places::Table(places, tree), directions, links)
    }

    fn joined(places: Places, directions: Samples, links: Links) -> Result<Self, StMapError> {
        if !links.has_cell() {
            return Err(StMapError::NoCells { width: directions.width, height: directions.height });
        }
        let by_direction = Tree::new(&directions, &links);
        Ok(Self { places, directions, links, by_direction })
    }

    /// Columns and rows of samples.
    pub fn size(&self) -> (usize, usize) {
        (self.directions.width, self.directions.height)
    }

    /// The place in the picture at a point of the lattice or just outside it, and its derivatives.
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

    /// The point of the lattice at a place in the picture. Places around the outermost samples are found, too, so that a filter
    /// finds texels on all sides of what those see.
    fn find_place(&self, point: PlanePoint) -> Option<(f64, f64)> {
        let (width, height) = (self.directions.width as f64, self.directions.height as f64);
        match &self.places {
            Places::Regular => Some(((point.x + 0.5) * width, (0.5 - point.y) * height)),
            Places::Table(places, tree) => {
                tree.find(places, &self.links, DVec3::new(point.x, point.y, 0.0), MOST_BEYOND)
            }
        }
    }

    /// How far outside the lattice there are places.
    fn beyond(&self) -> f64 {
        match self.places {
            Places::Regular => 0.0,
            Places::Table(..) => MOST_BEYOND,
        }
    }

    /// The direction at a point of the lattice, with its derivatives along the lattice.
    fn direction(&self, x: f64, y: f64) -> Option<(Direction, DirectionJacobian)> {
        let Jet { value, dx, dy } = self.links.jet(&self.directions, x, y, self.beyond())?;
        let (direction, length) = (Direction::new(value)?, value.length());
        let unit = direction.vector();
        let tangent = |moved: DVec3| (moved - unit * unit.dot(moved)) / length;
        Some((direction, DirectionJacobian { dx: tangent(dx), dy: tangent(dy) }))
    }
}

impl Samples {
    fn of(width: usize, height: usize, value: impl Fn(usize, usize) -> Option<DVec3>) -> Self {
        let vector = |i, j| value(i, j).map_or(Vec3::NAN, DVec3::as_vec3);
        let values = (0..height).flat_map(|j| (0..width).map(move |i| (i, j))).map(|(i, j)| vector(i, j)).collect();
        Self { width, height, values }
    }
}

/// A projection that is a table.
///
/// Views are copied freely, so that they hold it by reference: a table lasts as long as the program, as what is read once
/// at its start does.
#[derive(Clone, Copy, Debug)]
pub struct StMap(pub &'static StMapTable);

/// Tables are equal if they are the same one.
impl PartialEq for StMap {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.0, other.0)
    }
}

impl Projection for StMap {
    fn project(&self, direction: Direction) -> Option<PlanePoint> {
        let table = self.0;
        let (x, y) = table.by_direction.find(&table.directions, &table.links, direction.vector(), 0.0)?;
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

    /// A table is nowhere singular, as far as it knows: where it ends, nothing is seen.
    fn margin(&self, _: Direction) -> f64 {
        PI
    }

    fn cap_bounds(&self, centre: Direction, radius: Angle) -> PlaneRect {
        let table = self.0;
        let chord = 2.0 * (radius.radians().min(PI) / 2.0).sin();
        let mut bounds: Option<PlaneRect> = None;
        let (width, height) = (table.directions.width as f64, table.directions.height as f64);
        let mut include = |x: f64, y: f64| {
            let point = PlanePoint::new(x, y);
            bounds = Some(bounds.map_or(PlaneRect { min: point, max: point }, |bounds| bounds.with(point)));
        };
        table.by_direction.search::<()>(centre.vector().as_vec3(), chord as f32, |leaf| {
            match &table.places {
                Places::Regular => {
                    let [(left, top), (right, bottom)] = leaf.rectangle(&table.directions);
                    include(left / width - 0.5, 0.5 - top / height);
                    include(right / width - 0.5, 0.5 - bottom / height);
                }
                Places::Table(_, tree) => {
                    let held = tree.bounds(leaf);
                    include(f64::from(held.min.x), f64::from(held.min.y));
                    include(f64::from(held.max.x), f64::from(held.max.y));
                }
            }
            None
        });
        let nowhere = PlanePoint::new(0.0, 0.0);
        bounds.unwrap_or(PlaneRect { min: nowhere, max: nowhere })
    }
}

#[cfg(test)]
mod tests;
