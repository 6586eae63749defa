use cosmorama::camera::{PixelPoint, ScreenPixel, View};
use cosmorama::raster::{Image, Rgba};
use rayon::prelude::*;

use crate::pixel_window::sample_places;
use crate::{Average, Radiance};

/// Sides of the sample grids: to look for edges, to resolve edges, and for intricate pixels.
const COARSE: usize = 2;
const FINE: usize = 5;
const FINEST: usize = 16;

/// Least relative difference between samples that counts as an edge.
const CONTRAST: f32 = 0.1;

/// Renders a view of a world in linear light. Each pixel is weighted by exp(−2r²) around its centre, by formula if the
/// world has one, else by samples. Pixels that the field of view cuts are partly covered, and those outside are
/// transparent. The result does not depend on the number of threads.
pub fn picture(world: &impl Radiance, view: &View) -> Image<Rgba> {
    let [coarse, fine, finest] = [COARSE, FINE, FINEST].map(sample_places);
    let light = |i, j, pixel: &ScreenPixel| {
        let look = |places: &[(f64, f64)]| Samples::of(world, view, (i, j), places);
        let samples = match world.average(&pixel.footprint) {
            Average::Known(light) => return light,
            Average::Intricate => look(&finest),
            Average::Unknown => Some(look(&coarse)).filter(|seen| !seen.differ()).unwrap_or_else(|| look(&fine)),
        };
        samples.mean().unwrap_or_else(|| world.radiance(pixel.footprint.direction))
    };
    let mut image = Image::filled(view.width(), view.height(), Rgba::TRANSPARENT);
    // `par_chunks_mut` refuses chunks of nothing.
    image.pixels_mut().par_chunks_mut(view.width().max(1)).enumerate().for_each(|(j, row)| {
        for (i, target) in row.iter_mut().enumerate() {
            let Some(pixel) = view.screen_pixel(i, j) else { continue };
            let [red, green, blue] = light(i, j, &pixel);
            *target = Rgba::opaque(red, green, blue) * pixel.coverage as f32;
        }
    });
    image
}

/// Sums of the samples of one pixel.
struct Samples {
    count: usize,
    sum: [f32; 3],
    least: [f32; 3],
    greatest: [f32; 3],
}

impl Samples {
    /// Samples a pixel at places around its centre, where the projection has directions.
    fn of(world: &impl Radiance, view: &View, (i, j): (usize, usize), places: &[(f64, f64)]) -> Self {
        let mut seen = Self { count: 0, sum: [0.0; 3], least: [f32::INFINITY; 3], greatest: [0.0; 3] };
        let middle = PixelPoint::centre(i, j);
        for (x, y) in places {
            let Some(direction) = view.direction(PixelPoint::new(middle.x + x, middle.y + y)) else { continue };
            seen.count += 1;
            for (channel, light) in world.radiance(direction).into_iter().enumerate() {
                seen.sum[channel] += light;
                seen.least[channel] = seen.least[channel].min(light);
                seen.greatest[channel] = seen.greatest[channel].max(light);
            }
        }
        seen
    }

    /// Returns whether samples differ visibly.
    fn differ(&self) -> bool {
        /// Light below which differences in shadow are ignored.
        const SHADOW: f32 = 0.05;
        (0..3).any(|c| self.greatest[c] - self.least[c] > CONTRAST * (self.greatest[c] + SHADOW))
    }

    fn mean(&self) -> Option<[f32; 3]> {
        (self.count > 0).then(|| self.sum.map(|sum| sum / self.count as f32))
    }
}
