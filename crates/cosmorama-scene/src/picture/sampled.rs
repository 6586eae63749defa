//! Pixels of meshes: one ray each, and many where an edge crosses them.

use cosmorama::camera::PixelPoint;
use cosmorama::raster::Rgba;
use glam::DVec3;

use super::cell::{Cell, Pixel, Seen};
use super::tiles::Tile;
use crate::ray::Ray;
use crate::shape::{Hit, Meeting, Shape};

/// The nearest surface of a ray.
#[derive(Clone, Copy)]
pub(super) struct Sighting {
    pub(super) ray: Ray,
    /// The thing's place in the scene.
    pub(super) object: usize,
    pub(super) hit: Hit,
}

/// A sample of a pixel.
struct Sample {
    /// Place in the pixel, from 0 to 1.
    place: [f64; 2],
    sighting: Sighting,
    /// Normal of the surface.
    normal: DVec3,
}

/// A square of a pixel.
#[derive(Clone, Copy)]
struct Square {
    corner: [f64; 2],
    side: f64,
}

/// Rays of a pixel that an edge crosses: a power of four.
const SAMPLES: u32 = 64;

/// Cosine of the angle between normals up to which samples are of one smooth surface.
const SMOOTH: f64 = 0.98;

impl Pixel<'_> {
    /// Lists the light of some things in the pixels of a tile, premultiplied by the part that they cover.
    pub(super) fn tile(&self, tile: &Tile, things: &[usize]) -> Vec<([usize; 2], Rgba)> {
        if things.iter().all(|object| self.scene.objects[*object].shape.mesh().is_none()) {
            return tile.pixels().filter_map(|(i, j)| Some(([i, j], self.light(i, j, things)?))).collect();
        }
        let around = tile.grown(self.camera);
        let sighting = |(i, j)| self.sighting(PixelPoint::centre(i, j), things);
        let sightings: Vec<Option<Sighting>> = around.pixels().map(sighting).collect();
        let surface = |met: &Sighting| (met.object, self.scene.objects[met.object].shape.piece(&met.hit));
        let at = |i: usize, j: usize| around.place(i, j).map(|place| sightings[place].as_ref().map(surface));
        let is_broken = |i: usize, j: usize| {
            let own = at(i, j);
            let beside = [at(i.wrapping_sub(1), j), at(i + 1, j), at(i, j.wrapping_sub(1)), at(i, j + 1)];
            beside.iter().any(|other| other.is_some() && *other != own)
        };
        // Balls look the same wherever a mesh is in the picture, if not beside it.
        let is_of_balls = |i: usize, j: usize| {
            let is_mesh = |met: (usize, u32)| self.scene.objects[met.0].shape.mesh().is_some();
            let near = (0..9).map(|k| at((i + k % 3).wrapping_sub(1), (j + k / 3).wrapping_sub(1)).flatten());
            !self.marks.has(i, j) && !near.flatten().any(is_mesh)
        };
        let light = |(i, j): (usize, usize)| {
            if is_of_balls(i, j) {
                return Some(([i, j], self.light(i, j, things)?));
            }
            if self.marks.has(i, j) || is_broken(i, j) || self.is_outline(i, j, things) {
                return self.sampled([i, j], things).map(|light| ([i, j], light));
            }
            let met = around.place(i, j).and_then(|place| sightings[place])?;
            let light = self.smooth(Cell::pixel(i, j), Some(met), things);
            Some(([i, j], light * self.camera.coverage(i, j) as f32))
        };
        tile.pixels().filter_map(light).collect()
    }

    /// Returns the nearest surface at a place of the picture.
    pub(super) fn sighting(&self, place: PixelPoint, things: &[usize]) -> Option<Sighting> {
        self.met(self.camera.ray(place)?, things)
    }

    /// Returns the nearest surface that a ray meets.
    fn met(&self, ray: Ray, things: &[usize]) -> Option<Sighting> {
        let hits = things.iter().filter_map(|object| Some((*object, self.scene.objects[*object].shape.meet(&ray)?)));
        let nearest = hits.min_by(|a, b| a.1.distance.total_cmp(&b.1.distance));
        nearest.map(|(object, hit)| Sighting { ray, object, hit })
    }

    /// Returns whether the outline of a sphere crosses a pixel.
    fn is_outline(&self, i: usize, j: usize, things: &[usize]) -> bool {
        things.iter().any(|object| match &self.scene.objects[*object].shape {
            Shape::Mesh(_) => false,
            Shape::Sphere(sphere) => {
                let meeting = self.camera.ray(PixelPoint::centre(i, j)).map(|ray| sphere.meeting(&ray));
                matches!(meeting, Some(Meeting::Crossed(_) | Meeting::Wide))
            }
        })
    }

    /// Returns the light of a pixel of many rays; `None` if no thing is met.
    fn sampled(&self, pixel: [usize; 2], things: &[usize]) -> Option<Rgba> {
        let shown = self.camera.coverage(pixel[0], pixel[1]);
        let (mut samples, mut rays) = (Vec::with_capacity(SAMPLES as usize), 0);
        for place in (0..SAMPLES).map(place) {
            let at = PixelPoint::new(pixel[0] as f64 + place[0], pixel[1] as f64 + place[1]);
            let Some(ray) = self.camera.ray(at) else { continue };
            rays += 1;
            let Some(sighting) = self.met(ray, things) else { continue };
            let normal = self.scene.objects[sighting.object].shape.normal(&ray, &sighting.hit);
            samples.push(Sample { place, sighting, normal });
        }
        if samples.is_empty() || shown <= 0.0 {
            return None;
        }
        let sum = self.square(pixel, Square { corner: [0.0; 2], side: 1.0 }, samples.iter().collect());
        Some(sum * (shown / rays as f64) as f32)
    }

    /// Adds up the light of samples in a square of a pixel, as many times as there are.
    fn square(&self, pixel: [usize; 2], square: Square, mut samples: Vec<&Sample>) -> Rgba {
        let mut sum = Rgba::TRANSPARENT;
        while let Some(first) = samples.first() {
            let (object, normal) = (first.sighting.object, first.normal);
            let is_one = |sample: &&Sample| sample.sighting.object == object && sample.normal.dot(normal) >= SMOOTH;
            let (surface, others): (Vec<&Sample>, Vec<&Sample>) = samples.into_iter().partition(is_one);
            sum += self.piece(pixel, square, surface);
            samples = others;
        }
        sum
    }

    /// Adds up the light of samples of one surface: as one, or by quarters of the square.
    fn piece(&self, pixel: [usize; 2], square: Square, samples: Vec<&Sample>) -> Rgba {
        let count = samples.len() as f64;
        let mean = [0, 1].map(|axis| samples.iter().map(|sample| sample.place[axis]).sum::<f64>() / count);
        let away = |sample: &&&Sample| (sample.place[0] - mean[0]).hypot(sample.place[1] - mean[1]);
        let Some(middle) = samples.iter().min_by(|a, b| away(a).total_cmp(&away(b))) else { return Rgba::TRANSPARENT };
        let Sighting { ray, object, hit } = &middle.sighting;
        let part = count / f64::from(SAMPLES);
        let wall = self.scene.objects[*object].shape.wall(&ray.scaled(part.sqrt()), hit);
        let depth = (-0.5 * part.log2()) as usize;
        let seen = Seen { object: *object, wall: &wall, pixel, depth, may_split: samples.len() > 1 };
        if let Some(light) = self.lit(&seen) {
            return light * count as f32;
        }
        let mut sum = Rgba::TRANSPARENT;
        let side = 0.5 * square.side;
        let mut left = samples;
        for corner in [(0.0, 0.0), (side, 0.0), (0.0, side), (side, side)] {
            let corner = [square.corner[0] + corner.0, square.corner[1] + corner.1];
            let is_inside =
                |sample: &&Sample| (0..2).all(|axis| (corner[axis]..corner[axis] + side).contains(&sample.place[axis]));
            let (inside, others) = left.into_iter().partition(is_inside);
            sum += self.square(pixel, Square { corner, side }, inside);
            left = others;
        }
        sum
    }
}

/// Returns the place of a sample in its pixel: Hammersley's set, which has one sample in each strip of equal width, across,
/// down and in all squares between.
fn place(index: u32) -> [f64; 2] {
    let (count, half) = (f64::from(SAMPLES), 0.5 / f64::from(SAMPLES));
    let reversed = f64::from(index.reverse_bits()) / 2f64.powi(32);
    [(f64::from(index) + 0.5) / count, reversed + half]
}
