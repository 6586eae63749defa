use std::f64::consts::PI;
use std::ops::Range;

use rayon::prelude::*;

use super::basis::HarmonicFunctions;
use crate::lighting::prefilter::averages::Normalisation;
use crate::lighting::texel_angles::texel_angles;
use crate::raster::Rgba;
use crate::world::{Source, World};

/// Integrals of a world's red, green, blue and opacity, times each function.
pub(super) struct HarmonicSums(Vec<[f64; 4]>);

/// Rows that are summed together. Sums of pieces are added in order, so that the number of threads does not matter.
const ROWS: usize = 16;

impl HarmonicSums {
    /// Sums over all texels, by their solid angles.
    pub(super) fn of(world: &World, texels: &[Rgba], functions: &HarmonicFunctions) -> Self {
        assert_eq!(texels.len(), world.texel_count(), "one texel of light for each texel of the world");
        let mut sums = vec![[0.0; 4]; functions.count()];
        for source in world.sources() {
            let angles = texel_angles(source);
            let piece = Piece { source, texels: &texels[source.texels()], angles: &angles, functions };
            let height = source.view.height();
            let rows = (0..height.div_ceil(ROWS)).into_par_iter();
            let pieces: Vec<_> = rows.map(|k| piece.sum(k * ROWS..height.min((k + 1) * ROWS))).collect();
            pieces.iter().for_each(|piece| add(&mut sums, piece));
        }
        Self(sums)
    }

    /// Returns the integrals of the light, with a colour where the world shows nothing.
    pub(super) fn over(self, unseen: Rgba) -> Vec<[f64; 3]> {
        // The integral of the first function over the sphere; those of others are zero.
        let first = 2.0 * PI.sqrt();
        let shown = self.0[0][3] * first;
        let unseen = [0, 1, 2].map(|channel| f64::from(unseen.0[channel]));
        let complete = Normalisation::of(shown) == Normalisation::Complete;
        let scale = if complete { 4.0 * PI / shown } else { 1.0 };
        let integral = |(k, [red, green, blue, alpha]): (usize, [f64; 4])| {
            let whole = if k == 0 { first } else { 0.0 };
            let hidden = if complete { 0.0 } else { whole - alpha };
            let light = [red, green, blue];
            [0, 1, 2].map(|channel| light[channel] * scale + unseen[channel] * hidden)
        };
        self.0.into_iter().enumerate().map(integral).collect()
    }
}

/// A view with its light.
struct Piece<'a> {
    source: &'a Source,
    texels: &'a [Rgba],
    angles: &'a [f32],
    functions: &'a HarmonicFunctions,
}

impl Piece<'_> {
    fn sum(&self, rows: Range<usize>) -> Vec<[f64; 4]> {
        let mut sums = vec![[0.0; 4]; self.functions.count()];
        let mut values = vec![0.0; self.functions.count()];
        let width = self.source.view.width();
        for j in rows {
            self.source.view.row_directions(j, 0..width, |i, direction| {
                let texel = j * width + i;
                let angle = f64::from(self.angles[texel]);
                if angle > 0.0 {
                    let light = self.texels[texel].0.map(|light| f64::from(light) * angle);
                    self.functions.evaluate(direction, &mut values);
                    for (sum, value) in sums.iter_mut().zip(&values) {
                        sum.iter_mut().zip(light).for_each(|(sum, light)| *sum += value * light);
                    }
                }
            });
        }
        sums
    }
}

fn add(sums: &mut [[f64; 4]], others: &[[f64; 4]]) {
    for (sum, other) in sums.iter_mut().zip(others) {
        sum.iter_mut().zip(other).for_each(|(sum, other)| *sum += other);
    }
}
