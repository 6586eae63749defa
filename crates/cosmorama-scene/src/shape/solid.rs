use super::Chart;
use crate::ray::{Normal, Ray};

/// A closed shape, as rays that glass bends see it.
pub(crate) trait Solid {
    /// Returns where a ray from inside meets the surface again.
    fn next(&self, ray: &Ray) -> Option<Wall>;

    /// Returns where a ray that has left the surface enters it again; `None` if the shape has no hollows.
    fn again(&self, _ray: &Ray) -> Option<Wall> {
        None
    }
}

/// The surface of a shape as a ray meets it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wall {
    /// The ray, with its changes, on the surface.
    pub(crate) met: Ray,
    /// Unit normal: a ball's points outward, a mesh's to the side that the ray comes from.
    pub(crate) normal: Normal,
    /// Length of the way to it, in units of the scene.
    pub(crate) distance: f64,
    /// Index of the part of the object.
    pub(crate) part: usize,
    /// Its place on the surface's pictures, if the surface has such coordinates.
    pub(crate) chart: Option<Chart>,
}
