use cosmorama::sphere::Orientation;
use glam::{DMat3, DVec3};

use crate::ray::{Normal, Ray, RayChange};

/// Place of a thing: it is scaled, turned, and then moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placing {
    /// Factor on its size.
    pub scale: f64,
    /// Orientation about its origin.
    pub turn: Orientation,
    /// Place of its origin.
    pub origin: DVec3,
}

impl Placing {
    /// Returns the place of a point.
    pub(crate) fn point(&self, point: DVec3) -> DVec3 {
        self.origin + self.turn.rotation() * (point * self.scale)
    }
}

/// A place, ready to bring rays to a thing's own frame and back.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placed {
    scale: f64,
    turn: DMat3,
    /// The turn back.
    back: DMat3,
    origin: DVec3,
}

impl Placed {
    pub(super) fn new(placing: &Placing) -> Self {
        let turn = DMat3::from_quat(placing.turn.rotation());
        Self { scale: placing.scale, turn, back: turn.transpose(), origin: placing.origin }
    }

    /// Returns the factor on lengths.
    pub(super) fn scale(&self) -> f64 {
        self.scale
    }

    /// Returns a ray in the thing's own frame, and in its units.
    pub(super) fn own(&self, ray: &Ray) -> Ray {
        let shrunk = Ray { origin: ray.origin - self.origin, ..*ray }.stretched(self.scale.recip());
        shrunk.turned(&self.back)
    }

    /// Returns a ray of the thing's own frame in the scene.
    pub(super) fn ray(&self, own: &Ray) -> Ray {
        let turned = own.stretched(self.scale).turned(&self.turn);
        Ray { origin: turned.origin + self.origin, ..turned }
    }

    /// Returns the place of a point.
    pub(super) fn point(&self, own: DVec3) -> DVec3 {
        self.origin + self.vector(own * self.scale)
    }

    /// Returns a vector of the thing's own frame in the scene, as long as it was.
    pub(super) fn vector(&self, own: DVec3) -> DVec3 {
        self.turn * own
    }

    /// Returns a normal of the thing's own frame in the scene.
    pub(super) fn normal(&self, own: &Normal) -> Normal {
        Normal { unit: self.vector(own.unit), dx: self.vector(own.dx), dy: self.vector(own.dy) }
    }
}

impl Ray {
    /// Returns the ray where all lengths are times a factor.
    fn stretched(self, by: f64) -> Self {
        let change = |change: RayChange| RayChange { origin: change.origin * by, ..change };
        Self { origin: self.origin * by, dx: change(self.dx), dy: change(self.dy), ..self }
    }
}
