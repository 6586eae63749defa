use cosmorama::camera::PixelPoint;

use crate::camera::{Camera, Ray};
use crate::scene::{Object, Scene};

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tile {
    left: usize,
    top: usize,
    right: usize,
    bottom: usize,
}

/// Columns and rows of a tile.
const SIDE: usize = 8;

impl Tile {
    /// Lists the tiles of a camera's picture.
    pub(super) fn all(camera: &Camera) -> impl Iterator<Item = Self> {
        let (width, height) = (camera.width(), camera.height());
        let rows = (0..height).step_by(SIDE);
        rows.flat_map(move |top| {
            let columns = (0..width).step_by(SIDE);
            columns.map(move |left| Self {
                left,
                top,
                right: (left + SIDE).min(width),
                bottom: (top + SIDE).min(height),
            })
        })
    }

    /// Lists its pixels.
    pub(super) fn pixels(self) -> impl Iterator<Item = (usize, usize)> {
        (self.top..self.bottom).flat_map(move |j| (self.left..self.right).map(move |i| (i, j)))
    }

    /// Returns whether a thing may be seen here.
    pub(super) fn shows(&self, scene: &Scene, camera: &Camera) -> bool {
        let [left, top, right, bottom] = [self.left, self.top, self.right, self.bottom].map(|edge| edge as f64);
        let corners = [(left, top), (right, top), (left, bottom), (right, bottom)];
        let at = |(x, y): (f64, f64)| camera.ray(PixelPoint::new(x, y));
        let Some(middle) = at((0.5 * (left + right), 0.5 * (top + bottom))) else { return true };
        let corners: Option<Vec<Ray>> = corners.into_iter().map(at).collect();
        let Some(corners) = corners else { return true };
        scene.objects.iter().any(|object| may_meet(object, &middle, &corners))
    }
}

/// Returns whether a ball may reach into the beam about a ray that these corners bound.
fn may_meet(object: &Object, middle: &Ray, corners: &[Ray]) -> bool {
    /// Room for tiles whose sides are not straight.
    const ROOM: f64 = 1.5;
    let sphere = &object.sphere;
    let distance = (sphere.centre - middle.origin).length();
    if distance <= sphere.radius {
        return true;
    }
    let spread = corners.iter().map(|corner| corner.at(distance).distance(middle.at(distance))).fold(0.0, f64::max);
    // Seen from near by, a ball reaches √2 radii from its centre at the distance of that.
    sphere.centre.distance(middle.at(distance)) <= ROOM * (sphere.radius + spread)
}
