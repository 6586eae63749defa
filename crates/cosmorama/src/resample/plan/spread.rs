use super::band::{Band, Run};
use super::float_weights::FloatWeights;
use super::{BAND, Plan};

impl Plan {
    /// Takes a number from each pixel back to the texels that it is made of, times their weights: what the plan does the other
    /// way round. Adds it to a number of each texel.
    pub(in crate::resample) fn spread(&self, pixels: &[f32], texels: &mut [f64]) {
        for (index, band) in self.0.bands.iter().enumerate() {
            let spread = Spread { plan: self, band, top: index * BAND };
            band.runs.iter().for_each(|run| spread.run(run, pixels, texels));
            spread.singles(pixels, texels);
        }
    }
}

struct Spread<'a> {
    plan: &'a Plan,
    band: &'a Band<FloatWeights>,
    /// Its first row.
    top: usize,
}

impl Spread<'_> {
    /// That of a pixel in place of which a mirror shows this one.
    fn pixel(&self, pixels: &[f32], image: usize, [column, row]: [usize; 2]) -> f64 {
        let Plan(plan) = self.plan;
        let flips = plan.mirrors.images[image].flips;
        let row = self.top + row;
        let column = if flips[0] { plan.width - 1 - column } else { column };
        let row = if flips[1] { plan.height - 1 - row } else { row };
        f64::from(pixels[row * plan.width + column])
    }

    fn run(&self, run: &Run, pixels: &[f32], texels: &mut [f64]) {
        let Plan(plan) = self.plan;
        for (index, image) in plan.mirrors.images.iter().enumerate() {
            let corner = image.view(usize::from(run.view)).walk(run.corner());
            for (lane, window) in self.band.weights.windows(run) {
                let pixel = self.pixel(pixels, index, run.pixel(lane));
                let mut walk = run.walk(corner, lane);
                for row in 0..window.shape.height {
                    let first = walk.first as usize;
                    for column in 0..window.shape.width {
                        let texel = if walk.is_reversed { first - column } else { first + column };
                        texels[texel] += pixel * f64::from(window.weight(row, column));
                    }
                    walk = walk.one_down();
                }
            }
        }
    }

    fn singles(&self, pixels: &[f32], texels: &mut [f64]) {
        for single in &self.band.singles {
            let pixel =
                self.pixel(pixels, usize::from(single.image), [single.column as usize, usize::from(single.row)]);
            for tap in self.band.taps(single).taps {
                texels[tap.texel as usize] += pixel * f64::from(tap.weight);
            }
        }
    }
}
