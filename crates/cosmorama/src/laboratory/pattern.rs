use std::f64::consts::PI;

use crate::camera::{PixelPoint, View};
use crate::compare::Mask;
use crate::filter::semi_axes;
use crate::raster::Rgba;
use crate::sphere::Direction;
use crate::world::{Light, World};

/// A pattern in a target's own pixels, laid over a world: red and green hold the cosine and the sine of a zone plate, blue
/// holds rings with sharp edges.
///
/// The zone plate's phase at distance r from the middle is π r²/R, so that its frequency there is r/R cycles a pixel: it
/// reaches one at the distance R, where the pattern ends. Two gratings a quarter of a period apart tell what is left of
/// one of any phase.
pub(super) struct Pattern<'a> {
    target: &'a View,
    middle: PixelPoint,
    radius: f64,
}

/// Distance between two edges of the rings, in pixels.
const RING: f64 = 24.0;

/// A pixel in which the pattern is measured.
pub(super) struct Probe {
    /// Its index in the picture.
    pub(super) pixel: usize,
    /// Frequency of the zone plate along rows and along columns, in cycles a pixel.
    pub(super) frequency: [f64; 2],
    /// Distance outwards from the nearest edge of the rings, in pixels.
    pub(super) from_edge: f64,
    /// Whether the rings become brighter there.
    pub(super) rises: bool,
    /// Texels along the pixel's shorter side.
    pub(super) texels: f64,
}

impl<'a> Pattern<'a> {
    /// Centres the pattern on a target.
    pub(super) fn over(target: &'a View) -> Self {
        let (width, height) = (target.width() as f64, target.height() as f64);
        // Beside the middle, so that distances of pixels from it are many: around it they would come in eights.
        let middle = PixelPoint::new(width / 2.0 + 0.31, height / 2.0 + 0.17);
        Self { target, middle, radius: width.min(height) / 2.0 }
    }

    /// Lays the pattern over a world. Outside of the target it is grey.
    pub(super) fn light(&self, world: &World) -> Light {
        Light::by_direction(world, |direction| self.colour(world, direction).unwrap_or(Rgba::opaque(0.5, 0.5, 0.5)))
    }

    fn colour(&self, world: &World, direction: Direction) -> Option<Rgba> {
        let pixel = self.target.pixel(direction)?;
        let distance = self.distance(pixel);
        if distance > self.radius {
            return None;
        }
        let (sin, cos) = (PI * distance * distance / self.radius).sin_cos();
        let footprint = self.target.footprint(pixel)?;
        let (view, _) = world.owner(direction)?;
        let (_, jacobian) = world.sources()[view].view.texel_footprint(&footprint)?;
        let texels = jacobian.determinant().abs().sqrt();
        // A texel that an edge cuts holds the part on its bright side.
        let (from_edge, rises) = ring(distance);
        let part = (0.5 + from_edge * texels).clamp(0.0, 1.0);
        let bright = if rises { part } else { 1.0 - part };
        Some(Rgba::opaque((0.5 + 0.5 * cos) as f32, (0.5 + 0.5 * sin) as f32, bright as f32))
    }

    fn distance(&self, pixel: PixelPoint) -> f64 {
        (pixel.x - self.middle.x).hypot(pixel.y - self.middle.y)
    }

    /// Finds the whole pixels inside the pattern.
    pub(super) fn probes(&self, world: &World, whole: &Mask) -> Vec<Probe> {
        let (width, height) = whole.size();
        let pixels = (0..width * height).filter(|pixel| whole.row(pixel / width)[pixel % width]);
        pixels.filter_map(|pixel| self.probe(world, (pixel, pixel % width, pixel / width))).collect()
    }

    fn probe(&self, world: &World, (pixel, i, j): (usize, usize, usize)) -> Option<Probe> {
        let distance = self.distance(PixelPoint::centre(i, j));
        // Beyond the last pixels of the pattern kernels reach the grey.
        let inside = distance < self.radius - 4.0;
        let footprint = self.target.screen_pixel(i, j).filter(|_| inside)?.footprint;
        let (view, _) = world.owner(footprint.direction)?;
        let (_, jacobian) = world.sources()[view].view.texel_footprint(&footprint)?;
        let (from_edge, rises) = ring(distance);
        let [_, texels] = semi_axes(jacobian);
        let frequency =
            [i as f64 + 0.5 - self.middle.x, j as f64 + 0.5 - self.middle.y].map(|at| at.abs() / self.radius);
        Some(Probe { pixel, frequency, from_edge, rises, texels })
    }
}

/// Returns the distance outwards from the nearest edge, and whether it gets brighter outwards.
fn ring(distance: f64) -> (f64, bool) {
    // The rings begin with one edge around a dark middle.
    let edge = (distance / RING).round().max(1.0);
    (distance - edge * RING, edge as i64 % 2 == 1)
}
