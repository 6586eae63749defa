use cosmorama::camera::PixelPoint;

use crate::camera::Camera;
use crate::ray::Ray;
use crate::scene::Scene;
use crate::shape::Sphere;

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tile {
    left: usize,
    top: usize,
    right: usize,
    bottom: usize,
}

/// Columns and rows of a tile.
pub(super) const SIDE: usize = 8;

impl Tile {
    /// Lists the tiles of a camera's picture side by side, from a row of pixels on.
    pub(super) fn row(camera: &Camera, top: usize) -> impl Iterator<Item = Self> {
        let (width, height) = (camera.width(), camera.height());
        let columns = (0..width).step_by(SIDE);
        columns.map(move |left| Self { left, top, right: (left + SIDE).min(width), bottom: (top + SIDE).min(height) })
    }

    /// Lists its pixels.
    pub(super) fn pixels(self) -> impl Iterator<Item = (usize, usize)> {
        (self.top..self.bottom).flat_map(move |j| (self.left..self.right).map(move |i| (i, j)))
    }

    /// Returns the tile with one more pixel on each side, within the picture.
    pub(super) fn grown(&self, camera: &Camera) -> Self {
        Self {
            left: self.left.saturating_sub(1),
            top: self.top.saturating_sub(1),
            right: (self.right + 1).min(camera.width()),
            bottom: (self.bottom + 1).min(camera.height()),
        }
    }

    /// Returns the number of its columns.
    pub(super) fn width(&self) -> usize {
        self.right - self.left
    }

    /// Returns the place of a pixel in [`Tile::pixels`]; `None` if it is not in the tile.
    pub(super) fn place(&self, i: usize, j: usize) -> Option<usize> {
        let is_inside = (self.left..self.right).contains(&i) && (self.top..self.bottom).contains(&j);
        is_inside.then(|| (j - self.top) * self.width() + i - self.left)
    }

    /// Lists the things that may be seen here, by their places in the scene.
    pub(super) fn things(&self, scene: &Scene, camera: &Camera) -> Vec<usize> {
        let [left, top, right, bottom] = [self.left, self.top, self.right, self.bottom].map(|edge| edge as f64);
        let corners = [(left, top), (right, top), (left, bottom), (right, bottom)];
        let at = |(x, y): (f64, f64)| camera.ray(PixelPoint::new(x, y));
        let all = 0..scene.objects.len();
        let Some(middle) = at((0.5 * (left + right), 0.5 * (top + bottom))) else { return all.collect() };
        let corners: Option<Vec<Ray>> = corners.into_iter().map(at).collect();
        let Some(corners) = corners else { return all.collect() };
        all.filter(|k| may_meet(scene.objects[*k].shape.ball(), &middle, &corners)).collect()
    }
}

/// Returns whether a ball may reach into the beam about a ray that these corners bound.
fn may_meet(sphere: &Sphere, middle: &Ray, corners: &[Ray]) -> bool {
    /// Room for tiles whose sides are not straight.
    const ROOM: f64 = 1.5;
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
        let scene = Scene::spheres(5, &Material::MIRROR).unwrap();
        for camera in cameras() {
            let tiles = (0..camera.height()).step_by(SIDE).flat_map(|top| Tile::row(&camera, top));
            let (passed, shown): (Vec<_>, Vec<_>) = tiles.partition(|tile| tile.things(&scene, &camera).is_empty());
            assert!(!passed.is_empty() && !shown.is_empty());
            for (i, j) in passed.iter().flat_map(|tile| tile.pixels()) {
                for (x, y) in (0..25).map(|k| (f64::from(k % 5) / 4.0, f64::from(k / 5) / 4.0)) {
                    let Some(ray) = camera.ray(PixelPoint::new(i as f64 + x, j as f64 + y)) else { continue };
                    let met = scene.objects.iter().any(|object| object.shape.meet(&ray).is_some());
                    assert!(!met, "pixel {i}, {j}");
                }
            }
        }
    }
}
