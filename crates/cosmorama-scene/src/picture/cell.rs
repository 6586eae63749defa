use cosmorama::camera::PixelPoint;
use cosmorama::raster::Rgba;

use super::QUARTERS;
use super::small::Reflection;
use crate::camera::{Camera, Ray};
use crate::scene::{Object, Scene};
use crate::shade::{Beam, Detail, Surroundings};
use crate::shape::{Meeting, Wall};

/// Maker of single pixels.
#[derive(Clone, Copy)]
pub(super) struct Pixel<'a> {
    pub(super) scene: &'a Scene,
    pub(super) camera: &'a Camera,
    pub(super) surroundings: &'a Surroundings<'a>,
    /// Reflections of the things of few pixels, by their place in the scene.
    pub(super) reflections: &'a [Option<Reflection>],
}

/// A square part of a pixel.
#[derive(Clone, Copy, Debug)]
struct Cell {
    centre: PixelPoint,
    /// Side, in pixels.
    side: f64,
    /// Number of halvings.
    depth: usize,
    /// Column and row of the pixel.
    pixel: [usize; 2],
}

/// Part of a cell that a thing covers.
struct Part<'a> {
    object: &'a Object,
    reflection: Option<&'a Reflection>,
    /// Distance of its centre, by which nearer things hide others.
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

/// Halvings of a pixel: at outlines at least, elsewhere at most.
const AT_OUTLINES: usize = 3;
const MOST: usize = 6;

/// Coverage below which a part has no light of its own.
const LEAST: f64 = 1e-6;

/// Treatment of a cell.
enum Sight<'a> {
    Split,
    Parts(Vec<Part<'a>>),
}

impl<'a> Pixel<'a> {
    /// Returns the light of all things in a pixel, premultiplied by the part that they cover; `None` if there are none.
    pub(super) fn light(&self, i: usize, j: usize) -> Option<Rgba> {
        let cell = Cell { centre: PixelPoint::centre(i, j), side: 1.0, depth: 0, pixel: [i, j] };
        let light = self.cell(cell);
        if light.alpha() <= 0.0 {
            return None;
        }
        let shown = self.camera.coverage(i, j);
        (shown > 0.0).then(|| light * shown as f32)
    }

    /// Returns the light of a cell, as a part of the cell.
    fn cell(&self, cell: Cell) -> Rgba {
        let Some(ray) = self.camera.ray(cell.centre) else {
            return if cell.depth < AT_OUTLINES { self.quarters(cell) } else { Rgba::TRANSPARENT };
        };
        match self.sight(&ray.scaled(cell.side), cell) {
            Sight::Split => self.quarters(cell),
            Sight::Parts(parts) => self.parts(cell, parts).unwrap_or_else(|| self.quarters(cell)),
        }
    }

    fn quarters(&self, cell: Cell) -> Rgba {
        let mut sum = Rgba::TRANSPARENT;
        for (x, y) in QUARTERS {
            let centre = PixelPoint::new(cell.centre.x + x * cell.side, cell.centre.y + y * cell.side);
            let part = self.cell(Cell { centre, side: 0.5 * cell.side, depth: cell.depth + 1, ..cell }) * 0.25;
            sum += part;
        }
        sum
    }

    /// Tells what a beam meets.
    fn sight(&self, beam: &Ray, cell: Cell) -> Sight<'a> {
        let mut parts = Vec::new();
        for (index, object) in self.scene.objects.iter().enumerate() {
            let (coverage, middle) = match object.sphere.meeting(beam) {
                Meeting::Missed => continue,
                Meeting::Met => (1.0, [0.0; 2]),
                Meeting::Wide if cell.depth < MOST => return Sight::Split,
                Meeting::Wide if object.sphere.meet(beam, 0.0).is_some() => (1.0, [0.0; 2]),
                Meeting::Wide => continue,
                Meeting::Crossed(_) if cell.depth < AT_OUTLINES => return Sight::Split,
                Meeting::Crossed(edge) => (edge.coverage(), edge.middle()),
            };
            if coverage > LEAST {
                let distance = (object.sphere.centre - beam.origin).dot(beam.direction);
                parts.push(Part { object, reflection: self.reflections[index].as_ref(), distance, coverage, middle });
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
        let sphere = &part.object.sphere;
        let Some(Wall { met, normal, .. }) = sphere.wall(&beam, 0.0) else { return Some(Rgba::TRANSPARENT) };
        let material = &part.object.material;
        let whole = part.reflection.and_then(|reflection| reflection.light(cell.pixel));
        if let Some(reflected) = whole {
            return Some(self.surroundings.shade(&normal, reflected, material));
        }
        let beams = Beam::of(&met, &normal, material, sphere);
        let widest = Beam::widest(&beams);
        let split = widest > STRAIGHT && cell.depth < MOST || widest > ROUGH && cell.depth < AT_ONCE;
        if split && part.coverage == 1.0 {
            return None;
        }
        let detail = if cell.depth > AT_ONCE { Detail::Part } else { Detail::Pixel };
        Some(self.surroundings.shade(&normal, self.surroundings.reflected(&beams, material, detail), material))
    }
}
