use crate::camera::{Normal, Ray};

/// A closed shape, as a ray inside sees it.
pub(crate) trait Solid {
    /// Returns where a ray from inside meets the surface again.
    fn next(&self, ray: &Ray) -> Option<Wall>;
}

/// The surface of a solid as a ray from inside meets it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wall {
    /// The ray, with its changes, on the surface.
    pub(crate) met: Ray,
    /// Outward normal.
    pub(crate) normal: Normal,
    /// Length of the way inside.
    pub(crate) distance: f64,
}
