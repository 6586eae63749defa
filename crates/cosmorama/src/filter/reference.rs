//! Brute force: N×N sub-samples a pixel through the exact mapping, weighted by the kernel in screen space, in f64.

use rayon::prelude::*;

use super::kernel::UNDER;
use super::{Filter, lookup};
use crate::camera::{PixelPoint, View};
use crate::raster::{Image, Rgba};
use crate::sphere::Direction;
use crate::world::World;

/// The target by brute force. Slow, obvious, the judge of the other filters.
pub(crate) fn render(world: &World, target: &View, filter: &Filter, samples: usize, texels: &[Rgba]) -> Image<Rgba> {
    let mut image = Image::filled(target.width(), target.height(), Rgba::TRANSPARENT);
    image.pixels_mut().par_chunks_mut(target.width().max(1)).enumerate().for_each(|(j, row)| {
        for (i, pixel) in row.iter_mut().enumerate() {
            if let Some(screen) = target.screen_pixel(i, j) {
                let kernel = KernelSquare::new(world, target, filter, samples, (i, j));
                let average = kernel.average(texels).or_else(|| look(world, screen.footprint.direction, texels));
                *pixel = average.unwrap_or(Rgba::TRANSPARENT) * screen.coverage as f32;
            }
        }
    });
    image
}

/// Gives every texel that a pixel's sub-samples look at to `visit`.
pub(crate) fn for_each_texel(
    world: &World,
    target: &View,
    filter: &Filter,
    samples: usize,
    pixel: (usize, usize),
    mut visit: impl FnMut(u32, f64),
) {
    let kernel = KernelSquare::new(world, target, filter, samples, pixel);
    kernel.for_each_sample(|_, _, at| {
        if let Some(direction) = kernel.direction(at) {
            lookup::bilinear(world, direction, &mut visit);
        }
    });
}

/// The square of sub-samples that a kernel reaches around a pixel.
struct KernelSquare<'a> {
    world: &'a World,
    target: &'a View,
    filter: &'a Filter,
    samples: usize,
    centre: PixelPoint,
    coarseness: f64,
}

impl<'a> KernelSquare<'a> {
    fn new(world: &'a World, target: &'a View, filter: &'a Filter, samples: usize, (i, j): (usize, usize)) -> Self {
        let centre = PixelPoint::centre(i, j);
        let coarseness = texels_per_pixel(world, target, centre).map_or(1.0, |s| filter.kernel.coarseness(s));
        Self { world, target, filter, samples, centre, coarseness }
    }

    /// `None` if no sub-sample is inside the field of view, as in a pixel of which the rim leaves a sliver.
    fn average(&self, texels: &[Rgba]) -> Option<Rgba> {
        let (mut sum, mut weights, mut size) = ([0f64; 4], 0f64, 0f64);
        let (mut least, mut greatest) = ([f64::INFINITY; 4], [f64::NEG_INFINITY; 4]);
        self.for_each_sample(|weight, r, at| {
            let Some((colour, found)) = self.sample(at, texels) else { return };
            weights += weight * found;
            size += weight.abs() * found;
            for c in 0..4 {
                sum[c] += weight * colour[c];
                if r * r < UNDER && found > 0.0 {
                    least[c] = least[c].min(colour[c] / found);
                    greatest[c] = greatest[c].max(colour[c] / found);
                }
            }
        });
        // As in the gather: where only negative lobes reach the world, there is no average.
        if weights <= 0.05 * size {
            return None;
        }
        Some(Rgba(std::array::from_fn(|c| {
            let value = sum[c] / weights;
            let clamped = self.filter.anti_ringing && least[c] <= greatest[c];
            (if clamped { value.clamp(least[c], greatest[c]) } else { value }) as f32
        })))
    }

    /// Calls `visit` with the weight, the distance in the kernel's unit and the place of each sub-sample that counts.
    fn for_each_sample(&self, mut visit: impl FnMut(f64, f64, PixelPoint)) {
        let scale = self.filter.kernel.scale;
        let reach = (self.filter.kernel.radius() * scale * self.samples as f64).ceil() as i64 + 1;
        let step = (self.samples as f64).recip();
        // Sub-samples lie at the centres of an N×N grid in each pixel.
        let phase = if self.samples.is_multiple_of(2) { 0.5 } else { 0.0 };
        for b in -reach..=reach {
            for a in -reach..=reach {
                let (x, y) = ((a as f64 + phase) * step, (b as f64 + phase) * step);
                let (rx, ry) = (x / scale, y / scale);
                let weight = self.weight(rx, ry);
                if weight != 0.0 {
                    visit(weight, rx.hypot(ry), PixelPoint::new(self.centre.x + x, self.centre.y + y));
                }
            }
        }
    }

    fn weight(&self, x: f64, y: f64) -> f64 {
        let kernel = &self.filter.kernel;
        kernel.fine.weight_at(x, y) * (1.0 - self.coarseness) + kernel.coarse.weight_at(x, y) * self.coarseness
    }

    /// The direction at a point of the target, if the field stop lets it pass.
    fn direction(&self, at: PixelPoint) -> Option<Direction> {
        self.target.stop_passes(at).then(|| self.target.direction(at))?
    }

    /// Light at a point of the target times the part of it that the world holds, and that part.
    fn sample(&self, at: PixelPoint, texels: &[Rgba]) -> Option<([f64; 4], f64)> {
        Some(weighted_light(self.world, self.direction(at)?, texels))
    }
}

/// The light in one direction, bilinear.
fn look(world: &World, direction: Direction, texels: &[Rgba]) -> Option<Rgba> {
    let (colour, found) = weighted_light(world, direction, texels);
    (found > 0.0).then(|| Rgba(colour.map(|c| (c / found) as f32)))
}

fn weighted_light(world: &World, direction: Direction, texels: &[Rgba]) -> ([f64; 4], f64) {
    let (mut colour, mut found) = ([0f64; 4], 0f64);
    lookup::bilinear(world, direction, |texel, weight| {
        found += weight;
        for (sum, &channel) in colour.iter_mut().zip(&texels[texel as usize].0) {
            *sum += weight * f64::from(channel);
        }
    });
    (colour, found)
}

/// s = √|det J|, in the view that shows the pixel's centre.
fn texels_per_pixel(world: &World, target: &View, centre: PixelPoint) -> Option<f64> {
    let footprint = target.footprint(centre)?;
    let (index, _) = world.owner(footprint.direction)?;
    let source = &world.sources()[index];
    let (_, jacobian) = source.view.texel_footprint(&footprint)?;
    Some(jacobian.determinant().abs().sqrt())
}
