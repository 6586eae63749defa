//! Continuation of a world beyond its edge: mirrored or stretched.

use std::f64::consts::TAU;

use glam::DVec3;
use rayon::prelude::*;
use rstar::RTree;
use rstar::primitives::GeomWithData;

use crate::camera::Footprint;
use crate::sphere::{CubeFace, Direction, DirectionJacobian};
use crate::world::World;

/// Way in which a world goes on beyond its edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beyond {
    /// Direction that lies as far from the nearest point of the edge, on its other side, as in a mirror that stands there.
    Mirror,
    /// The nearest direction that the world covers.
    Stretch,
}

/// Edge of a world, which finds where directions beyond it look instead.
///
/// The edge is known by points on it, a third of a degree apart, and goes along great circles between them.
#[derive(Clone, Debug)]
pub struct Continuation {
    points: RTree<GeomWithData<[f64; 3], usize>>,
    /// Points on either side of each along the edge.
    neighbours: Vec<[Option<DVec3>; 2]>,
}

/// Nodes along a side of a cube's face, between which the edge is looked for.
const NODES: usize = 256;

/// Distance of two nodes, at most, in radians.
const SPACING: f64 = TAU / 4.0 / NODES as f64 * 1.3;

/// Halvings of the way between two nodes.
const HALVINGS: usize = 40;

/// Greatest length of a pixel's footprint beyond the edge, in lengths of its own.
const WIDEST: f64 = 16.0;

impl Continuation {
    /// Finds the edge of a world; `None` if it has none, or shows nothing.
    pub fn of(world: &World) -> Option<Self> {
        let rows = CubeFace::ALL.into_par_iter().flat_map(|face| (0..=NODES).into_par_iter().map(move |j| (face, j)));
        let found: Vec<DVec3> = rows.flat_map_iter(|(face, j)| edge_points(world, face, j)).collect();
        if found.is_empty() {
            return None;
        }
        let entry = |(index, point): (usize, &DVec3)| GeomWithData::new(point.to_array(), index);
        let points = RTree::bulk_load(found.iter().enumerate().map(entry).collect());
        let neighbours = found.par_iter().map(|point| neighbours(&points, *point)).collect();
        Some(Self { points, neighbours })
    }

    /// Returns the point of the edge that is nearest to a direction.
    fn nearest(&self, direction: DVec3) -> Option<DVec3> {
        let found = self.points.nearest_neighbor(direction.to_array())?;
        let point = DVec3::from_array(*found.geom());
        let arcs = self.neighbours[found.data].iter().flatten().filter_map(|other| on_arc(direction, point, *other));
        let nearer = |a: &DVec3, b: &DVec3| a.dot(direction).total_cmp(&b.dot(direction));
        arcs.chain([point]).max_by(nearer)
    }

    /// Returns the direction that stands for one beyond the edge.
    pub fn direction(&self, world: &World, direction: Direction, beyond: Beyond) -> Option<Direction> {
        let from = direction.vector();
        let edge = self.nearest(from)?;
        let nearest = Direction::new(edge)?;
        if beyond == Beyond::Stretch {
            return Some(nearest);
        }
        // As far on the other side; less where the world ends there, too.
        let angle = direction.angle_to(nearest).radians();
        let ahead = (edge * edge.dot(from) - from).try_normalize()?;
        let at = |part: f64| Direction::new(edge * (part * angle).cos() + ahead * (part * angle).sin());
        let parts = [1.0, 0.5, 0.25, 0.125, 0.0];
        parts.into_iter().filter_map(at).find(|found| world.owner(*found).is_some()).or(Some(nearest))
    }

