use std::collections::BTreeSet;

use glam::DVec3;

use super::map::{Map, Place};
use super::rim::Rims;
use super::tree::Tree;
use crate::ray::{Normal, Ray};
use crate::shape::{Chart, Hit, Sphere, Wall};

/// Triangles of a mesh, where they were made.
#[derive(Debug)]
pub(super) struct Body {
    pub(super) tree: Tree,
    pub(super) skins: Vec<Skin>,
    /// Texture coordinates and tangents of the corners of each triangle; none, if no triangle has any.
    pub(super) maps: Vec<Option<Map>>,
    pub(super) rims: Rims,
    /// Number of triangles without area, which were left out.
    pub(super) skipped: usize,
    /// Number of triangles that were turned.
    pub(super) turned: usize,
    /// Its volume; negative if the corners of triangles are clockwise from outside.
    pub(super) volume: f64,
}

/// Surface of a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Skin {
    /// Unit normals at the corners.
    pub(super) normals: [DVec3; 3],
    /// Index of the part of the object.
    pub(super) part: u32,
    /// Number of the piece of the surface that it belongs to: all triangles that hang together.
    pub(super) piece: u32,
}

/// Part of the ball around a mesh by which a ray leaves the place where it starts.
const AWAY: f64 = 1e-9;

impl Body {
    pub(super) fn count(&self) -> usize {
        self.skins.len()
    }

    pub(super) fn last_part(&self) -> usize {
        self.skins.iter().map(|skin| skin.part as usize).max().unwrap_or_default()
    }

    pub(super) fn has_maps(&self) -> bool {
        !self.maps.is_empty()
    }

    pub(super) fn bare_parts(&self) -> BTreeSet<usize> {
        let is_bare = |face: &usize| self.maps.get(*face).is_none_or(Option::is_none);
        (0..self.count()).filter(is_bare).map(|face| self.skins[face].part as usize).collect()
    }

    pub(super) fn ball(&self) -> &Sphere {
        self.tree.ball()
    }

    /// Returns the normal of a triangle's plane, by the order of its corners, and one of them. Its length is twice the area.
    pub(super) fn plane(&self, face: usize) -> (DVec3, DVec3) {
        let [a, b, c] = *self.tree.corners(face);
        ((b - a).cross(c - a), a)
    }

    pub(super) fn meet(&self, ray: &Ray, beyond: f64) -> Option<Hit> {
        self.tree.meet(ray, beyond, |_| true)
    }

    pub(super) fn is_met(&self, ray: &Ray, beyond: f64) -> bool {
        self.tree.is_met(ray, beyond)
    }

    pub(super) fn piece(&self, face: usize) -> u32 {
        self.skins[face].piece
    }

    fn away(&self) -> f64 {
        AWAY * self.ball().radius
    }

    /// Returns the normal where a ray meets a triangle, of the side that the ray comes from.
    pub(super) fn normal(&self, ray: &Ray, hit: &Hit) -> DVec3 {
        let (plane, _) = self.plane(hit.face);
        let ([a, b, c], [v, w]) = (self.skins[hit.face].normals, hit.weights);
        let sum = a + ((b - a) * v + (c - a) * w);
        let unit = sum / sum.length();
        let is_behind = unit.dot(plane) * plane.dot(ray.direction) > 0.0;
        let still = Normal { unit: if is_behind { -unit } else { unit }, dx: DVec3::ZERO, dy: DVec3::ZERO };
        still.leaning_back(ray).unit
    }

    /// Returns the surface where a ray meets a triangle.
    ///
    /// The normal is interpolated, and turns over the pixel as its corners' weights change (Igehy 1999, section 3.2). It is
    /// that of the side which the ray comes from, and faces the ray.
    pub(super) fn wall(&self, ray: &Ray, hit: &Hit) -> Wall {
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
    pub(super) fn passage(&self, ray: &Ray, is_out: bool) -> Option<Wall> {
        let is_passed = |face: usize| (self.plane(face).0.dot(ray.direction) * self.volume > 0.0) == is_out;
        self.tree.meet(ray, self.away(), is_passed).map(|hit| self.wall(ray, &hit))
    }
}
