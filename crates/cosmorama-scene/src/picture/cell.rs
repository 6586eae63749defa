use cosmorama::camera::PixelPoint;
use cosmorama::raster::Rgba;

use crate::camera::{Camera, Ray};
use crate::scene::{Object, Scene};
use crate::shade::{Beam, Detail, Surroundings};
use crate::shape::Meeting;

/// Maker of single pixels.
#[derive(Clone, Copy)]
pub(super) struct Pixel<'a> {
    scene: &'a Scene,
    camera: &'a Camera,
    surroundings: &'a Surroundings<'a>,
}

/// A square part of a pixel.
#[derive(Clone, Copy, Debug)]
struct Cell {
    centre: PixelPoint,
    /// Side, in pixels.
    side: f64,
    /// Number of halvings.
    depth: usize,
}

/// Part of a cell that a thing covers.
struct Part<'a> {
    object: &'a Object,
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

/// Part of the world's mean light by which a cell and its quarters may differ, weighed by the cell's area: so much light
/// may a pixel have too much or too little for each of its cells. Where a sun is seen this parts cells further, at most
/// so many times.
const UNEVEN: f64 = 5e-5;
const FINEST: usize = 12;

/// Part of the world, in steradians, above which a cell is compared with its quarters.
const LARGE: f64 = 1e-3;

/// Coverage below which a part has no light of its own.
const LEAST: f64 = 1e-6;

/// Light of a cell, as a part of the cell.
#[derive(Clone, Copy)]
struct Lit {
    light: Rgba,
    /// Part of the world that is seen, in steradians.
    seen: f64,
}

/// Treatment of a cell.
enum Sight<'a> {
    Split,
    Parts(Vec<Part<'a>>),
}

impl<'a> Pixel<'a> {
    pub(super) fn new(scene: &'a Scene, camera: &'a Camera, surroundings: &'a Surroundings<'a>) -> Self {
        Self { scene, camera, surroundings }
    }

    /// Returns the light of all things in a pixel, premultiplied by the part that they cover; `None` if there are none.
    pub(super) fn light(&self, i: usize, j: usize) -> Option<Rgba> {
        let cell = Cell { centre: PixelPoint::centre(i, j), side: 1.0, depth: 0 };
        let light = self.cell(cell);
        if light.alpha() <= 0.0 {
            return None;
        }
        let shown = self.camera.coverage(i, j);
        (shown > 0.0).then(|| light * shown as f32)
    }

    /// Returns the light of a cell, as a part of the cell.
    fn cell(&self, cell: Cell) -> Rgba {
        match self.whole(cell) {
            Some(lit) if lit.seen > LARGE => self.refined(cell, lit.light),
            Some(lit) => lit.light,
            None => mean(cell.quarters().map(|quarter| self.cell(quarter))),
        }
    }

    /// Returns the light of a cell whose first estimate may be too rough: its quarters', if they tell of more.
    fn refined(&self, cell: Cell, estimate: Rgba) -> Rgba {
        if cell.depth >= FINEST {
            return estimate;
        }
        let quarters = cell.quarters();
        let lights = quarters.map(|quarter| self.estimate(quarter));
        let better = mean(lights);
        let change = (0..3).map(|k| f64::from((better.0[k] - estimate.0[k]).abs())).fold(0.0, f64::max);
        if change * cell.side * cell.side <= UNEVEN * self.surroundings.mean {
            return better;
        }
        mean(std::array::from_fn(|k| self.refined(quarters[k], lights[k])))
    }

    /// Returns the light of a cell by its shape alone.
    fn estimate(&self, cell: Cell) -> Rgba {
        match self.whole(cell) {
            Some(lit) => lit.light,
            None => mean(cell.quarters().map(|quarter| self.estimate(quarter))),
        }
    }

    /// Returns the light of a cell that is seen at once; `None` if the cell must be split.
    fn whole(&self, cell: Cell) -> Option<Lit> {
        const NOTHING: Lit = Lit { light: Rgba::TRANSPARENT, seen: 0.0 };
        let Some(ray) = self.camera.ray(cell.centre) else {
            return (cell.depth >= AT_OUTLINES).then_some(NOTHING);
        };
        match self.sight(&ray.scaled(cell.side), cell) {
            Sight::Split => None,
            Sight::Parts(parts) => self.parts(cell, parts),
        }
    }

    /// Tells what a beam meets.
    fn sight(&self, beam: &Ray, cell: Cell) -> Sight<'a> {
        let mut parts = Vec::new();
        for object in &self.scene.objects {
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
                parts.push(Part { object, distance, coverage, middle });
            }
        }
        parts.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        Sight::Parts(parts)
    }

    /// Adds the light of a cell's parts, nearer ones before others; `None` if the cell must be split.
    fn parts(&self, cell: Cell, parts: Vec<Part>) -> Option<Lit> {
        let mut sum = Lit { light: Rgba::TRANSPARENT, seen: 0.0 };
        for part in parts {
            let lit = self.part(cell, &part)?;
            sum.light = sum.light.over(lit.light * part.coverage as f32);
            sum.seen = sum.seen.max(lit.seen);
            if sum.light.alpha() >= 1.0 {
                break;
            }
        }
        Some(sum)
    }

    /// Returns the light of a part as if it were all of the cell; `None` if the cell must be split.
    fn part(&self, cell: Cell, part: &Part) -> Option<Lit> {
        const NOTHING: Lit = Lit { light: Rgba::TRANSPARENT, seen: 0.0 };
        let [x, y] = part.middle.map(|offset| offset * cell.side);
        let ray = self.camera.ray(PixelPoint::new(cell.centre.x + x, cell.centre.y + y));
        let Some(beam) = ray.map(|ray| ray.scaled(cell.side)) else { return Some(NOTHING) };
        let sphere = &part.object.sphere;
        let Some(distance) = sphere.meet(&beam, 0.0) else { return Some(NOTHING) };
        let met = beam.met(distance, sphere.normal_at(beam.at(distance)));
        let normal = sphere.normal(&met);
        let beams = Beam::of(&met, &normal, &part.object.material, sphere);
        let widest = Beam::widest(&beams);
        let is_outline = part.coverage < 1.0;
        if widest > STRAIGHT && cell.depth < MOST || widest > ROUGH && cell.depth < AT_ONCE && !is_outline {
            return None;
        }
        let detail = if cell.depth > AT_ONCE { Detail::Cell } else { Detail::Pixel };
        let light = self.surroundings.shade(&normal, &beams, &part.object.material, detail);
        Some(Lit { light, seen: Beam::largest(&beams) })
    }
}

impl Cell {
    fn quarters(self) -> [Self; 4] {
        [(-0.25, -0.25), (0.25, -0.25), (-0.25, 0.25), (0.25, 0.25)].map(|(x, y)| Self {
            centre: PixelPoint::new(self.centre.x + x * self.side, self.centre.y + y * self.side),
            side: 0.5 * self.side,
            depth: self.depth + 1,
        })
    }
}

/// Returns the light of a cell with these quarters.
fn mean(quarters: [Rgba; 4]) -> Rgba {
    quarters.into_iter().fold(Rgba::TRANSPARENT, |sum, light| sum + light * 0.25)
}
