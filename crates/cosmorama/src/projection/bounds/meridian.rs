//! Meridians as edges of maps: lower bounds of the angle to them.

use glam::{DVec2, DVec3};

use crate::sphere::Direction;

/// Returns a lower bound of the angle, in radians, to the meridian straight behind, from pole to pole.
pub(crate) fn distance_to_the_one_behind(direction: Direction) -> f64 {
    let vector = direction.vector();
    if vector.z > 0.0 { vector.x.abs() } else { DVec2::new(vector.x, vector.z).length() }
}

/// Returns the direction mirrored at the meridian behind.
pub(crate) fn mirrored(direction: Direction) -> Direction {
    let vector = direction.vector();
    Direction::from_unit(DVec3::new(-vector.x, vector.y, vector.z))
}

/// Returns a lower bound of the angle, in radians, to the meridians at the longitudes ±`limit` (given as cosine and
/// sine, 0 to 180°). It is negative between them and the back.
pub(crate) fn distance_to_the_two_at(limit: DVec2, direction: Direction) -> f64 {
    let vector = direction.vector();
    // From the meridian on this side: along it, and across it towards the front.
    let (front, side) = (-vector.z, vector.x.abs());
    let along = front * limit.x + side * limit.y;
    let across = front * limit.y - side * limit.x;
    if across <= 0.0 || along > 0.0 { across } else { DVec2::new(vector.x, vector.z).length() }
}
