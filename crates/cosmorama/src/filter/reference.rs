//! Brute force: N×N sub-samples a pixel through the exact mapping, weighted by the kernel in screen space, in f64.

use super::kernel::UNDER;
use super::traits::{Filter, PrepareError, Prepared, SetupCost, bounded};
use super::{Kernel, lookup};
use crate::camera::{Footprint, PixelPoint, View};
use crate::raster::Rgba;
use crate::sphere::Direction;
use crate::world::{Light, World};

/// Brute force: N × N sub-samples a pixel, weighted by the kernel in screen space, in f64. It is slow, and the other
/// filters are judged by it.
///
/// For a picture, [`Resampler::render`](crate::render::Resampler::render) maps each sub-sample exactly. For a footprint
/// only the derivatives are known. They place a sub-sample in the tangent plane, and its distance there becomes one
/// along a great circle ([`Footprint::direction_at`]). Sub-samples more than a quarter turn away do not count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference {
    /// Number of sub-samples along a pixel's side.
    pub samples: usize,
    /// Kernel that weighs the sub-samples; its floor and its centring have no effect.
    pub kernel: Kernel,
    /// Whether the average is clamped, per channel, to the sub-samples under the footprint.
    pub anti_ringing: bool,
}

impl Filter for Reference {
    fn prepare<'w>(&self, world: &'w World, light: &'w Light) -> Result<Box<dyn Prepared + 'w>, PrepareError> {
        light.check(world)?;
        Ok(Box::new(PreparedReference { world, light: light.texels(), filter: *self }))
    }

    fn setup(&self, _: &World) -> SetupCost {
        SetupCost::default()
    }
}

struct PreparedReference<'w> {
    world: &'w World,
    light: &'w [Rgba],
    filter: Reference,
}

impl Prepared for PreparedReference<'_> {
    fn world(&self) -> &World {
        self.world
    }

    fn reads(&self, footprint: &Footprint) -> usize {
        let Some(footprint) = bounded(footprint) else { return 0 };
        let mut count = 0;
        self.square(&footprint).for_each_sample(|_, _, at| {
            count += at.map_or(0, |direction| lookup::reads(self.world, direction));
        });
        count
    }

    fn average(&self, footprint: &Footprint) -> Rgba {
        let Some(footprint) = bounded(footprint) else { return Rgba::TRANSPARENT };
        let average = self.square(&footprint).average(self.light);
        average.or_else(|| look(self.world, footprint.direction, self.light)).unwrap_or(Rgba::TRANSPARENT)
    }
}

impl PreparedReference<'_> {
    /// Returns the square of sub-samples around a footprint's middle.
    fn square<'a>(&'a self, footprint: &'a Footprint) -> KernelSquare<'a, impl Fn(f64, f64) -> Option<Direction>> {
        let seen = if self.filter.kernel.round { footprint.rounded() } else { *footprint };
        let in_front = move |there: &Direction| there.dot(seen.direction) > 0.0;
        let look_at = move |x: f64, y: f64| seen.direction_at(x, y).filter(in_front);
        KernelSquare::new(self.world, &self.filter, Some(footprint), look_at)
    }
}

/// Fills a row of the target by brute force, which is slow and simple. The other filters are judged by it.
pub(crate) fn fill_row(
    world: &World,
    target: &View,
    filter: &Reference,
    texels: &[Rgba],
    (j, row): (usize, &mut [Rgba]),
) {
    for (i, pixel) in row.iter_mut().enumerate() {
        if let Some(screen) = target.screen_pixel(i, j) {
            let kernel = square_of_pixel(world, target, filter, (i, j));
            let average = kernel.average(texels).or_else(|| look(world, screen.footprint.direction, texels));
            *pixel = average.unwrap_or(Rgba::TRANSPARENT) * screen.coverage as f32;
        }
    }
}

/// Calls `visit` with every texel that a pixel's sub-samples read.
pub(crate) fn for_each_texel(
    world: &World,
    target: &View,
    filter: &Reference,
    pixel: (usize, usize),
    mut visit: impl FnMut(u32, f64),
) {
    let kernel = square_of_pixel(world, target, filter, pixel);
    kernel.for_each_sample(|_, _, direction| {
        if let Some(direction) = direction {
            lookup::bilinear(world, direction, &mut visit);
        }
    });
}