    /// Returns the footprint that stands for a pixel's beyond the edge.
    pub fn footprint(&self, world: &World, pixel: &Footprint, beyond: Beyond) -> Option<Footprint> {
        let at = |offset: DVec3| self.direction(world, Direction::new(pixel.direction.vector() + offset)?, beyond);
        let direction = at(DVec3::ZERO)?;
        // By ways along great circles; at the points where the nearest edge is another, no wider than what a filter can bear.
        let difference = |step: DVec3| {
            let moved = at(step)?;
            let here = direction.vector();
            let ahead = moved.vector().reject_from_normalized(here).normalize_or_zero();
            // Once more, since of opposite directions the first time leaves rounding.
            let way = ahead.reject_from_normalized(here) * direction.angle_to(moved).radians();
            Some(way.clamp_length_max(WIDEST * step.length()))
        };
        let DirectionJacobian { dx, dy } = pixel.jacobian;
        Some(Footprint { direction, jacobian: DirectionJacobian { dx: difference(dx)?, dy: difference(dy)? } })
    }
}

/// A node of a cube's face, and whether the world covers it.
type Node = Option<(Direction, bool)>;

/// Returns the points of the edge between the nodes of a row of a cube's face, and between these and the row below.
fn edge_points(world: &World, face: CubeFace, j: usize) -> Vec<DVec3> {
    let orientation = face.orientation();
    let node = |i: usize, j: usize| {
        let at = |k: usize| 2.0 * k as f64 / NODES as f64 - 1.0;
        let direction = Direction::new(DVec3::new(at(i), -at(j), -1.0))?;
        Some(orientation.to_world(direction))
    };
    let is_covered = |direction: Direction| world.owner(direction).is_some();
    let seen = |i: usize, j: usize| node(i, j).map(|direction| (direction, is_covered(direction)));
    let row: Vec<_> = (0..=NODES).map(|i| seen(i, j)).collect();
    let below: Vec<_> = if j < NODES { (0..=NODES).map(|i| seen(i, j + 1)).collect() } else { Vec::new() };
    let pairs = row.iter().zip(row.iter().skip(1)).chain(row.iter().zip(&below));
    let crossing = |(a, b): (&Node, &Node)| match (a, b) {
        (Some((inside, true)), Some((outside, false))) | (Some((outside, false)), Some((inside, true))) => {
            last_covered(inside.vector(), outside.vector(), is_covered)
        }
        _ => None,
    };
    pairs.filter_map(crossing).collect()
}

/// Returns the last point that is covered on the way from one that is to one that is not.
fn last_covered(inside: DVec3, outside: DVec3, is_covered: impl Fn(Direction) -> bool) -> Option<DVec3> {
    let (mut inside, mut outside) = (inside, outside);
    for _ in 0..HALVINGS {
        let middle = Direction::new(inside + outside)?;
        *(if is_covered(middle) { &mut inside } else { &mut outside }) = middle.vector();
    }
    Some(inside)
}

/// Returns the points next to one on either side of it.
fn neighbours(points: &RTree<GeomWithData<[f64; 3], usize>>, point: DVec3) -> [Option<DVec3>; 2] {
    let near = points
        .nearest_neighbor_iter(point.to_array())
        .map(|entry| DVec3::from_array(*entry.geom()))
        .take_while(|other| other.distance(point) < 2.0 * SPACING)
        .filter(|other| other.distance(point) > 1e-6 * SPACING);
    let near: Vec<DVec3> = near.collect();
    let first = near.first().copied();
    let other = first.and_then(|first| near.iter().find(|other| (**other - point).dot(first - point) < 0.0).copied());
    [first, other]
}

