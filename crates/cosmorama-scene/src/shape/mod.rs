//! Shapes that rays meet.

mod chart;
mod edge;
mod mesh;
mod placing;
mod solid;
mod sphere;

use std::sync::Arc;

use glam::DVec3;

use crate::ray::Ray;

pub(crate) use chart::Chart;
pub(crate) use edge::Edge;
pub(crate) use mesh::Rim;
pub use mesh::{Face, Mesh, MeshError, Normals};
pub use placing::Placing;
pub(crate) use solid::{Solid, Wall};
pub(crate) use sphere::Meeting;
pub use sphere::Sphere;

/// Form of a thing.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A ball.
    Sphere(Sphere),
    /// Triangles.
    Mesh(Arc<Mesh>),
}

/// A place where a ray meets a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hit {
    pub(crate) distance: f64,
    /// Number of the triangle.
    pub(crate) face: usize,
    /// Weights of the triangle's second and third corners.
    pub(crate) weights: [f64; 2],
}

impl Shape {
    /// Returns a ball around all of it.
    pub fn ball(&self) -> &Sphere {
        match self {
            Self::Sphere(sphere) => sphere,
            Self::Mesh(mesh) => mesh.ball(),
        }
    }

    /// Returns the greatest number of a part that its surface names.
    pub(crate) fn last_part(&self) -> usize {
        match self {
            Self::Sphere(_) => 0,
            Self::Mesh(mesh) => mesh.last_part(),
        }
    }

    /// Returns it if it is a mesh.
    pub(crate) fn mesh(&self) -> Option<&Mesh> {
        match self {
            Self::Sphere(_) => None,
            Self::Mesh(mesh) => Some(mesh),
        }
    }

    /// Returns the first place that a ray from outside meets.
    pub(crate) fn meet(&self, ray: &Ray) -> Option<Hit> {
        match self {
            Self::Sphere(sphere) => sphere.meet(ray, 0.0).map(|distance| Hit { distance, face: 0, weights: [0.0; 2] }),
            Self::Mesh(mesh) => mesh.meet(ray, 0.0),
        }
    }

    /// Returns whether a ray that leaves a place, perhaps on its own surface, meets it.
    pub(crate) fn is_met(&self, ray: &Ray) -> bool {
        /// Part of the radius within which a ray is still where it starts.
        const AWAY: f64 = 1e-6;
        let beyond = AWAY * self.ball().radius;
        match self {
            Self::Sphere(sphere) => sphere.meet(ray, beyond).is_some(),
            Self::Mesh(mesh) => mesh.is_met(ray, beyond),
        }
    }

    /// Returns the surface where a ray meets it.
    pub(crate) fn wall(&self, ray: &Ray, hit: &Hit) -> Wall {
        match self {
            Self::Sphere(sphere) => sphere.seen_at(ray, hit.distance),
            Self::Mesh(mesh) => mesh.wall(ray, hit),
        }
    }

    /// Returns the unit normal where a ray meets it: a ball's points outward, a mesh's to the side that the ray comes from.
    pub(crate) fn normal(&self, ray: &Ray, hit: &Hit) -> DVec3 {
        match self {
            Self::Sphere(sphere) => sphere.normal_at(ray.at(hit.distance)),
            Self::Mesh(mesh) => mesh.normal(ray, hit),
        }
    }

    /// Returns the number of the piece of the surface where it is met.
    pub(crate) fn piece(&self, hit: &Hit) -> u32 {
        match self {
            Self::Sphere(_) => 0,
            Self::Mesh(mesh) => mesh.piece(hit.face),
        }
    }

    /// Returns the shape as glass sees it.
    pub(crate) fn solid(&self) -> &dyn Solid {
        match self {
            Self::Sphere(sphere) => sphere,
            Self::Mesh(mesh) => mesh.as_ref(),
        }
    }
}
