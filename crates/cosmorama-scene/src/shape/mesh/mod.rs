//! Triangle meshes.

mod body;
mod build;
mod map;
mod normals;
mod rim;
mod tangents;
mod tree;
mod winding;

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::DVec3;

use self::body::Body;
use super::placing::{Placed, Placing};
use super::{Chart, Hit, Solid, Sphere, Wall};
use crate::ray::Ray;

pub use build::{Face, MeshError, Normals};
pub(crate) use rim::Rim;

/// A surface of triangles with smooth normals. Copies share the triangles and the tree of boxes around them, wherever they are
/// placed.
#[derive(Clone, Debug)]
pub struct Mesh {
    body: Arc<Body>,
    /// Place, if it is not where it was made.
    place: Option<Placed>,
    ball: Sphere,
}

impl Mesh {
    /// Most triangles of a mesh.
    pub const MOST: usize = 1 << 28;

    /// Returns the mesh of some triangles. Those without area are left out, and counted.
    ///
    /// # Errors
    /// When nothing is left, a corner is not finite, or there are more than [`Mesh::MOST`].
    pub fn new(faces: Vec<Face>, normals: Normals) -> Result<Self, MeshError> {
        Ok(Self::of(Body::new(faces, normals, false)?))
    }

    /// Returns the mesh of some triangles, as [`Mesh::new`] does. In closed pieces, triangles that are wound the wrong way are turned,
    /// and counted: pieces face outward, those directly inside others inward, as hollows, and so on.
    ///
    /// # Errors
    /// As [`Mesh::new`].
    pub fn mended(faces: Vec<Face>, normals: Normals) -> Result<Self, MeshError> {
        Ok(Self::of(Body::new(faces, normals, true)?))
    }

    fn of(body: Body) -> Self {
        Self { ball: *body.ball(), body: Arc::new(body), place: None }
    }

    /// Returns the mesh at a place, from where it was made, whatever place it has.
    #[must_use]
    pub fn placed(&self, placing: &Placing) -> Self {
        let (place, own) = (Placed::new(placing), self.body.ball());
        let ball = Sphere { centre: place.point(own.centre), radius: own.radius * place.scale(), ..*own };
        Self { body: Arc::clone(&self.body), place: Some(place), ball }
    }

    /// Returns whether another mesh is of the very same triangles, in the same memory.
    pub fn shares_triangles(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.body, &other.body)
    }

    /// Returns the number of triangles.
    pub fn count(&self) -> usize {
        self.body.count()
    }

    /// Returns the number of triangles without area, which were left out.
    pub fn skipped(&self) -> usize {
        self.body.skipped
    }

    /// Returns the number of triangles that were turned, since they were wound the wrong way.
    pub fn turned(&self) -> usize {
        self.body.turned
    }

    /// Returns the greatest number of a part that a triangle names.
    pub(crate) fn last_part(&self) -> usize {
        self.body.last_part()
    }

    /// Returns whether a triangle has texture coordinates.
    pub(crate) fn has_maps(&self) -> bool {
        self.body.has_maps()
    }

    /// Returns the parts of which a triangle has no texture coordinates.
    pub(crate) fn bare_parts(&self) -> BTreeSet<usize> {
        self.body.bare_parts()
    }

    /// Returns a ball around all of it.
    pub fn ball(&self) -> &Sphere {
        &self.ball
    }

    /// Returns an edge at which the surface ends or turns inside out, if there is one: the mesh then bounds no solid.
    pub fn hole(&self) -> Option<[DVec3; 2]> {
        self.body.rims.hole().map(|ends| ends.map(|end| self.point(end)))
    }

    /// Returns the number of edges.
    pub(crate) fn rim_count(&self) -> usize {
        self.body.rims.count()
    }

    /// Returns an edge, by its number.
    pub(crate) fn rim(&self, index: usize) -> Rim {
        let rim = self.body.rims.get(index);
        Rim { ends: rim.ends.map(|end| self.point(end)), ..rim }
    }

    /// Returns the normal of a triangle's plane, by the order of its corners, and one of them. Its length is of no meaning.
    pub(crate) fn plane(&self, face: usize) -> (DVec3, DVec3) {
        let (normal, corner) = self.body.plane(face);
        (self.place.map_or(normal, |place| place.vector(normal)), self.point(corner))
    }

    /// Returns the first triangle that a ray meets beyond a distance.
    pub(crate) fn meet(&self, ray: &Ray, beyond: f64) -> Option<Hit> {
        let Some(place) = &self.place else { return self.body.meet(ray, beyond) };
        let hit = self.body.meet(&place.own(ray), beyond / place.scale())?;
        Some(Hit { distance: hit.distance * place.scale(), ..hit })
    }

    /// Returns whether a ray meets any triangle beyond a distance.
    pub(crate) fn is_met(&self, ray: &Ray, beyond: f64) -> bool {
        match &self.place {
            Some(place) => self.body.is_met(&place.own(ray), beyond / place.scale()),
            None => self.body.is_met(ray, beyond),
        }
    }

    /// Returns the number of the piece of the surface that a triangle belongs to.
    pub(crate) fn piece(&self, face: usize) -> u32 {
        self.body.piece(face)
    }

    /// Returns the normal where a ray meets a triangle, of the side that the ray comes from.
    pub(crate) fn normal(&self, ray: &Ray, hit: &Hit) -> DVec3 {
        match &self.place {
            Some(place) => place.vector(self.body.normal(&place.own(ray), hit)),
            None => self.body.normal(ray, hit),
        }
    }

    /// Returns the surface where a ray meets a triangle.
    pub(crate) fn wall(&self, ray: &Ray, hit: &Hit) -> Wall {
        let Some(place) = &self.place else { return self.body.wall(ray, hit) };
        let own = Hit { distance: hit.distance / place.scale(), ..*hit };
        placed(place, self.body.wall(&place.own(ray), &own))
    }

    fn point(&self, own: DVec3) -> DVec3 {
        self.place.map_or(own, |place| place.point(own))
    }

    fn passage(&self, ray: &Ray, is_out: bool) -> Option<Wall> {
        match &self.place {
            Some(place) => self.body.passage(&place.own(ray), is_out).map(|wall| placed(place, wall)),
            None => self.body.passage(ray, is_out),
        }
    }
}

/// Returns the surface of a thing's own frame in the scene.
fn placed(place: &Placed, own: Wall) -> Wall {
    let chart = own.chart.map(|chart| Chart {
        tangent: place.vector(chart.tangent),
        bitangent: place.vector(chart.bitangent),
        ..chart
    });
    Wall {
        met: place.ray(&own.met),
        normal: place.normal(&own.normal),
        distance: own.distance * place.scale(),
        chart,
        ..own
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