/// Returns the square of sub-samples of a target's pixel, mapped exactly and cut by the field stop.
fn square_of_pixel<'a>(
    world: &'a World,
    target: &'a View,
    filter: &'a Reference,
    (i, j): (usize, usize),
) -> KernelSquare<'a, impl Fn(f64, f64) -> Option<Direction>> {
    let centre = PixelPoint::centre(i, j);
    let screen = target.footprint(centre);
    let circle = screen.filter(|_| filter.kernel.round).map(|footprint| footprint.rounded());
    let look_at = move |x: f64, y: f64| {
        let at = PixelPoint::new(centre.x + x, centre.y + y);
        let seen = || circle.map_or_else(|| target.direction(at), |circle| circle.direction_at(x, y));
        target.stop_passes(at).then(seen)?
    };
    KernelSquare::new(world, filter, screen.as_ref(), look_at)
}

/// Square of the sub-samples that a kernel reaches around a pixel.
struct KernelSquare<'a, F> {
    world: &'a World,
    filter: &'a Reference,
    coarseness: f64,
    /// Returns the direction at an offset from the pixel's centre, in pixels.
    look_at: F,
}

impl<'a, F: Fn(f64, f64) -> Option<Direction>> KernelSquare<'a, F> {
    fn new(world: &'a World, filter: &'a Reference, footprint: Option<&Footprint>, look_at: F) -> Self {
        let coarseness = footprint.and_then(|footprint| texels_per_pixel(world, footprint));
        let coarseness = coarseness.map_or(1.0, |s| filter.kernel.coarseness(s));
        Self { world, filter, coarseness, look_at }
    }

    /// Averages the sub-samples. `None` if none is inside the field of view, as in a pixel at the rim of which only a
    /// sliver is left.
    fn average(&self, texels: &[Rgba]) -> Option<Rgba> {
        let (mut sum, mut weights, mut size) = ([0f64; 4], 0f64, 0f64);
        let (mut least, mut greatest) = ([f64::INFINITY; 4], [f64::NEG_INFINITY; 4]);
        self.for_each_sample(|weight, r, at| {
            let Some((colour, found)) = at.map(|at| weighted_light(self.world, at, texels)) else { return };
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

    /// Calls `visit` with the weight, the distance in the kernel's unit and the direction of each sub-sample that
    /// counts.
    fn for_each_sample(&self, mut visit: impl FnMut(f64, f64, Option<Direction>)) {
        let scale = self.filter.kernel.scale;
        let reach = (self.filter.kernel.radius() * scale * self.filter.samples as f64).ceil() as i64 + 1;
        let step = (self.filter.samples as f64).recip();
        // Sub-samples lie at the centres of an N×N grid in each pixel.
        let phase = if self.filter.samples.is_multiple_of(2) { 0.5 } else { 0.0 };
        for b in -reach..=reach {
            for a in -reach..=reach {
                let (x, y) = ((a as f64 + phase) * step, (b as f64 + phase) * step);
                let (rx, ry) = (x / scale, y / scale);
                let weight = self.weight(rx, ry);
                if weight != 0.0 {
                    visit(weight, rx.hypot(ry), (self.look_at)(x, y));
                }
            }
        }
    }

    fn weight(&self, x: f64, y: f64) -> f64 {
        let kernel = &self.filter.kernel;
        kernel.fine.weight_at(x, y) * (1.0 - self.coarseness) + kernel.coarse.weight_at(x, y) * self.coarseness
    }
}

/// Returns the light in one direction by bilinear interpolation.
pub(crate) fn look(world: &World, direction: Direction, texels: &[Rgba]) -> Option<Rgba> {
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

/// Computes s = √|det J| in the view that shows the pixel's centre.
fn texels_per_pixel(world: &World, footprint: &Footprint) -> Option<f64> {
    let (index, _) = world.owner(footprint.direction)?;
    let source = &world.sources()[index];
    let (_, jacobian) = source.view.texel_footprint(footprint)?;
    Some(jacobian.determinant().abs().sqrt())
}
