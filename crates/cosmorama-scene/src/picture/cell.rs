use cosmorama::camera::PixelPoint;
use cosmorama::raster::Rgba;

use super::QUARTERS;
use super::marks::Marks;
use super::occlusion::openness;
use super::sampled::Sighting;
use super::small::Reflection;
use crate::camera::Camera;
use crate::ray::Ray;
use crate::scene::Scene;
use crate::shade::{Beam, Detail, Surroundings};
use crate::shape::{Meeting, Shape, Sphere, Wall};

/// Maker of single pixels.
#[derive(Clone, Copy)]
pub(super) struct Pixel<'a> {
    pub(super) scene: &'a Scene,
    pub(super) camera: &'a Camera,
    pub(super) worlds: &'a [Surroundings<'a>],
    /// Reflections of the things of few pixels, by their place in the scene.
    pub(super) reflections: &'a [Option<Reflection>],
    /// Pixels that edges of meshes cross.
    pub(super) marks: &'a Marks,
    /// Finest difference of places whose rays of occlusion differ.
    pub(super) grain: f64,
}

/// A square part of a pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    pub(super) centre: PixelPoint,
    /// Side, in pixels.
    pub(super) side: f64,
    /// Number of halvings.
    depth: usize,
    /// Column and row of the pixel.
    pub(super) pixel: [usize; 2],
}

/// Surface of a thing in a part of a pixel.
pub(super) struct Seen<'a> {
    /// The thing's place in the scene.
    pub(super) object: usize,
    pub(super) wall: &'a Wall,
    pub(super) pixel: [usize; 2],
    /// Number of halvings of the pixel to the part.
    pub(super) depth: usize,
    /// Whether the part may be parted further.
    pub(super) may_split: bool,
}

/// Part of a cell that a sphere covers.
struct Part<'a> {
    sphere: &'a Sphere,
    /// The sphere's place in the scene.
    object: usize,
    /// Distance at which it is met, or nearly so: nearer things hide others.
    distance: f64,
    coverage: f64,
    /// Offset of the middle of what is covered, in parts of the cell.
    middle: [f64; 2],
}

/// Longest change of what is seen over a cell, in radians, that is taken as straight.
const STRAIGHT: f64 = 0.3;

/// Change of what is seen over a cell, in radians, above which a pixel is parted once: smaller kernels side by side are
/// nearer to the pixel's own square than one.
const ROUGH: f64 = 0.02;
const AT_ONCE: usize = 1;

/// Change of what is seen over half a pixel, in radians, above which a pixel of a mesh that reflects one beam is parted twice. Parts of
/// glass are seen by many faint beams, which cost more than they would gain.
const MIRRORED: f64 = 0.04;
const TWICE: usize = 2;

/// Halvings of a pixel: at outlines at least, elsewhere at most.
const AT_OUTLINES: usize = 3;
const MOST: usize = 6;

/// Halvings of a pixel of a mesh at most: then it has as many rays as one that an edge crosses.
const MOST_OF_MESHES: usize = 3;

/// Coverage below which a part has no light of its own.
const LEAST: f64 = 1e-6;

/// Treatment of a cell.
enum Sight<'a> {
    Split,
    Parts(Vec<Part<'a>>),
}

impl Cell {
    /// Returns the whole of a pixel.
    pub(super) fn pixel(i: usize, j: usize) -> Self {
        Self { centre: PixelPoint::centre(i, j), side: 1.0, depth: 0, pixel: [i, j] }
    }

    fn quarters(self) -> [Self; 4] {
        QUARTERS.map(|(x, y)| Self {
            centre: PixelPoint::new(self.centre.x + x * self.side, self.centre.y + y * self.side),
            side: 0.5 * self.side,
            depth: self.depth + 1,
            ..self
        })
    }
}

impl<'a> Pixel<'a> {
    /// Returns the light of some spheres in a pixel, premultiplied by the part that they cover; `None` if there are none.
    pub(super) fn light(&self, i: usize, j: usize, things: &[usize]) -> Option<Rgba> {
        let light = self.cell(Cell::pixel(i, j), things);
        if light.alpha() <= 0.0 {
            return None;
        }
        let shown = self.camera.coverage(i, j);
        (shown > 0.0).then(|| light * shown as f32)
    }

    /// Returns the light of a cell, as a part of the cell.
    fn cell(&self, cell: Cell, things: &[usize]) -> Rgba {
        let quarters = || mean(cell, |quarter| self.cell(quarter, things));
        let Some(ray) = self.camera.ray(cell.centre) else {
            return if cell.depth < AT_OUTLINES { quarters() } else { Rgba::TRANSPARENT };
        };
        match self.sight(&ray.scaled(cell.side), cell, things) {
            Sight::Split => quarters(),
            Sight::Parts(parts) => self.parts(cell, parts).unwrap_or_else(quarters),
        }
    }

