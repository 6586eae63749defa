//! Triangle meshes.

mod build;
mod map;
mod normals;
mod rim;
mod tangents;
mod tree;

use std::collections::BTreeSet;

use glam::DVec3;

use self::map::{Map, Place};
use self::rim::Rims;
use self::tree::Tree;
use super::{Chart, Hit, Solid, Sphere, Wall};
use crate::ray::Ray;

pub use build::{Face, MeshError, Normals};
pub(crate) use rim::Rim;

/// A surface of triangles with smooth normals.
#[derive(Clone, Debug)]
pub struct Mesh {
    tree: Tree,
    skins: Vec<Skin>,
    /// Texture coordinates and tangents of the corners of each triangle; none, if no triangle has any.
    maps: Vec<Option<Map>>,
    rims: Rims,
    skipped: usize,
    /// Its volume; negative if the corners of triangles are clockwise from outside.
    volume: f64,
}

/// Surface of a triangle.
#[derive(Clone, Copy, Debug)]
struct Skin {
    /// Unit normals at the corners.
    normals: [DVec3; 3],
    /// Index of the part of the object.
    part: u32,
    /// Number of the piece of the surface that it belongs to: all triangles that hang together.
    piece: u32,
}

/// Part of the ball around a mesh by which a ray leaves the place where it starts.
const AWAY: f64 = 1e-9;

impl Mesh {
    /// Returns the number of triangles.
    pub fn count(&self) -> usize {
        self.skins.len()
    }

    /// Returns the number of triangles without area, which were left out.
    pub fn skipped(&self) -> usize {
        self.skipped
    }

    /// Returns the greatest number of a part that a triangle names.
    pub(crate) fn last_part(&self) -> usize {
        self.skins.iter().map(|skin| skin.part as usize).max().unwrap_or_default()
    }

    /// Returns whether a triangle has texture coordinates.
    pub(crate) fn has_maps(&self) -> bool {
        !self.maps.is_empty()
    }

    /// Returns the parts of which a triangle has no texture coordinates.
    pub(crate) fn bare_parts(&self) -> BTreeSet<usize> {
        let is_bare = |face: &usize| self.maps.get(*face).is_none_or(Option::is_none);
        (0..self.count()).filter(is_bare).map(|face| self.skins[face].part as usize).collect()
    }

    /// Returns a ball around all of it.
    pub fn ball(&self) -> &Sphere {
        self.tree.ball()
    }

    /// Returns an edge at which the surface ends or turns inside out, if there is one: the mesh then bounds no solid.
    pub fn hole(&self) -> Option<[DVec3; 2]> {
        self.rims.hole()
    }

    /// Returns the number of edges.
    pub(crate) fn rim_count(&self) -> usize {
        self.rims.count()
    }

    /// Returns an edge, by its number.
    pub(crate) fn rim(&self, index: usize) -> Rim {
        self.rims.get(index)
    }

    /// Returns the normal of a triangle's plane, by the order of its corners, and one of them. Its length is twice the area.
    pub(crate) fn plane(&self, face: usize) -> (DVec3, DVec3) {
        let [a, b, c] = *self.tree.corners(face);
        ((b - a).cross(c - a), a)
    }

    /// Returns the first triangle that a ray meets beyond a distance.
    pub(crate) fn meet(&self, ray: &Ray, beyond: f64) -> Option<Hit> {
        self.tree.meet(ray, beyond, |_| true)
    }

    /// Returns whether a ray meets any triangle beyond a distance.
    pub(crate) fn is_met(&self, ray: &Ray, beyond: f64) -> bool {
        self.tree.is_met(ray, beyond)
    }

    /// Returns the number of the piece of the surface that a triangle belongs to.
    pub(crate) fn piece(&self, face: usize) -> u32 {
        self.skins[face].piece
    }

    fn away(&self) -> f64 {
        AWAY * self.ball().radius
    }

    /// Returns the surface where a ray meets a triangle.
    ///
    /// The normal is interpolated, and turns over the pixel as its corners' weights change (Igehy 1999, section 3.2). It is
    /// that of the side which the ray comes from, and faces the ray.
    pub(crate) fn wall(&self, ray: &Ray, hit: &Hit) -> Wall {
        let [a, b, c] = *self.tree.corners(hit.face);
        let sides = [b - a, c - a];
        let plane = sides[0].cross(sides[1]);
        let outward = if plane.dot(ray.direction) > 0.0 { -plane } else { plane }.normalize();
        let met = ray.met(hit.distance, outward);
        let squared = plane.length_squared();
        let turn = |moved: DVec3| [moved.cross(sides[1]), sides[0].cross(moved)].map(|part| part.dot(plane) / squared);
        let place = Place {
            weights: hit.weights,
            turns: [met.dx.origin, met.dy.origin].map(turn),
            nearing: ray.nearing(outward),
        };
        let skin = &self.skins[hit.face];
        let normal = place.normal(&skin.normals);
        let chart = self.maps.get(hit.face).and_then(Option::as_ref).map(|map| map.chart(&place, normal.unit));
        let is_behind = normal.unit.dot(outward) < 0.0;
        let (normal, chart) = if is_behind { (normal.reversed(), chart.map(Chart::reversed)) } else { (normal, chart) };
        Wall { met, normal: normal.leaning_back(ray), distance: hit.distance, part: skin.part as usize, chart }
    }

    /// Returns the first surface that a ray meets on its way out of the mesh, or into it. Smooth normals may send a ray to the
    /// wrong side of its triangle; surfaces of the other side then do not count.
    fn passage(&self, ray: &Ray, is_out: bool) -> Option<Wall> {
        let is_passed = |face: usize| (self.plane(face).0.dot(ray.direction) * self.volume > 0.0) == is_out;
        self.tree.meet(ray, self.away(), is_passed).map(|hit| self.wall(ray, &hit))
    }
}

impl Solid for Mesh {
    fn next(&self, ray: &Ray) -> Option<Wall> {
        self.passage(ray, true)
    }

    fn again(&self, ray: &Ray) -> Option<Wall> {
        self.passage(ray, false)
    }
}
