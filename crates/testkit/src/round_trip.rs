use cosmorama::camera::{PixelPoint, View};
use cosmorama::filter::FilterSettings;
use cosmorama::raster::Rgba;
use cosmorama::render::{Arithmetic, Plan, Resampler};
use cosmorama::sphere::Direction;
use cosmorama::world::World;
use glam::{DVec2, DVec3};

use crate::common_field::CommonField;
use crate::sky::whole;
use crate::{Form, light_by_direction};

/// Loss of a world in another form, measured in the result of a round trip where both forms show it and the other one
/// has the finer pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundTrip {
    /// Fraction of the pixels that were compared.
    pub compared: f64,
    /// Mean difference of a channel, for a contrast of one.
    pub mean_error: f64,
    /// Mean displacement of a view's pixels, as a vector, in pixels; the largest over the views. Errors of scale, or a
    /// rotation about the middle, do not contribute.
    pub shift: f64,
    /// Mean length of the displacements of a view's pixels; the largest over the views. A pixel is counted as a square
    /// of its area, here and below.
    pub moved: f64,
    /// Largest displacement of a pixel, in pixels.
    pub displacement: f64,
    /// Largest step between the errors of neighbours on both sides of a seam of the other form; zero if there is none.
    pub across: f64,
    /// Largest step between the errors of all other neighbours.
    pub elsewhere: f64,
}

/// Least number of compared pixels for a view to count.
const ENOUGH: usize = 100;

/// Returns waves of some thirty texels, at 1500 texels per steradian.
fn waves(direction: Direction) -> [f32; 3] {
    let d = direction.vector();
    let wave = |x: f64, y: f64| (0.5 + 0.25 * (x * 8.0).sin() + 0.25 * (y * 6.0 + x * 4.0).cos()) as f32;
    [wave(d.x, d.y), wave(d.y, d.z), wave(d.z, d.x)]
}

impl RoundTrip {
    /// Converts two worlds, one of waves and one whose colour is its direction, from one form to another and back.
    /// `None` if the forms have too little in common.
    ///
    /// The waves show loss of contrast and visible seams. Displacement is measured with directions only: where a border
    /// cuts waves, or they are blurred more in one direction, loss looks like a displacement of 0.01 pixel.
    ///
    /// # Panics
    /// With the reference filter, which records no weights.
    pub fn measure(from: &Form, through: &Form, filter: FilterSettings) -> Option<Self> {
        let (first, second) = (from.world(), through.world());
        let (there, back) = (plans(&first, &through.views, filter), plans(&second, &from.views, filter));
        let travelled = |light: &[Rgba]| apply(&back, &apply(&there, light));
        let light = light_by_direction(&first, waves);
        let waves = travelled(&light);
        let directions = travelled(&light_by_direction(&first, |d| d.vector().to_array().map(|c| c as f32)));
        // What nothing was measured of is no number, not zero.
        let mut sums = Sums { shift: f64::NAN, moved: f64::NAN, ..Sums::default() };
        for source in first.sources() {
            let original = &light[source.texels()];
            let errors: Vec<[f64; 3]> =
                waves[source.texels()].iter().zip(original).map(|(a, b)| difference(a, b)).collect();
            let field = CommonField::new(&source.view, from.is_whole && through.is_whole, &second);
            sums.add(&source.view, &field, &errors);
            sums.add_directions(&source.view, &field, &directions[source.texels()]);
        }
        let shown = first.solid_angles().filter(|&solid_angle| solid_angle > 0.0).count();
        (sums.count >= ENOUGH).then(|| Self {
            compared: sums.count as f64 / shown as f64,
            mean_error: sums.error / sums.count as f64,
            shift: sums.shift,
            moved: sums.moved,
            displacement: sums.displacement,
            across: sums.across,
            elsewhere: sums.elsewhere,
        })
    }
}

fn plans(world: &World, views: &[View], filter: FilterSettings) -> Vec<Plan> {
    let plan = |target| Resampler { world, target, filter }.plan(Arithmetic::Float);
    views.iter().map(|view| plan(view).expect("a filter whose weights can be recorded")).collect()
}

fn apply(plans: &[Plan], light: &[Rgba]) -> Vec<Rgba> {
    plans.iter().flat_map(|plan| plan.apply(light).pixels().iter().map(whole).collect::<Vec<_>>()).collect()
}

