use crate::camera::{Normal, Ray};

/// A closed shape, as a ray inside sees it.
pub(crate) trait Solid {
    /// Returns where a ray from inside meets the surface again.
    fn next(&self, ray: &Ray) -> Option<Wall>;
}

/// The surface of a shape as a ray meets it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wall {
    /// The ray, with its changes, on the surface.
    pub(crate) met: Ray,
    /// Outward normal.
    pub(crate) normal: Normal,
    /// Length of the way to it, in units of the scene.
    pub(crate) distance: f64,
}