/// Returns the point nearest to a direction on the arc between two points; `None` if that is one of its ends.
fn on_arc(direction: DVec3, a: DVec3, b: DVec3) -> Option<DVec3> {
    let normal = a.cross(b).try_normalize()?;
    let nearest = direction.reject_from_normalized(normal).try_normalize()?;
    let is_between = a.cross(nearest).dot(normal) >= 0.0 && nearest.cross(b).dot(normal) >= 0.0;
    is_between.then_some(nearest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{CameraModel, CubeFaceCamera, EquirectCamera, FisheyeCamera, View};
    use crate::sphere::{Angle, Orientation};

    fn dome(pitch: f64, field: f64) -> World {
        let frame = FisheyeCamera { field_of_view: Angle::from_degrees(field), ..FisheyeCamera::default() };
        let view = CameraModel::Fisheye(frame).view(64, 64).unwrap();
        let pitch = Angle::from_degrees(pitch);
        let orientation = Orientation::from_yaw_pitch_roll(Angle::ZERO, pitch, Angle::ZERO);
        World::new([("sky".to_owned(), View { orientation, ..view })]).unwrap()
    }

    #[test]
    fn below_the_horizon_of_a_sky_it_is_mirrored_or_stretched() {
        let world = dome(90.0, 180.0);
        let edge = Continuation::of(&world).unwrap();
        for k in 0..200 {
            let (yaw, pitch) = (f64::from(k) * 7.3, -0.4 - f64::from(k) * 0.44);
            let direction = Direction::from_longitude_latitude(Angle::from_degrees(yaw), Angle::from_degrees(pitch));
            for (beyond, expected) in [(Beyond::Mirror, -pitch), (Beyond::Stretch, 0.0)] {
                let found = edge.direction(&world, direction, beyond).unwrap();
                let there = Direction::from_longitude_latitude(Angle::from_degrees(yaw), Angle::from_degrees(expected));
                let off = found.angle_to(there).degrees();
                assert!(off < 1e-3, "{beyond:?} of {yaw}, {pitch}: off by {off}°");
            }
        }
    }

    /// Checks the nadir, too, where the nearest point of the horizon is now on one side, now on the other.
    #[test]
    fn footprints_touch_the_sphere() {
        let world = dome(90.0, 180.0);
        let edge = Continuation::of(&world).unwrap();
        let target = CameraModel::Equirect(EquirectCamera::default()).view(64, 32).unwrap();
        for (i, j) in (17..32).flat_map(|j| (0..64).map(move |i| (i, j))) {
            let pixel = target.screen_pixel(i, j).unwrap().footprint;
            for beyond in [Beyond::Mirror, Beyond::Stretch] {
                let Footprint { direction, jacobian: DirectionJacobian { dx, dy } } =
                    edge.footprint(&world, &pixel, beyond).unwrap();
                for (side, of_pixel) in [(dx, pixel.jacobian.dx), (dy, pixel.jacobian.dy)] {
                    let (radial, most) = (side.dot(direction.vector()).abs(), 1.000_001 * WIDEST * of_pixel.length());
                    assert!(radial < 1e-12 && side.length() < most, "{beyond:?} at {i}, {j}: {side}");
                }
            }
        }
    }

    #[test]
    fn every_edge_is_found_and_a_whole_world_has_none() {
        let face = |face: CubeFace| {
            let view = CameraModel::CubeFace(CubeFaceCamera).view(16, 16).unwrap();
            (face.name().to_owned(), View { orientation: face.orientation(), ..view })
        };
        assert!(Continuation::of(&World::new(CubeFace::ALL.map(face)).unwrap()).is_none());
        let world = World::new([face(CubeFace::Front), face(CubeFace::Right)]).unwrap();
        let edge = Continuation::of(&world).unwrap();
        // 10° above the middle of the front face's upper edge, and as far left of it.
        let cases = [((0.0, 55.0), (0.0, 45.0), (0.0, 35.0)), ((-55.0, 0.0), (-45.0, 0.0), (-35.0, 0.0))];
        for (from, stretched, mirrored) in cases {
            let at = |(yaw, pitch): (f64, f64)| {
                Direction::from_longitude_latitude(Angle::from_degrees(yaw), Angle::from_degrees(pitch))
            };
            for (beyond, expected) in [(Beyond::Stretch, stretched), (Beyond::Mirror, mirrored)] {
                let found = edge.direction(&world, at(from), beyond).unwrap();
                assert!(found.angle_to(at(expected)).degrees() < 0.01, "{beyond:?} of {from:?}");
            }
        }
    }
}