fn difference(a: &Rgba, b: &Rgba) -> [f64; 3] {
    [0, 1, 2].map(|c| f64::from(a.0[c]) - f64::from(b.0[c]))
}

#[derive(Default)]
struct Sums {
    count: usize,
    error: f64,
    shift: f64,
    moved: f64,
    displacement: f64,
    across: f64,
    elsewhere: f64,
}

impl Sums {
    /// Adds the directions in a view of the result.
    fn add_directions(&mut self, view: &View, field: &CommonField, found: &[Rgba]) {
        let (mut sum, mut moves, mut count) = (DVec2::ZERO, 0.0, 0usize);
        for (k, found) in found.iter().enumerate() {
            let (i, j) = (k % view.width(), k / view.width());
            let Some(footprint) = view.footprint(PixelPoint::centre(i, j)).filter(|_| field.counts(i, j)) else {
                continue;
            };
            let here = footprint.direction.vector();
            // What is averaged over a wide pixel gets shorter; that is no displacement.
            let moved =
                DVec3::new(found.0[0].into(), found.0[1].into(), found.0[2].into()).reject_from_normalized(here);
            let Some(pixels) = footprint.jacobian.pseudo_inverse(moved) else { continue };
            let displacement = moved.length() / footprint.jacobian.solid_angle().sqrt();
            self.displacement = self.displacement.max(displacement);
            sum += pixels;
            moves += displacement;
            count += 1;
        }
        if count >= ENOUGH {
            self.shift = self.shift.max((sum / count as f64).length());
            self.moved = self.moved.max(moves / count as f64);
        }
    }

    /// Adds the errors of a view.
    fn add(&mut self, view: &View, field: &CommonField, errors: &[[f64; 3]]) {
        let width = view.width();
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
        }
    }
}

#[cfg(test)]
mod tests {
    use cosmorama::camera::{PixelPoint, View};
    use cosmorama::raster::Rgba;
    use cosmorama::sphere::{Angle, Orientation};
    use cosmorama::world::World;

    use super::Sums;
    use crate::common_field::CommonField;
    use crate::{equirect, fisheye};

    /// Measures a view that shows the directions of another view of its size.
    fn measured(view: &View, other: &View) -> Sums {
        let directions = (0..view.width() * view.height()).map(|k| {
            let place = PixelPoint::centre(k % view.width(), k / view.width());
            let [x, y, z] = other.direction(place).expect("a view that shows everything").vector().to_array();
            Rgba::opaque(x as f32, y as f32, z as f32)
        });
        let finer = World::new([("finer".to_owned(), equirect(800))]).expect("one view");
        let mut sums = Sums::default();
        sums.add_directions(view, &CommonField::new(view, true, &finer), &directions.collect::<Vec<_>>());
        sums
    }

    #[test]
    fn a_known_displacement_is_found() {
        let (view, pixels) = (equirect(200), 0.01);
        let yaw = Angle::from_degrees(360.0 / 200.0 * pixels);
        let turned =
            View { orientation: Orientation::from_yaw_pitch_roll(yaw, Angle::ZERO, Angle::ZERO), ..view.clone() };
        let sums = measured(&view, &turned);
        assert!((sums.shift - pixels).abs() < 1e-5, "{}", sums.shift);
        // On the equator, where pixels are square.
        assert!((sums.displacement - pixels).abs() < 1e-5, "{}", sums.displacement);
        // Elsewhere they are narrower by the cosine of the latitude.
        assert!(sums.moved > 0.8 * pixels && sums.moved < pixels, "{}", sums.moved);
    }

    #[test]
    fn a_wrong_scale_is_no_shift_and_is_found() {
        let (view, scale) = (fisheye(100, 180.0), 1.001);
        let sums = measured(&view, &fisheye(100, 180.0 * scale));
        assert!(sums.shift < 1e-5, "{}", sums.shift);
        // Two thirds of a radius of 50 pixels from the middle, in the mean; less the rim, which is not compared.
        let mean = (scale - 1.0) * 50.0 * 2.0 / 3.0;
        assert!(sums.moved > 0.85 * mean && sums.moved < 1.15 * mean, "{}", sums.moved);
        // At the rim, where the area of a pixel is that of a square of √(2/π) pixels.
        let rim = (scale - 1.0) * 50.0 * std::f64::consts::FRAC_PI_2.sqrt();
        assert!(sums.displacement > 0.9 * rim && sums.displacement < rim, "{}", sums.displacement);
    }
}
