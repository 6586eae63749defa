use cosmorama::raster::{Image, Rgba};
use cosmorama::sphere::Direction;
use rayon::prelude::*;

use crate::Radiance;

/// How many point samples are averaged into a pixel; they lie on a regular grid inside it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Supersampling {
    /// This many by this many in every pixel (0 counts as 1).
    Uniform(usize),
    /// A coarse grid in every pixel and a fine one where it or a neighbour shows an edge.
    Adaptive {
        /// Side of the grid that looks for edges.
        coarse: usize,
        /// Side of the grid that resolves them.
        fine: usize,
        /// Least relative difference between samples that counts as an edge.
        contrast: f32,
    },
}

impl Default for Supersampling {
    /// 2×2 everywhere, 3×3 where samples differ by more than 10 %.
    fn default() -> Self {
        Self::Adaptive { coarse: 2, fine: 3, contrast: 0.1 }
    }
}

/// Renders a world into an image of `width` × `height` pixels: the box average of each pixel, in linear light.
///
/// `direction` unprojects a point of the image, in pixels from its top left corner, so that the centre of
/// pixel (i, j) is at (i + ½, j + ½); `None` where the image shows nothing. A pixel without any direction is
/// transparent, one that is partly outside is covered in part. To render a rectangle of a larger image, add
/// the rectangle's corner to the point. The result does not depend on the number of threads.
pub fn render(
    world: &impl Radiance,
    width: usize,
    height: usize,
    direction: impl Fn(f64, f64) -> Option<Direction> + Sync,
    supersampling: Supersampling,
) -> Image<Rgba> {
    let sample_pixel = |side: usize, i: usize, j: usize| sample_pixel(world, &direction, side, i, j);
    match supersampling {
        Supersampling::Uniform(side) => compute(width, height, |i, j| sample_pixel(side, i, j).mean),
        Supersampling::Adaptive { coarse, fine, contrast } => {
            let first = compute(width, height, |i, j| sample_pixel(coarse, i, j));
            compute(width, height, |i, j| {
                if is_edge(&first, i, j, contrast) { sample_pixel(fine, i, j).mean } else { first.get(i, j).mean }
            })
        }
    }
}

/// The samples of one pixel, summed up.
#[derive(Clone, Copy, Default)]
struct PixelSamples {
    mean: Rgba,
    least: Rgba,
    greatest: Rgba,
}

fn sample_pixel(
    world: &impl Radiance,
    direction: &impl Fn(f64, f64) -> Option<Direction>,
    side: usize,
    i: usize,
    j: usize,
) -> PixelSamples {
    let side = side.max(1);
    let step = 1.0 / side as f64;
    let mut sum = Rgba::TRANSPARENT;
    let mut least = Rgba([f32::INFINITY; 4]);
    let mut greatest = Rgba::TRANSPARENT;
    for row in 0..side {
        for column in 0..side {
            let x = i as f64 + (column as f64 + 0.5) * step;
            let y = j as f64 + (row as f64 + 0.5) * step;
            let sample = direction(x, y).map_or(Rgba::TRANSPARENT, |direction| {
                let [red, green, blue] = world.radiance(direction);
                Rgba::opaque(red, green, blue)
            });
            sum += sample;
            least = join(least, sample, f32::min);
            greatest = join(greatest, sample, f32::max);
        }
    }
    PixelSamples { mean: sum * (1.0 / (side * side) as f32), least, greatest }
}

fn join(a: Rgba, b: Rgba, pick: fn(f32, f32) -> f32) -> Rgba {
    Rgba(std::array::from_fn(|channel| pick(a.0[channel], b.0[channel])))
}

/// Whether the samples of a pixel and its four neighbours differ visibly. Neighbours are looked at because a
/// line thinner than the coarse grid slips through some pixels unseen, but not through all of them.
fn is_edge(samples: &Image<PixelSamples>, i: usize, j: usize, contrast: f32) -> bool {
    /// Differences in deep shadow do not matter: light below this counts as this much.
    const SHADOW: f32 = 0.05;
    let (right, below) = ((i + 1).min(samples.width() - 1), (j + 1).min(samples.height() - 1));
    let (left, above) = (i.saturating_sub(1), j.saturating_sub(1));
    let PixelSamples { mut least, mut greatest, .. } = *samples.get(i, j);
    for (column, row) in [(left, j), (right, j), (i, above), (i, below)] {
        let neighbour = samples.get(column, row);
        least = join(least, neighbour.least, f32::min);
        greatest = join(greatest, neighbour.greatest, f32::max);
    }
    (0..4).any(|channel| greatest.0[channel] - least.0[channel] > contrast * (greatest.0[channel] + SHADOW))
}

/// Computes an image row by row on all threads; each pixel by itself, so that threads cannot show.
fn compute<P: Clone + Default + Send>(
    width: usize,
    height: usize,
    pixel: impl Fn(usize, usize) -> P + Sync,
) -> Image<P> {
    let mut image = Image::filled(width, height, P::default());
    // `par_chunks_mut` refuses chunks of nothing; an image without columns has no pixels to visit either.
    image.pixels_mut().par_chunks_mut(width.max(1)).enumerate().for_each(|(j, row)| {
        for (i, target) in row.iter_mut().enumerate() {
            *target = pixel(i, j);
        }
    });
    image
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(_: Direction) -> [f32; 3] {
        [0.5; 3]
    }

    #[test]
    fn a_pixel_partly_outside_is_covered_in_part() {
        let left_of = |edge: f64| move |x: f64, _: f64| (x < edge).then_some(Direction::FRONT);
        let image = render(&grey, 3, 1, left_of(1.5), Supersampling::Uniform(4));
        assert_eq!(image.pixels(), [Rgba::opaque(0.5, 0.5, 0.5), Rgba([0.25, 0.25, 0.25, 0.5]), Rgba::TRANSPARENT]);
    }

    #[test]
    fn adaptive_resolves_an_edge_that_only_a_neighbour_sees() {
        // A line 0.1 pixels wide in the middle of pixel 1, where the coarse samples at ¼ and ¾ miss it;
        // its slope brings it under a sample elsewhere.
        let line = |x: f64, y: f64| {
            Some(if (x - 1.5 - 0.3 * (y - 0.5)).abs() < 0.05 { Direction::UP } else { Direction::FRONT })
        };
        let world = |direction: Direction| [f64::max(direction.vector().y, 0.0) as f32; 3];
        let uniform = render(&world, 3, 2, line, Supersampling::Uniform(10));
        let adaptive = render(&world, 3, 2, line, Supersampling::Adaptive { coarse: 2, fine: 10, contrast: 0.1 });
        assert!(uniform.get(1, 0).0[0] > 0.05);
        assert_eq!(uniform, adaptive);
    }

    #[test]
    fn an_empty_image_is_no_trouble() {
        assert!(render(&grey, 0, 5, |_, _| None, Supersampling::default()).pixels().is_empty());
    }
}
