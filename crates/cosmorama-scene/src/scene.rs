use std::collections::HashMap;
use std::f64::consts::FRAC_PI_4;

use cosmorama::camera::{PixelPoint, View};
use glam::DVec3;

use crate::camera::Place;
use crate::error::SceneError;
use crate::material::Material;
use crate::shape::{Shape, Sphere};

/// Things under a world. They see the world, and not one another: that is environment mapping.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Its things.
    pub objects: Vec<Object>,
}

/// A thing.
#[derive(Clone, Debug)]
pub struct Object {
    /// Its shape.
    pub shape: Shape,
    /// Parts of its surface. A sphere has one; the triangles of a mesh name theirs by index.
    pub parts: Vec<Part>,
}

/// A part of a thing's surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Its name, by which it may be given a world of its own.
    pub name: String,
    /// Its material.
    pub material: Material,
    /// Number of the world that it stands under.
    pub world: usize,
}

impl Object {
    /// Returns a sphere of one material.
    pub fn sphere(sphere: Sphere, material: Material) -> Self {
        Self { shape: Shape::Sphere(sphere), parts: vec![Part { name: "sphere".to_owned(), material, world: 0 }] }
    }
}

impl Object {
    /// Returns the name of a thing that has none: what it is, and its number from 1.
    pub(crate) fn numbered(what: &str, index: usize) -> String {
        format!("{what}{}", index + 1)
    }

    /// Checks that glass bounds a solid.
    pub(crate) fn check_glass(&self) -> Result<(), SceneError> {
        let is_glass = self.parts.iter().any(|part| part.material.glass.is_some());
        let mesh = self.shape.mesh().filter(|_| is_glass);
        let hole = mesh.and_then(|mesh| mesh.hole());
        hole.map_or(Ok(()), |edge| Err(SceneError::Open(edge.map(|end| end.to_array()))))
    }

    /// Returns the thing with one name for all parts.
    pub(crate) fn named(mut self, name: String) -> Self {
        self.parts.iter_mut().for_each(|part| part.name.clone_from(&name));
        self
    }
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
    pub fn spheres(count: usize, material: &Material) -> Result<Self, SceneError> {
        if !(1..=Self::MOST_SPHERES).contains(&count) {
            return Err(SceneError::Count { count, most: Self::MOST_SPHERES });
        }
        // Evenly spaced in the root of α, which is what eyes take for roughness.
        let roughness = |k: usize| 1.0 - k as f64 / (count - 1).max(1) as f64;
        let materials: Vec<Material> = (0..count).map(|k| material.with_alpha(roughness(k).powi(2))).collect();
        Ok(Self::row(&materials))
    }

    /// Returns spheres of radius 1 side by side along the x axis, about the origin.
    pub fn row(materials: &[Material]) -> Self {
        let first = -0.5 * PITCH * materials.len().saturating_sub(1) as f64;
        let object = |(k, material): (usize, &Material)| {
            let sphere = Sphere::new(DVec3::X * (first + PITCH * k as f64), 1.0);
            Object::sphere(sphere, material.clone()).named(Object::numbered("sphere", k))
        };
        Self { objects: materials.iter().enumerate().map(object).collect() }
    }

    /// Lists the materials of what stands under a world.
    pub(crate) fn materials_under(&self, world: usize) -> impl Iterator<Item = &Material> + Clone {
        self.parts().filter(move |part| part.world == world).map(|part| &part.material)
    }

    /// Returns the memory of the tables that chrome has, in bytes. A table that several parts share counts once.
    pub fn chrome_bytes(&self) -> usize {
        let tables: HashMap<_, _> =
            self.parts().filter_map(|part| Some(part.material.chrome.as_ref()?.table())).collect();
        tables.values().sum()
    }

    /// Checks that all balls and materials are in range.
    pub(crate) fn check(&self) -> Result<(), SceneError> {
        for object in &self.objects {
            object.parts.iter().try_for_each(|part| part.material.check())?;
            let (part, count) = (object.shape.last_part(), object.parts.len());
            if part >= count {
                return Err(SceneError::NoPart { part, count });
            }
            if let Shape::Sphere(ball) = &object.shape
                && !(ball.centre.is_finite() && ball.radius.is_finite() && ball.radius > 0.0)
            {
                return Err(SceneError::Ball { centre: ball.centre.to_array(), radius: ball.radius });
            }
            object.check_glass()?;
        }
        Ok(())
    }

    /// Lists the parts of all things.
    pub fn parts(&self) -> impl Iterator<Item = &Part> + Clone {
        self.objects.iter().flat_map(|object| &object.parts)
    }

    /// Lists the parts of all things, to be changed.
    pub fn parts_mut(&mut self) -> impl Iterator<Item = &mut Part> {
        self.objects.iter_mut().flat_map(|object| &mut object.parts)
    }

    /// Lists balls that hold everything.
    fn balls(&self) -> impl Iterator<Item = &Sphere> {
        self.objects.iter().map(|object| object.shape.ball())
    }

    /// Returns the middle of the box around everything.
    fn middle(&self) -> DVec3 {
        let low = self.balls().map(|ball| ball.centre - ball.radius).reduce(DVec3::min);
        let high = self.balls().map(|ball| ball.centre + ball.radius).reduce(DVec3::max);
        low.zip(high).map_or(DVec3::ZERO, |(low, high)| 0.5 * (low + high))
    }

    /// Returns the place before the middle of everything from which a view that looks along −Z sees it all.
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
        let middle = self.middle();
        let distance = |Sphere { centre, radius, .. }: &Sphere| {
            let offset = *centre - middle;
            away(offset.x, *radius, across).max(away(offset.y, *radius, down)) + offset.z
        };
        let distance = self.balls().map(distance).fold(0.0, f64::max);
        Place { eye: middle + DVec3::Z * (MARGIN * distance), target: middle }
    }

    /// Returns the place before the middle, and the height of the picture, by which a camera of parallel rays sees
    /// everything.
    pub fn place_before_parallel(&self, pixels: [usize; 2]) -> (Place, f64) {
        /// Air around the things, and the distance of the eye, in radii.
        const MARGIN: f64 = 1.1;
        const AWAY: f64 = 4.0;
        let aspect = pixels[0] as f64 / pixels[1].max(1) as f64;
        let middle = self.middle();
        let half = |Sphere { centre, radius, .. }: &Sphere| {
            let offset = *centre - middle;
            (offset.y.abs() + radius).max((offset.x.abs() + radius) / aspect)
        };
        let half = self.balls().map(half).fold(0.0, f64::max);
        let away = self.balls().map(|ball| ball.centre.distance(middle) + ball.radius).fold(0.0, f64::max);
        let place = Place { eye: middle + DVec3::Z * (AWAY * away), target: middle };
        (place, 2.0 * MARGIN * half)
    }
}
