use cosmorama::raster::{Image, Rgba};
use cosmorama::resample::{Filter, Resampler};
use cosmorama::sphere::Direction;
use cosmorama::world::{View, World};
use glam::{DMat3, DVec3};

use crate::common_field::CommonField;
use crate::{Form, light_by_direction};

/// What a world loses in another form: measured on what came back, where both forms show it and the other one has the finer
/// pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundTrip {
    /// The part of the pixels that was compared.
    pub compared: f64,
    /// The mean difference of a channel, of a contrast of one.
    pub mean_error: f64,
    /// By how many pixels the picture came back displaced: of the views that make it the one that moved most.
    pub shift: f64,
    /// The largest step between the errors of neighbours between which the other form has a seam; zero where it has none.
    pub across: f64,
    /// The largest step between all other neighbours.
    pub elsewhere: f64,
}

/// A view in which fewer pixels are compared tells nothing of shifts.
const ENOUGH: usize = 500;

/// Waves of some thirty texels where there are 1500 in a steradian.
fn waves(direction: Direction) -> [f32; 3] {
    let d = direction.vector();
    let wave = |x: f64, y: f64| (0.5 + 0.25 * (x * 8.0).sin() + 0.25 * (y * 6.0 + x * 4.0).cos()) as f32;
    [wave(d.x, d.y), wave(d.y, d.z), wave(d.z, d.x)]
}

impl RoundTrip {
    /// Takes a world of waves from one form to another and back; `None` where they have too little in common to tell.
    pub fn measure(from: &Form, through: &Form) -> Option<Self> {
        let (first, second) = (from.world(), through.world());
        let light = light_by_direction(&first, waves);
        let there = convert(&first, &light, &through.views);
        let there: Vec<Rgba> = there.iter().flat_map(|image| image.pixels()).map(whole).collect();
        let back = convert(&second, &there, &from.views);
        // What nothing was measured of is no number, not zero.
        let mut sums = Sums { shift: f64::NAN, ..Sums::default() };
        for (image, source) in back.iter().zip(first.sources()) {
            let original = &light[source.texels()];
            let errors: Vec<[f64; 3]> = image.pixels().iter().zip(original).map(|(a, b)| difference(a, b)).collect();
            sums.add(&source.view, &CommonField::new(&source.view, from.is_whole, &second), original, &errors);
        }
        let shown = first.solid_angles().iter().filter(|&&solid_angle| solid_angle > 0.0).count();
        (sums.count >= ENOUGH).then(|| Self {
            compared: sums.count as f64 / shown as f64,
            mean_error: sums.error / sums.count as f64,
            shift: sums.shift,
            across: sums.across,
            elsewhere: sums.elsewhere,
        })
    }
}

fn convert(world: &World, light: &[Rgba], views: &[View]) -> Vec<Image<Rgba>> {
    views.iter().map(|target| Resampler { world, target, filter: Filter::DEFAULT }.render(light)).collect()
}

/// A pixel that an edge cuts is dark by the part that it lacks; its light is that of the rest.
fn whole(pixel: &Rgba) -> Rgba {
    if pixel.alpha() > 0.0 { *pixel * pixel.alpha().recip() } else { *pixel }
}

fn difference(a: &Rgba, b: &Rgba) -> [f64; 3] {
    [0, 1, 2].map(|c| f64::from(a.0[c]) - f64::from(b.0[c]))
}

#[derive(Default)]
struct Sums {
    count: usize,
    error: f64,
    shift: f64,
    across: f64,
    elsewhere: f64,
}

impl Sums {
    /// Adds a view's.
    fn add(&mut self, view: &View, field: &CommonField, light: &[Rgba], errors: &[[f64; 3]]) {
        let width = view.width();
        let mut flow = Flow::default();
        let before = self.count;
        for (k, error) in errors.iter().enumerate() {
            let (i, j) = (k % width, k / width);
            if !field.counts(i, j) {
                continue;
            }
            self.count += 1;
            self.error += error.iter().map(|e| e.abs()).sum::<f64>() / 3.0;
            for (next, place) in [(k + 1, (i + 1, j)), (k + width, (i, j + 1))] {
                if field.counts(place.0, place.1) {
                    let step = error.iter().zip(errors[next]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                    let largest = if field.parts((i, j), place) { &mut self.across } else { &mut self.elsewhere };
                    *largest = largest.max(step);
                }
            }
            let is_inner = i > 0 && j > 0 && field.counts(i + 1, j) && field.counts(i, j + 1);
            if is_inner && field.counts(i - 1, j) && field.counts(i, j - 1) {
                let across = difference(&light[k + 1], &light[k - 1]);
                let down = difference(&light[k + width], &light[k - width]);
                let around = |c: usize| {
                    [k + 1, k - 1, k + width, k - width].map(|at| f64::from(light[at].0[c])).iter().sum::<f64>()
                };
                for c in 0..3 {
                    let laplacian = around(c) - 4.0 * f64::from(light[k].0[c]);
                    flow.observe(across[c] / 2.0, down[c] / 2.0, laplacian, error[c]);
                }
            }
        }
        if self.count - before >= ENOUGH {
            self.shift = self.shift.max(flow.length());
        }
    }
}

/// The displacement d that fits best: error = −gradient · d + blur · Laplacian. Without the blur, waves that a small picture
/// cuts would pass for a shift.
#[derive(Default)]
struct Flow {
    matrix: DMat3,
    vector: DVec3,
}

impl Flow {
    fn observe(&mut self, across: f64, down: f64, laplacian: f64, error: f64) {
        let factors = DVec3::new(-across, -down, laplacian);
        self.matrix += DMat3::from_cols(factors * factors.x, factors * factors.y, factors * factors.z);
        self.vector += factors * error;
    }

    fn length(&self) -> f64 {
        (self.matrix.inverse() * self.vector).truncate().length()
    }
}