    /// Returns the light of a cell in which one surface is seen, of what a ray through its middle meets.
    pub(super) fn smooth(&self, cell: Cell, met: Option<Sighting>, things: &[usize]) -> Rgba {
        let Some(Sighting { ray, object, hit }) = met else { return Rgba::TRANSPARENT };
        let shape = &self.scene.objects[object].shape;
        let wall = shape.wall(&ray.scaled(cell.side), &hit);
        let may_split = cell.depth < if shape.mesh().is_some() { MOST_OF_MESHES } else { MOST };
        let seen = Seen { object, wall: &wall, pixel: cell.pixel, depth: cell.depth, may_split };
        let quarter = |quarter: Cell| self.smooth(quarter, self.sighting(quarter.centre, things), things);
        self.lit(&seen).unwrap_or_else(|| mean(cell, quarter))
    }

    /// Tells what a beam meets.
    fn sight(&self, beam: &Ray, cell: Cell, things: &[usize]) -> Sight<'a> {
        let mut parts = Vec::new();
        for object in things {
            let Shape::Sphere(sphere) = &self.scene.objects[*object].shape else { continue };
            let (coverage, middle) = match sphere.meeting(beam) {
                Meeting::Missed => continue,
                Meeting::Met => (1.0, [0.0; 2]),
                Meeting::Wide if cell.depth < MOST => return Sight::Split,
                Meeting::Wide if sphere.meet(beam, 0.0).is_some() => (1.0, [0.0; 2]),
                Meeting::Wide => continue,
                Meeting::Crossed(_) if cell.depth < AT_OUTLINES => return Sight::Split,
                Meeting::Crossed(edge) => (edge.coverage(), edge.middle()),
            };
            if coverage > LEAST {
                let closest = || (sphere.centre - beam.origin).dot(beam.direction);
                let distance = sphere.meet(beam, 0.0).unwrap_or_else(closest);
                parts.push(Part { sphere, object: *object, distance, coverage, middle });
            }
        }
        parts.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        Sight::Parts(parts)
    }

    /// Adds the light of a cell's parts, nearer ones before others; `None` if the cell must be split.
    fn parts(&self, cell: Cell, parts: Vec<Part>) -> Option<Rgba> {
        let mut sum = Rgba::TRANSPARENT;
        for part in parts {
            let light = self.part(cell, &part)? * part.coverage as f32;
            sum = sum.over(light);
            if sum.alpha() >= 1.0 {
                break;
            }
        }
        Some(sum)
    }

    /// Returns the light of a part as if it were all of the cell; `None` if the cell must be split.
    fn part(&self, cell: Cell, part: &Part) -> Option<Rgba> {
        let [x, y] = part.middle.map(|offset| offset * cell.side);
        let ray = self.camera.ray(PixelPoint::new(cell.centre.x + x, cell.centre.y + y));
        let Some(beam) = ray.map(|ray| ray.scaled(cell.side)) else { return Some(Rgba::TRANSPARENT) };
        let Some(wall) = part.sphere.seen(&beam) else { return Some(Rgba::TRANSPARENT) };
        let may_split = part.coverage == 1.0;
        self.lit(&Seen { object: part.object, wall: &wall, pixel: cell.pixel, depth: cell.depth, may_split })
    }

    /// Returns the light of a surface as if it were all of a part of a pixel; `None` if that must be split.
    pub(super) fn lit(&self, seen: &Seen) -> Option<Rgba> {
        let object = &self.scene.objects[seen.object];
        let part = &object.parts[seen.wall.part];
        let world = &self.worlds[part.world];
        let mut surface = world.surface(seen.wall, &part.material);
        if world.has_occlusion() && surface.is_matt() {
            surface = surface.shadowed(openness(self.scene, seen.wall, self.grain));
        }
        let whole = self.reflections[seen.object].as_ref().and_then(|reflection| reflection.light(seen.pixel));
        if let Some(reflected) = whole {
            return Some(world.shade(&surface, reflected));
        }
        let beams = Beam::of(&seen.wall.met, &surface.normal, &part.material, object.shape.solid());
        let widest = Beam::widest(&beams, surface.reflected());
        // A blurred world has no detail that smaller parts would show.
        let blur = surface.gloss.blur();
        let is_mirror = beams.len() == 1 && object.shape.mesh().is_some() && !surface.gloss.is_chrome();
        let twice = is_mirror && widest > MIRRORED.max(blur) && seen.depth < TWICE;
        let split =
            widest > STRAIGHT.max(blur) && seen.depth < MOST || widest > ROUGH.max(blur) && seen.depth < AT_ONCE;
        if (split || twice) && seen.may_split {
            return None;
        }
        let detail = if seen.depth > if is_mirror { TWICE } else { AT_ONCE } { Detail::Part } else { Detail::Pixel };
        Some(world.shade(&surface, world.reflected(&beams, surface.gloss, detail)))
    }
}

/// Returns the mean light of a cell's quarters.
fn mean(cell: Cell, light: impl Fn(Cell) -> Rgba) -> Rgba {
    cell.quarters().into_iter().fold(Rgba::TRANSPARENT, |sum, quarter| sum + light(quarter) * 0.25)
}
