use rayon::prelude::*;

use super::band::Band;
use super::span::Run;
use super::symmetry::{MirrorImage, Walk, exchanged};
use super::window_format::Kept;
use super::{BAND, Compiled, Geometry, Plan};
use crate::render::apply::float::weights::{FloatFormat, weight_index};

/// Greatest number of parts into which a world's texels are divided. Each part reads the whole plan, so the work grows
/// with their number. With more parts, threads would do little else, and take time from others.
const MOST_PARTS: usize = 8;

impl Plan {
    /// Distributes a number of each pixel to the texels that it is made of, times their weights: the transpose of the
    /// plan. The results are added to `texels`, which has a number for each texel.
    ///
    /// # Panics
    /// If the plan is one of integers, or of a pyramid.
    pub(crate) fn spread(&self, pixels: &[f32], texels: &mut [f64]) {
        let Geometry::Float(plan) = &self.0 else { panic!("weights of floats, of the world's own texels") };
        // Each thread reads all of the plan, and adds to its own texels only. Each texel's sum has the plan's order,
        // whatever the number of threads.
        let parts = rayon::current_num_threads().min(MOST_PARTS);
        let some = texels.len().div_ceil(parts).max(1);
        texels.par_chunks_mut(some).enumerate().for_each(|(part, texels)| {
            let mut part = Part { first: part * some, texels };
            for (index, band) in plan.bands.iter().enumerate() {
                let spread = Spread { plan, band, top: index * BAND };
                band.groups().for_each(|group| spread.group(group, pixels, &mut part));
                spread.singles(pixels, &mut part);
            }
        });
    }
}

/// A part of a world's texels.
struct Part<'a> {
    first: usize,
    texels: &'a mut [f64],
}

impl Part<'_> {
    /// Adds to a texel if it belongs to this part.
    fn add(&mut self, texel: usize, number: f64) {
        if let Some(sum) = self.texels.get_mut(texel.wrapping_sub(self.first)) {
            *sum += number;
        }
    }

    /// Returns whether a window has surely no texel in this part.
    fn is_beside(&self, walk: Walk, [columns, rows]: [usize; 2]) -> bool {
        // All texels of a window lie between those of its corners.
        let corners = [[0, 0], [columns - 1, 0], [0, rows - 1], [columns - 1, rows - 1]];
        let corners = corners.map(|corner| walk.texel(corner) as usize);
        corners.iter().all(|&texel| texel < self.first)
            || corners.iter().all(|&texel| texel >= self.first + self.texels.len())
    }
}

struct Spread<'a> {
    plan: &'a Compiled<FloatFormat>,
    band: &'a Band<FloatFormat>,
    /// First row of the band.
    top: usize,
}

impl Spread<'_> {
    /// Reads the value of the pixel where a mirror image shows this one; zero if that image does not show it.
    fn pixel(&self, pixels: &[f32], image: usize, [column, row]: [usize; 2]) -> f64 {
        let plan = self.plan;
        let MirrorImage { flips, is_turned, .. } = plan.mirrors.images[image];
        let pixel = [column, self.top + row];
        if image >= plan.mirrors.images_of(pixel).len() {
            return 0.0;
        }
        let [column, row] = exchanged(pixel, is_turned);
        let column = if flips[0] { plan.width - 1 - column } else { column };
        let row = if flips[1] { plan.height - 1 - row } else { row };
        f64::from(pixels[row * plan.width + column])
    }

    fn group(&self, group: &[Run], pixels: &[f32], part: &mut Part) {
        let plan = self.plan;
        for (index, image) in plan.mirrors.images.iter().enumerate() {
            let view = image.view(usize::from(group[0].view));
            for (run, header, Kept { shape, weights, .. }) in self.band.weights.windows(group) {
                let lane = header.place().lane;
                let walk = view.walk(run.first(lane).map(|at| at as usize));
                if part.is_beside(walk, [shape.width, shape.height]) {
                    continue;
                }
                let pixel = self.pixel(pixels, index, run.pixel(lane));
                for row in 0..shape.height {
                    for column in 0..shape.width {
                        let texel = walk.texel([column, row]) as usize;
                        part.add(texel, pixel * f64::from(f32::from_bits(weights[weight_index(shape, [row, column])])));
                    }
                }
            }
        }
    }

    fn singles(&self, pixels: &[f32], part: &mut Part) {
        let images = self.plan.mirrors.images.len();
        for single in self.band.singles.pixels() {
            let taps = self.band.singles.taps(single, images);
            for image in 0..images {
                let pixel = self.pixel(pixels, image, [single.column as usize, usize::from(single.row)]);
                for (weight, texels) in taps.weights.iter().zip(taps.texels.chunks(images)) {
                    part.add(texels[image] as usize, pixel * f64::from(*weight));
                }
            }
        }
    }
}
