use std::f64::consts::FRAC_PI_4;

use cosmorama::camera::{PixelPoint, View};
use glam::DVec3;

use crate::camera::Place;
use crate::error::SceneError;
use crate::material::Material;
use crate::shape::Sphere;

/// Things under a world. They see the world, and not one another: that is environment mapping.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// Its things.
    pub objects: Vec<Object>,
}

/// A thing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Object {
    /// Its shape.
    pub sphere: Sphere,
    /// Its surface.
    pub material: Material,
}

/// Distance between the centres of spheres of radius 1 that stand in a row.
const PITCH: f64 = 2.4;

impl Scene {
    /// Most spheres in a row.
    pub const MOST_SPHERES: usize = 1000;

    /// Returns one sphere of radius 1 at the origin.
    pub fn sphere(material: Material) -> Self {
        Self::row(&[material])
    }

    /// Returns the three spheres of Greene's Plate 4: matt, mixed, and a mirror.
    pub fn plate4() -> Self {
        Self::row(&[Material::MATTE, Material::MIXED, Material::MIRROR])
    }

    /// Returns a row of spheres from rough (α = 1) on the left to smooth (α = 0) on the right, otherwise of one
    /// material.
    ///
    /// # Errors
    /// When there are none, or more than [`Scene::MOST_SPHERES`].
    pub fn spheres(count: usize, material: Material) -> Result<Self, SceneError> {
        if !(1..=Self::MOST_SPHERES).contains(&count) {
            return Err(SceneError::Count { count, most: Self::MOST_SPHERES });
        }
        // Evenly spaced in the root of α, which is what eyes take for roughness.
        let roughness = |k: usize| 1.0 - k as f64 / (count - 1).max(1) as f64;
        let materials: Vec<Material> =
            (0..count).map(|k| Material { alpha: roughness(k).powi(2), ..material }).collect();
        Ok(Self::row(&materials))
    }

    /// Returns spheres of radius 1 side by side along the x axis, about the origin.
    pub fn row(materials: &[Material]) -> Self {
        let first = -0.5 * PITCH * materials.len().saturating_sub(1) as f64;
        let object = |(k, material): (usize, &Material)| Object {
            sphere: Sphere::new(DVec3::X * (first + PITCH * k as f64), 1.0),
            material: *material,
        };
        Self { objects: materials.iter().enumerate().map(object).collect() }
    }

    /// Checks that all materials are in range.
    pub(crate) fn check(&self) -> Result<(), SceneError> {
        Ok(self.objects.iter().try_for_each(|object| object.material.check())?)
    }

    /// Returns the radius of a ball around the origin that holds everything.
    pub fn radius(&self) -> f64 {
        let reach = |object: &Object| object.sphere.centre.length() + object.sphere.radius;
        self.objects.iter().map(reach).fold(0.0, f64::max)
    }

    /// Returns the place on the z axis from which a view that looks ahead sees everything.
    pub fn place_before(&self, view: &View) -> Place {
        /// Air around the things.
        const MARGIN: f64 = 1.05;
        let (width, height) = (view.width() as f64, view.height() as f64);
        let at = |x: f64, y: f64| view.direction(PixelPoint::new(x * width, y * height));
        // Half of the field of view, across and down; of wide ones, an eighth of a turn.
        let half = |x: f64, y: f64| {
            let angle = at(0.5, 0.5).zip(at(x, y)).map(|(a, b)| a.angle_to(b).radians());
            angle.unwrap_or(FRAC_PI_4).min(FRAC_PI_4)
        };
        let (across, down) = (half(0.0, 0.5), half(0.5, 0.0));
        // A ball that touches a side of the field of view from within.
        let away = |aside: f64, radius: f64, half: f64| (aside.abs() * half.cos() + radius) / half.sin();
        let distance = |Object { sphere: Sphere { centre, radius }, .. }: &Object| {
            away(centre.x, *radius, across).max(away(centre.y, *radius, down)) + centre.z
        };
        let distance = self.objects.iter().map(distance).fold(0.0, f64::max);
        Place { eye: DVec3::Z * (MARGIN * distance), target: DVec3::ZERO }
    }

    /// Returns the place on the z axis, and the height of the picture, by which a camera of parallel rays sees
    /// everything.
    pub fn place_before_parallel(&self, pixels: [usize; 2]) -> (Place, f64) {
        /// Air around the things, and the distance of the eye, in radii.
        const MARGIN: f64 = 1.1;
        const AWAY: f64 = 4.0;
        let aspect = pixels[0] as f64 / pixels[1].max(1) as f64;
        let half = |Object { sphere: Sphere { centre, radius }, .. }: &Object| {
            (centre.y.abs() + radius).max((centre.x.abs() + radius) / aspect)
        };
        let half = self.objects.iter().map(half).fold(0.0, f64::max);
        let place = Place { eye: DVec3::Z * (AWAY * self.radius()), target: DVec3::ZERO };
        (place, 2.0 * MARGIN * half)
    }
}
