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

#[cfg(test)]
mod tests {
    use cosmorama::camera::PixelPoint;
    use cosmorama::prelude::*;
    use glam::DVec3;

    use super::*;
    use crate::camera::{Orthographic, Place};
    use crate::material::Material;

    /// Cameras that see a row of balls from beside, from within reach, and all around.
    fn cameras() -> Vec<Camera> {
        let place = |eye: [f64; 3]| Place { eye: eye.into(), target: DVec3::new(0.3, 0.1, 0.0) };
        let lens = |model: CameraModel, eye, (width, height)| {
            Camera::lens(place(eye), Placement::new(model).view(width, height).unwrap()).unwrap()
        };
        let narrow = PerspectiveCamera::new(FieldOfView::Horizontal(Angle::from_degrees(50.0)));
        vec![
            lens(narrow.into(), [2.0, 1.0, 6.0], (100, 70)),
            lens(EquirectCamera::default().into(), [0.0, 0.2, 1.9], (200, 100)),
            Camera::Orthographic(Orthographic::new(place([3.0, 2.0, 9.0]), 4.0, [90, 60]).unwrap()),
        ]
    }

    #[test]
    fn tiles_that_are_passed_over_show_nothing() {
        let scene = Scene::spheres(5, Material::MIRROR).unwrap();
        for camera in cameras() {
            let (passed, shown): (Vec<_>, Vec<_>) = Tile::all(&camera).partition(|tile| !tile.shows(&scene, &camera));
            assert!(!passed.is_empty() && !shown.is_empty());
            for (i, j) in passed.iter().flat_map(|tile| tile.pixels()) {
                for (x, y) in (0..25).map(|k| (f64::from(k % 5) / 4.0, f64::from(k / 5) / 4.0)) {
                    let Some(ray) = camera.ray(PixelPoint::new(i as f64 + x, j as f64 + y)) else { continue };
                    let met = scene.objects.iter().any(|object| object.sphere.meet(&ray, 0.0).is_some());
                    assert!(!met, "pixel {i}, {j}");
                }
            }
        }
    }
}
