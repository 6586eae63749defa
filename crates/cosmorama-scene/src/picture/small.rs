//! Reflections in balls of few pixels. Each pixel of those sees so much of the world, and at the outline so little of a
//! pixel sees so much, that the world is parted, and not the pixel: each part is thrown to where the ball shows it.

use std::collections::HashMap;

use cosmorama::camera::{Footprint, PixelPoint};
use cosmorama::raster::Rgba;
use cosmorama::sphere::{CubeFace, Direction};
use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::QUARTERS;
use crate::camera::Camera;
use crate::ray::Ray;
use crate::scene::Object;
use crate::shade::{Detail, Gloss, Surroundings};
use crate::shape::{Shape, Sphere, Wall};

/// Greatest radius, in pixels, of a ball that is treated so.
const SMALL: f64 = 8.0;

/// Parts of a cube's face along its sides at first, for a ball of a few pixels; for larger ones there are more.
const PARTS: f64 = 16.0;
const FEW: f64 = 4.0;

/// Part of the world's mean light that a pixel may have too much or too little for each part of the world.
const UNEVEN: f64 = 1e-5;

/// Halvings of a part of the world at most.
const MOST: usize = 8;

/// Light that a small ball reflects, by pixel.
#[derive(Clone, Debug, Default)]
pub(super) struct Reflection {
    /// Light times area, and area, by column and row.
    sums: HashMap<[i64; 2], [f64; 4]>,
}

/// A part of a cube's face, as a part of the world.
#[derive(Clone, Copy, Debug)]
struct Patch {
    face: CubeFace,
    /// Place of its middle on the face, from −1 to 1.
    at: DVec2,
    side: f64,
    depth: usize,
}

/// Maker of a ball's reflection.
struct Thrower<'a> {
    sphere: &'a Sphere,
    gloss: Gloss<'a>,
    camera: &'a Camera,
    surroundings: &'a Surroundings<'a>,
}

impl Reflection {
    /// Computes what a ball reflects; `None` for a large one, for one that is not seen or beside the picture, for glass and for
    /// chrome, and under a world that is near.
    pub(super) fn of(object: &Object, camera: &Camera, surroundings: &Surroundings) -> Option<Self> {
        let Shape::Sphere(sphere) = &object.shape else { return None };
        let material = &object.parts.first()?.material;
        if !surroundings.is_far() {
            return None;
        }
        let gloss = Gloss::of(material).filter(|gloss| !gloss.is_chrome() && material.glass.is_none())?;
        let radius = radius_in_pixels(sphere, camera).filter(|radius| *radius < SMALL)?;
        if !is_in_frame(camera.pixel(sphere.centre)?, camera) {
            return None;
        }
        let parts = (PARTS * (2.0 * radius / FEW).max(1.0)).ceil() as usize;
        let thrower = Thrower { sphere, gloss, camera, surroundings };
        // In order, so that sums are those of any number of threads.
        let strips: Vec<Self> = (0..6 * parts)
            .into_par_iter()
            .map(|strip| thrower.strip(CubeFace::ALL[strip / parts], strip % parts, parts))
            .collect();
        let mut whole = Self::default();
        for (pixel, sum) in strips.into_iter().flat_map(|strip| strip.sums) {
            whole.add(pixel, sum);
        }
        Some(whole)
    }

    /// Returns the mean light of what is reflected in a pixel, if anything is.
    pub(super) fn light(&self, [i, j]: [usize; 2]) -> Option<Rgba> {
        /// Area of a ball in a pixel below which its mean is not sure.
        const LEAST: f64 = 1e-4;
        let [red, green, blue, area] = *self.sums.get(&[i as i64, j as i64])?;
        let mean = |light: f64| (light / area) as f32;
        (area > LEAST).then(|| Rgba::opaque(mean(red), mean(green), mean(blue)))
    }

    fn add(&mut self, pixel: [i64; 2], sum: [f64; 4]) {
        let into = self.sums.entry(pixel).or_default();
        (0..4).for_each(|k| into[k] += sum[k]);
    }

    /// Adds light to the pixels under a rectangle.
    fn throw(&mut self, place: &Shown, light: Rgba) {
        let [columns, rows] = [0, 1].map(|axis| shares(place.centre[axis], place.size[axis]));
        for (i, across) in &columns {
            for (j, down) in &rows {
                let area = place.area * across * down;
                let [red, green, blue] = [0, 1, 2].map(|k| f64::from(light.0[k]) * area);
                self.add([*i, *j], [red, green, blue, area]);
            }
        }
    }
}

/// Lists the pixels along an axis that an interval meets, each with its share of it.
fn shares(centre: f64, size: f64) -> Vec<(i64, f64)> {
    let (from, to) = (centre - 0.5 * size, centre + 0.5 * size);
    let (first, last) = (from.floor() as i64, to.floor() as i64);
    if first == last || size <= 0.0 {
        return vec![(first, 1.0)];
    }
    let share = |pixel: i64| (to.min(pixel as f64 + 1.0) - from.max(pixel as f64)) / size;
    (first..=last).map(|pixel| (pixel, share(pixel))).collect()
}

/// Returns the radius in pixels of a ball's picture; `None` if its centre is not seen.
fn radius_in_pixels(sphere: &Sphere, camera: &Camera) -> Option<f64> {
    let ray = camera.ray(camera.pixel(sphere.centre)?)?;
    let distance = (sphere.centre - ray.origin).length();
    let [dx, dy] = ray.spread(distance);
    (distance > sphere.radius).then(|| sphere.radius / dx.length().min(dy.length()))
}

/// Returns whether a small ball at a place may reach into the picture.
fn is_in_frame(centre: PixelPoint, camera: &Camera) -> bool {
    /// Room for balls whose pictures are drawn out.
    const ROOM: f64 = 4.0 * SMALL;
    let near = |at: f64, size: usize| (-ROOM..=size as f64 + ROOM).contains(&at);
    near(centre.x, camera.width()) && near(centre.y, camera.height())
}

/// Rectangle of the picture where a part of the world is seen.
#[derive(Clone, Copy, Debug)]
struct Shown {
    centre: DVec2,
    size: DVec2,
    area: f64,
}

impl Thrower<'_> {
    /// Throws a row of parts of a cube's face.
    fn strip(&self, face: CubeFace, row: usize, parts: usize) -> Reflection {
        let mut reflection = Reflection::default();
        let side = 2.0 / parts as f64;
        let middle = |k: usize| (k as f64 + 0.5) * side - 1.0;
        for column in 0..parts {
            let patch = Patch { face, at: DVec2::new(middle(column), middle(row)), side, depth: 0 };
            self.patch(&mut reflection, patch, self.light(&patch.footprint()));
        }
        reflection
    }

    /// Throws a part whose first estimate may be too rough: its quarters, and theirs where they tell of more.
    fn patch(&self, into: &mut Reflection, patch: Patch, estimate: Rgba) {
        let Some(place) = self.place(&patch.footprint()) else { return };
        let quarters = patch.quarters();
        let lights = quarters.map(|quarter| self.light(&quarter.footprint()));
        let better = lights.into_iter().fold(Rgba::TRANSPARENT, |sum, light| sum + light * 0.25);
        let change = (0..3).map(|k| f64::from((better.0[k] - estimate.0[k]).abs())).fold(0.0, f64::max);
        let is_even = change * place.area <= UNEVEN * self.surroundings.mean || patch.depth == MOST;
        for (quarter, light) in quarters.into_iter().zip(lights) {
            if !is_even {
                self.patch(into, quarter, light);
            } else if let Some(place) = self.place(&quarter.footprint()) {
                into.throw(&place, light);
            }
        }
    }

    fn light(&self, footprint: &Footprint) -> Rgba {
        let normal = self.normal(footprint.direction.vector());
        let gloss = normal.map_or(self.gloss, |normal| self.gloss.about(normal));
        self.surroundings.reflection(gloss, footprint, Detail::Part)
    }

    /// Returns where the ball shows a part of the world; `None` if it does not.
    fn place(&self, seen: &Footprint) -> Option<Shown> {
        let sphere = self.sphere;
        let normal = self.normal(seen.direction.vector())?;
        let point = sphere.centre + normal * sphere.radius;
        let pixel = self.camera.pixel(point)?;
        let reflected = self.reflected(pixel)?.footprint();
        let sides = [seen.jacobian.dx, seen.jacobian.dy];
        let [x, y] = sides.map(|side| reflected.jacobian.pseudo_inverse(side));
        let (x, y) = (x?, y?);
        // The rectangle has the variances of the parallelogram.
        let size = DVec2::new(x.x.hypot(y.x), x.y.hypot(y.y));
        Some(Shown { centre: DVec2::new(pixel.x, pixel.y), size, area: x.perp_dot(y).abs() })
    }

    /// Returns the ray that the ball reflects at a point of the picture.
    fn reflected(&self, pixel: PixelPoint) -> Option<Ray> {
        let Wall { met, normal, .. } = self.sphere.wall(&self.camera.ray(pixel)?, 0.0)?;
        Some(met.reflected(&normal))
    }

    /// Returns the normal where the ball reflects a direction; `None` where that is behind the outline.
    ///
    /// The normal halves the angle between the direction and the way to the eye, which depends on the point: each step
    /// is nearer by the ratio of the ball's radius to the distance.
    fn normal(&self, seen: DVec3) -> Option<DVec3> {
        const STEPS: usize = 16;
        let sphere = self.sphere;
        let mut view = self.camera.towards(sphere.centre)?;
        for _ in 0..STEPS {
            let normal = (seen - view).try_normalize()?;
            let next = self.camera.towards(sphere.centre + normal * sphere.radius)?;
            let is_found = (next - view).length_squared() < 1e-20;
            view = next;
            if is_found {
                break;
            }
        }
        let normal = (seen - view).try_normalize()?;
        (normal.dot(view) < 0.0).then_some(normal)
    }
}

impl Patch {
    fn quarters(self) -> [Self; 4] {
        QUARTERS.map(|(x, y)| Self {
            at: self.at + DVec2::new(x, y) * self.side,
            side: 0.5 * self.side,
            depth: self.depth + 1,
            ..self
        })
    }

    /// Returns the part of the world.
    fn footprint(&self) -> Footprint {
        let orientation = self.face.orientation();
        let axis = |direction: Direction| orientation.to_world(direction).vector();
        let (right, up) = (axis(Direction::RIGHT), axis(Direction::UP));
        let vector = axis(Direction::FRONT) + right * self.at.x + up * self.at.y;
        let scale = self.side / vector.length();
        Footprint::new(Direction::from_unit(vector.normalize()), right * scale, up * scale)
    }
}
